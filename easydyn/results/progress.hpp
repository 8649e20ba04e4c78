#pragma once

#include <chrono>
#include <cstdio>
#include <string>

namespace easydyn::results {

/// A length of time for people: "0.4 s", "45 s", "3 min 05 s", "2 h 10 min".
std::string format_duration(double seconds);

/// Says how far a long computation is and how long it will still take: on a terminal one line that renews
/// itself a few times per second, elsewhere (a file, a pipe) one line for every tenth, and at least one every ten minutes.
///
///   Progress progress("waves");
///   solver.run([&](double fraction) { progress.update(fraction); });
///   progress.finish();
///
///   waves: 42 %, 12 s left
class Progress {
 public:
  explicit Progress(std::string title, std::FILE* out = stdout);
  Progress(std::string title, std::FILE* out, bool is_terminal);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// The computation goes on from this fraction: only what comes after it tells how long the rest will take.
  void start_at(double fraction);
  void update(double fraction);  ///< 0 ... 1
  void finish();                 ///< prints the time that was needed

 private:
  using Clock = std::chrono::steady_clock;
  double seconds_since(Clock::time_point start) const;
  void print(const std::string& text);

  std::string title_;
  std::FILE* out_;
  bool is_terminal_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_print_ = start_;
  double first_fraction_ = 0;
  int printed_tenths_ = 0;
  bool line_is_open_ = false;
};

}  // namespace easydyn::results
