#pragma once

#include <filesystem>

namespace easydyn::testing {

/// Writes results.h5 and vibrations.h5 (docs/formats.md) of a made-up tram passage into a folder: plausible
/// in shape and size, so that the report can be judged, but computed by nobody.
void write_synthetic_results(const std::filesystem::path& folder);

}  // namespace easydyn::testing
