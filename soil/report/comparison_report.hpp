#pragma once

#include <filesystem>
#include <vector>

namespace easydyn::soil {

/// Writes one self-contained HTML page that compares the ground vibration (vibrations.h5, docs/formats.md) of
/// several results at the receivers that at least two of them have in common, within 1 mm: velocities and
/// one-third octave spectra of v_z overlaid, indicators with their change [dB] and the insertion loss
///
///   D_b = L_b,first - L_b,other,   L_b = 20 log10(v_rms,b / 5e-8 m/s),   positive where the other is quieter
///
/// against the first result that has the receiver. Rms values of records of unlike length are referred to the
/// length of the first result's, so that levels compare the energies of the passages.
/// @throws InputError if there are fewer than two folders, a folder is given twice or has no vibrations.h5, no
///         two results have a receiver in common, or a file cannot be read or written
void write_comparison_report(const std::vector<std::filesystem::path>& folders,
                             const std::filesystem::path& html);

}  // namespace easydyn::soil
