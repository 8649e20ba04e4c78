#pragma once

#include <filesystem>

namespace easydyn::testing {

/// Writes results.h5 and vibrations.h5 (docs/formats.md) of a made-up tram passage into a folder: plausible
/// in shape and size, so that the report can be judged, but computed by nobody. The soil moves 0.92 times as far as
/// the foundation of step 1; a semi-analytical soil, as --verify adds it, just as far.
void write_synthetic_results(const std::filesystem::path& folder, bool has_semi_analytical = false);

}  // namespace easydyn::testing
