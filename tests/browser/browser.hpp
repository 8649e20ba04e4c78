#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace easydyn::testing {

/// What headless Chromium made of a page.
struct Visit {
  std::string root;                   ///< the <html> tag after the scripts have run
  std::string body;                   ///< the document after that, up to its first script
  std::vector<std::string> console;   ///< messages of the page
  std::vector<std::string> requests;  ///< addresses the page asked for, other than itself and data:
};

bool has_browser();

/// Opens the page, lets its time run for 10 s and looks. Leaves its traces in `folder`.
Visit visit(const std::filesystem::path& page, const std::filesystem::path& folder,
            const std::string& options = "");

}  // namespace easydyn::testing
