#pragma once

#include <string>

namespace easydyn::visu {

/// A number as it stands in a report: `digits` significant digits, trailing zeros kept, powers of ten where
/// zeros would pile up, a true minus sign, a dash for NaN.  number_text(0.03456, 3) = "0.0346", (2.1e11, 3) =
/// "2.10·10¹¹"
std::string number_text(double value, int digits = 3);

/// The same without trailing zeros: what the user gave comes back as he wrote it.  (2.1e11) = "2.1·10¹¹"
std::string short_number_text(double value, int digits = 6);

}  // namespace easydyn::visu
