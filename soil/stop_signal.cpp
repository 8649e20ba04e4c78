#include "soil/stop_signal.hpp"

#include <csignal>

namespace easydyn::soil {
namespace {

volatile std::sig_atomic_t signal_that_came = 0;

extern "C" void note_signal(int number) {
  signal_that_came = number;
}

constexpr int watched[] = {SIGINT, SIGTERM};
struct sigaction earlier[2];

}  // namespace

StopSignal::StopSignal() {
  signal_that_came = 0;
  struct sigaction request {};
  request.sa_handler = &note_signal;
  request.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  sigemptyset(&request.sa_mask);
  for (int i = 0; i < 2; ++i) {
    sigaction(watched[i], nullptr, &earlier[i]);
    // What a shell has told the program to ignore (nohup, a job in the background) stays ignored.
    if (earlier[i].sa_handler != SIG_IGN) sigaction(watched[i], &request, nullptr);
  }
}

StopSignal::~StopSignal() {
  for (int i = 0; i < 2; ++i) sigaction(watched[i], &earlier[i], nullptr);
}

int StopSignal::number() {
  return signal_that_came;
}

std::string StopSignal::name_of(int number) {
  return number == SIGINT ? "SIGINT" : number == SIGTERM ? "SIGTERM" : "";
}

}  // namespace easydyn::soil
