#pragma once

// Private to the report: how text enters an HTML page.

#include <string>
#include <string_view>

namespace easydyn::visu::html {

/// Text as HTML shows it: & < > " ' become entities.
std::string escaped(std::string_view text);

/// The same, with words between `backticks` set as code.
std::string inline_text(std::string_view text);

/// JSON that may stand inside a <script> element: `<` written as \u003c, so that nothing can end the element.
std::string inside_script(std::string_view json);

}  // namespace easydyn::visu::html
