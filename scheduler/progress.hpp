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
  std::string phase;   // of its heartbeat; empty before the first
  int hold = 0, holds = 0;
  double shields = 0;    // [-]
  double fraction = 0;   // of the planned model time
  double steps_per_second = 0;
  double silent = 0;   // since its last heartbeat [s]
  double left = -1;    // about, wall seconds; negative = unknown
};

struct Progress {
  int cases = 0, done = 0, failed = 0, stopped = 0;   // cases proper, without beds
  int beds = 0, beds_done = 0;                        // those that unfinished cases wait for
  std::vector<RunningCase> running;
  double elapsed = 0;   // since this run began [s]
  double left = -1;     // about, wall seconds; negative = unknown
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
    int width = 80;   // [characters]: a line that wraps could not be repainted
  };
  /// What suits a file descriptor, e.g. STDERR_FILENO.
  static Style style_of(int descriptor);

  ProgressPrinter(Style, Write, Clock);
  ~ProgressPrinter() override;

  void event(const std::string& line) override;
  void update(const Progress&) override;

 private:
  std::string block_of(const Progress&) const;
  void erase_block();

  Style style_;
  Write write_;
  Clock clock_;
  std::string block_;   // what stands on the terminal now
  double last_line_;    // when the last line of progress was due, on the clock [s]
};

/// "3 of 12 cases done, 2 at work, 1 failed, about 14 min left"
std::string summary(const Progress&);
/// 45 s, 12 min, 3.4 h, 2.1 d
std::string duration_text(double seconds);

}   // namespace bedload
