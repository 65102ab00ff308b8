// Signal handlers that count.
#include "scheduler/interrupts.hpp"

namespace bedload {
namespace {

volatile std::sig_atomic_t interrupts = 0;

extern "C" void count_interrupt(int) { interrupts = interrupts + 1; }

}   // namespace

InterruptCounter::InterruptCounter() {
  interrupts = 0;
  struct sigaction counting {};
  counting.sa_handler = count_interrupt;   // without SA_RESTART: poll returns at once
  sigemptyset(&counting.sa_mask);
  sigaction(SIGINT, &counting, &interrupt_before_);
  sigaction(SIGTERM, &counting, &terminate_before_);
}

InterruptCounter::~InterruptCounter() {
  sigaction(SIGINT, &interrupt_before_, nullptr);
  sigaction(SIGTERM, &terminate_before_, nullptr);
}

int InterruptCounter::count() { return interrupts; }

}   // namespace bedload
