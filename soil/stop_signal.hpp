#pragma once

#include <string>

namespace easydyn::soil {

/// While it lives, SIGINT and SIGTERM only leave a note, which a long computation looks at between two steps. A
/// second signal ends the program at once, as if there were no such object. One object at a time.
class StopSignal {
 public:
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  static int number();                     ///< of the signal that came; 0: none
  static std::string name_of(int number);  ///< "SIGINT" or "SIGTERM"; empty: another one or none
};

}  // namespace easydyn::soil
