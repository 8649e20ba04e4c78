#include "easydyn/results/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace easydyn::results {
namespace {

constexpr double longest_silence = 600;  // [s] in a log

}  // namespace

std::string format_duration(double seconds) {
  if (seconds < 9.95) {
    return fmt::format("{:.1f} s", std::max(0.0, seconds));
  }
  const long whole = std::lround(seconds);
  if (whole < 60) {
    return fmt::format("{} s", whole);
  }
  if (whole < 3600) {
    return fmt::format("{} min {:02d} s", whole / 60, whole % 60);
  }
  return fmt::format("{} h {:02d} min", whole / 3600, whole % 3600 / 60);
}

Progress::Progress(std::string title, std::FILE* out)
    : Progress(std::move(title), out, isatty(fileno(out)) == 1) {}

Progress::Progress(std::string title, std::FILE* out, bool is_terminal)
    : title_(std::move(title)), out_(out), is_terminal_(is_terminal) {}

Progress::~Progress() {
  if (line_is_open_) {  // an exception: what follows begins on a new line
    std::fputc('\n', out_);
    std::fflush(out_);
  }
}

void Progress::start_at(double fraction) {
  first_fraction_ = std::clamp(fraction, 0.0, 1.0);
  printed_tenths_ = static_cast<int>(10 * first_fraction_ + 1e-9);
  start_ = Clock::now();
}

void Progress::update(double fraction) {
  fraction = std::clamp(fraction, 0.0, 1.0);
  const double elapsed = seconds_since(start_);
  const std::string left =
      fraction > first_fraction_ && fraction < 1
          ? fmt::format(", {} left", format_duration(elapsed * (1 - fraction) / (fraction - first_fraction_)))
          : "";
  const std::string text = fmt::format("{}: {:.0f} %{}", title_, std::floor(100 * fraction), left);
  if (is_terminal_) {
    if (!line_is_open_ || seconds_since(last_print_) > 0.2 || fraction >= 1) {
      print(text);
    }
  } else if (const int tenths = static_cast<int>(10 * fraction + 1e-9);
             tenths > printed_tenths_ || seconds_since(last_print_) > longest_silence) {
    printed_tenths_ = tenths;
    print(text);
  }
}

void Progress::finish() {
  print(fmt::format("{}: done in {}", title_, format_duration(seconds_since(start_))));
  if (line_is_open_) {
    std::fputc('\n', out_);
    std::fflush(out_);
    line_is_open_ = false;
  }
}

double Progress::seconds_since(Clock::time_point start) const {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void Progress::print(const std::string& text) {
  if (is_terminal_) {
    fmt::print(out_, "\r{}\033[K", text);  // back to the start, and clear what is left of the old line
    line_is_open_ = true;
  } else {
    fmt::print(out_, "{}\n", text);
  }
  std::fflush(out_);
  last_print_ = Clock::now();
}

}  // namespace easydyn::results
