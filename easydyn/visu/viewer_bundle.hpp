#pragma once

// Private to the report: the embedded viewer.

#include <string_view>

namespace easydyn::visu {

/// The viewer's script and style sheet: viewer/dist, embedded in the library. It holds three.js and uPlot;
/// their licences stand at its beginning.
extern const std::string_view viewer_js, viewer_css;

}  // namespace easydyn::visu
