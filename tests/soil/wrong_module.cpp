// A module under the name of that for several ranks, left from another version of the program: soil_program_test.cpp.

#include <cstdlib>

extern "C" {
#ifdef EASYDYN_WRONG_INTERFACE
const char* easydyn_ranks_interface() {
  return EASYDYN_WRONG_INTERFACE;
}
#endif
void* easydyn_start_ranks() {
  std::abort();  // must not be called
}
}
