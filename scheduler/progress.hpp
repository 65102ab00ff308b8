// What the user sees of a running study: a snapshot of it, and the printer that shows it.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace bedload {

/// One case at work.
struct RunningCase {
  std::string label;
  std::string phase;             // of its heartbeat; empty before the first
  int hold = 0, holds = 0;
  double shields = 0;            // [-]
  double fraction = 0;           // of the planned model time
  double steps_per_second = 0;
  double silent = 0;             // since its last heartbeat [s]
  double left = -1;              // at most, wall seconds; negative = unknown
};

struct Progress {
  int cases = 0, done = 0, failed = 0, stopped = 0;   // cases proper, without beds
  int beds = 0, beds_done = 0;                        // those that unfinished cases wait for
  std::vector<RunningCase> running;
  double elapsed = 0;                                 // since this run began [s]
  double left = -1;                                   // at most, wall seconds; negative = unknown
  bool stopping = false;
};

/// Told by the scheduler, on its own thread.
class ProgressSink {
 public:
  virtual ~ProgressSink() = default;
  virtual void event(const std::string& line) = 0;   // a change of state
  virtual void update(const Progress&) = 0;          // at every turn of the scheduler's loop
};

/// On a terminal one block, repainted in place below the events; else one line per event and at most one line of
/// progress a minute.
class ProgressPrinter : public ProgressSink {
 public:
  using Write = std::function<void(std::string_view)>;
  using Clock = std::function<double()>;   // monotonic [s]
  struct Style {
    bool terminal = false;
    bool colour = false;
  };
  ProgressPrinter(Style, Write, Clock);
  ~ProgressPrinter() override;

  void event(const std::string& line) override;
  void update(const Progress&) override;

 private:
  void erase_block();

  Style style_;
  Write write_;
  Clock clock_;
  std::string block_;        // what stands on the terminal now
  int block_lines_ = 0;
  double last_update_ = 0;   // [s] on the clock
  bool updated_ = false;
};

/// "3 done, 2 running, 1 failed of 12, at most 14 min left"
std::string summary(const Progress&);
/// 45 s, 12 min, 3.4 h, 2.1 d
std::string duration_text(double seconds);

}  // namespace bedload
