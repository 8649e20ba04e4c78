#pragma once

// Private to soil/report: numbers and choices as text.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "easydyn/visu/number_text.hpp"

namespace easydyn::soil::report {

using visu::number_text;

/// `count` of the indices 0 ... n-1, evenly spread, first and last among them; all if there are no more.
std::vector<Eigen::Index> spread(Eigen::Index n, Eigen::Index count);

/// Name `i`, or "what i+1" where names are missing.
std::string name_of(const std::vector<std::string>& names, Eigen::Index i, const std::string& what);

/// What the figures hold of the loads (limit_band()): up to which frequency all, above which nothing.
std::string band_text(double highest_frequency);

}  // namespace easydyn::soil::report
