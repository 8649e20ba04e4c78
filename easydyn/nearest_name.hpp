#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// For messages on names that nobody knows: the one that was probably meant.
namespace easydyn {

/// Insertions, deletions, replacements and swaps of neighbours that turn `a` into `b` (optimal string alignment).
inline std::size_t edit_distance(std::string_view a, std::string_view b) {
  const std::size_t columns = b.size() + 1;
  std::vector<std::size_t> d((a.size() + 1) * columns);
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      std::size_t& here = d[i * columns + j];
      if (i == 0 || j == 0) {
        here = i + j;
        continue;
      }
      const auto before = [&](std::size_t rows, std::size_t letters) {
        return d[(i - rows) * columns + j - letters];
      };
      here = std::min({before(1, 0) + 1, before(0, 1) + 1, before(1, 1) + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        here = std::min(here, before(2, 2) + 1);
      }
    }
  }
  return d.back();
}

/// The known name that needs the fewest edits to become `name`; empty if even that one shares little with it.
inline std::string find_nearest(std::string_view name, const std::vector<std::string>& known) {
  std::string nearest;
  std::size_t fewest = name.size() / 2 + 2;  // more edits than that: no resemblance
  for (const std::string& candidate : known) {
    if (const std::size_t edits = edit_distance(name, candidate); edits < fewest) {
      fewest = edits;
      nearest = candidate;
    }
  }
  return nearest;
}

}  // namespace easydyn
