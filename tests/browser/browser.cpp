#include "tests/browser/browser.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <sstream>

#include "tests/temporary_folder.hpp"

namespace easydyn::testing {

namespace fs = std::filesystem;

bool has_browser() {
  return std::string(EASYDYN_CHROMIUM) != "";
}

Visit visit(const fs::path& page, const fs::path& folder, const std::string& options) {
  // without the services that the browser itself calls home for, so that every request is the page's
  const std::string quiet =
      "--disable-background-networking --disable-component-update --disable-sync --disable-extensions "
      "--disable-default-apps --disable-domain-reliability --disable-client-side-phishing-detection "
      "--disable-features=OptimizationHints,MediaRouter,Translate,AutofillServerCommunication "
      "--no-first-run --no-default-browser-check --no-pings --metrics-recording-only";
  const std::string command = fmt::format(
      "timeout 120 '{}' --headless=new --no-sandbox --disable-dev-shm-usage --use-angle=swiftshader "
      "--enable-unsafe-swiftshader {} --user-data-dir='{}/profile' --window-size=1280,1600 "
      "--enable-logging=stderr --log-net-log='{}/net.json' --net-log-capture-mode=Everything "
      "--virtual-time-budget=10000 {} --dump-dom 'file://{}' >'{}/dom.html' 2>'{}/log.txt'",
      EASYDYN_CHROMIUM, quiet, folder.string(), folder.string(), options, page.string(), folder.string(),
      folder.string());
  const int status = std::system(command.c_str());
  EXPECT_EQ(status, 0) << command << "\n" << read_whole_file(folder / "log.txt");

  Visit out;
  const std::string dom = read_whole_file(folder / "dom.html");
  out.root = dom.substr(dom.find("<html"), dom.find('>', dom.find("<html")) + 1 - dom.find("<html"));
  out.body = dom.substr(std::min(dom.size(), dom.find("<body")), dom.find("<script") - dom.find("<body"));
  const std::string log = read_whole_file(folder / "log.txt"), net = read_whole_file(folder / "net.json");
  EXPECT_NE(net.find("\"events\""), net.npos) << "no net log";

  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);)
    if (line.find("CONSOLE") != line.npos) out.console.push_back(line);

  // one event per line; the browser's own calls home do not bear the page's isolation key
  std::set<std::string> requests;
  const std::string own = "file://" + page.string();
  std::istringstream events(net);
  for (std::string event; std::getline(events, event);) {
    if (event.find("\"network_isolation_key\":\"file://") == event.npos) continue;
    const size_t start = event.rfind("\"url\":\"");
    if (start == event.npos) continue;
    const std::string url = event.substr(start + 7, event.find('"', start + 7) - start - 7);
    if (url != own && url.rfind("data:", 0) != 0) requests.insert(url);
  }
  out.requests.assign(requests.begin(), requests.end());
  return out;
}

}  // namespace easydyn::testing
