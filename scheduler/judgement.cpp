// The rules of retrying: by cause and by progress.
#include "scheduler/judgement.hpp"

#include <fmt/format.h>

#include <csignal>
#include <cstring>

namespace bedload {
namespace {

constexpr int most_deaths = 10;   // of any kind, at one checkpoint
constexpr int same_step_crashes = 2;
constexpr int most_out_of_memory = 2;

/// What the attempts at the end of the list did that left the checkpoint where it is.
struct Standstill {
  int deaths = 0, out_of_memory = 0;
  int crashes_at_last_step = 0;
};

bool is_death(Cause cause) {
  return cause == Cause::crash || cause == Cause::killed || cause == Cause::out_of_memory || cause == Cause::finished;
}   // `finished` without a finished checkpoint: it was lost, or the worker was wrong

Standstill standstill(const Position& position, const std::vector<Attempt>& attempts) {
  Standstill still;
  for (auto a = attempts.rbegin(); a != attempts.rend(); ++a) {
    const bool moved_since = a->from_step.value_or(position.step) < position.step;
    if (moved_since || a->cause == Cause::stopped) break;   // who stopped it, or asked for a retry, wants it to go on
    if (!is_death(a->cause)) continue;
    ++still.deaths;
    still.out_of_memory += a->cause == Cause::out_of_memory;
    still.crashes_at_last_step += a->cause == Cause::crash && a->step == attempts.back().step;
  }
  return still;
}

std::string with_message(std::string reason, const Attempt& last) {
  return last.message.empty() ? reason : fmt::format("{}: {}", reason, last.message);
}

Judgement judge_death(const Attempt& last, const Standstill& still) {
  const auto failed = [&](const std::string& reason) {
    return Judgement{Verdict::failed, with_message(reason, last), still.deaths};
  };
  if (last.cause == Cause::crash && still.crashes_at_last_step >= same_step_crashes)
    return failed(last.step ? fmt::format("crashed twice at step {}", *last.step)
                            : "crashed twice before its first step");
  if (still.out_of_memory >= most_out_of_memory) return failed("twice out of memory without progress");
  if (still.deaths >= most_deaths) return failed(fmt::format("died {} times without progress", still.deaths));
  return {Verdict::again, with_message(std::string(word(last.cause)), last), still.deaths};
}

}   // namespace

Judgement judge(const Position& position, const std::vector<Attempt>& attempts) {
  if (position.finished) return {Verdict::done, {}, 0};
  if (attempts.empty()) return {Verdict::again, {}, 0};
  const Attempt& last = attempts.back();
  switch (last.cause) {
    case Cause::user_error:
    case Cause::numerical:
    case Cause::corrupt: return {Verdict::failed, with_message(std::string(word(last.cause)), last), 0};
    case Cause::io: return {Verdict::set_aside, with_message("io", last), 0};
    case Cause::crash:
    case Cause::killed:
    case Cause::out_of_memory:
    case Cause::finished: return judge_death(last, standstill(position, attempts));
    case Cause::running:
    case Cause::stopped:
    case Cause::wall_limit:
    case Cause::fenced: break;
  }
  return {Verdict::again, {}, 0};
}

Cause cause_of(const JobEnd& end) {
  switch (end.signal) {
    case 0: break;
    case SIGSEGV:
    case SIGABRT:
    case SIGBUS:
    case SIGFPE:
    case SIGILL: return Cause::crash;
    default: return Cause::killed;
  }
  switch (end.exit_code) {   // a closed set: anything else is a worker that broke
    case 2:
    case 65:
    case 66:
    case 69:
    case 73:
    case 74:
    case 75:
    case 76:
    case 80:
    case 82: return cause_of(static_cast<ErrorKind>(end.exit_code));
    case 137: return Cause::killed;   // what a shell or mpirun makes of SIGKILL
    default: return Cause::crash;
  }
}

std::string describe(const JobEnd& end) {
  return end.signal != 0 ? fmt::format("signal {} ({})", end.signal, ::strsignal(end.signal))
                         : fmt::format("exit code {}", end.exit_code);
}

}   // namespace bedload
