#pragma once

#include <filesystem>

namespace easydyn::soil {

/// Writes the report of a prediction as one self-contained HTML page: how it was computed, key figures, the
/// passage (results.h5), the ground vibration (vibrations.h5), how well both fit (recoupling error), every
/// parameter with its source, limits and assumptions. Both files lie in `results_dir` and follow
/// docs/formats.md; one of them is enough, and the page holds what they hold.
/// @throws InputError if neither file is there, or a file cannot be read or written
void write_prediction_report(const std::filesystem::path& results_dir, const std::filesystem::path& html);

}  // namespace easydyn::soil
