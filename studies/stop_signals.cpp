#include "studies/stop_signals.hpp"

#include <csignal>

namespace bedload {

namespace {

constexpr int signals[] = {SIGUSR1, SIGTERM, SIGINT};
volatile std::sig_atomic_t noted = 0;
void note(int) { noted = 1; }

}   // namespace

StopSignals::StopSignals() {
  noted = 0;
  struct sigaction action {};
  action.sa_handler = note;
  action.sa_flags = SA_RESTART;   // writes under way go on
  for (const int signal : signals) sigaction(signal, &action, nullptr);
}

StopSignals::~StopSignals() { release(); }

void StopSignals::release() {
  for (const int signal : signals) std::signal(signal, SIG_DFL);
}

bool StopSignals::arrived() { return noted != 0; }

}   // namespace bedload
