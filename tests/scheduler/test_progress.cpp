// What the user sees, on a terminal and in a log; and the time left.
#include <gtest/gtest.h>

#include "scheduler/progress.hpp"
#include "scheduler/time_left.hpp"

namespace bedload {
namespace {

struct Screen {
  std::string text;
  double now = 0;
  ProgressPrinter printer(bool terminal) {
    return {{terminal, false, 80}, [this](std::string_view s) { text += s; }, [this] { return now; }};
  }
  std::string take() { return std::exchange(text, {}); }
};

Progress some_progress() {
  Progress p;
  p.cases = 4;
  p.done = 1;
  p.left = 120;
  p.running.push_back({"d0.5mm", "ramp", 3, 12, 0.0864, 0.25, 210, 0, 100});
  return p;
}

TEST(ProgressPrinter, WritesOneLineAMinuteIntoALog) {
  Screen screen;
  auto printer = screen.printer(false);
  printer.event("d0.5mm: started");
  EXPECT_EQ(screen.take(), "d0.5mm: started\n");
  for (screen.now = 0; screen.now < 180; screen.now += 0.5) printer.update(some_progress());
  EXPECT_EQ(screen.take(),
            "1 of 4 cases done, 1 at work, about 2 min left\n"
            "1 of 4 cases done, 1 at work, about 2 min left\n");
}

TEST(ProgressPrinter, RepaintsItsBlockBelowTheEventsOnATerminal) {
  Screen screen;
  {
    auto printer = screen.printer(true);
    printer.update(some_progress());
    const std::string block = screen.take();
    EXPECT_EQ(std::count(block.begin(), block.end(), '\n'), 2);
    EXPECT_NE(block.find("ramp 3/12"), std::string::npos) << block;
    EXPECT_EQ(block.find('\x1b'), std::string::npos) << "nothing to erase yet";
    printer.update(some_progress());
    EXPECT_EQ(screen.take(), "") << "nothing has changed";
    printer.event("d0.6mm: done");
    EXPECT_EQ(screen.take(), "\x1b[2A\x1b[Jd0.6mm: done\n" + block);
  }
  EXPECT_EQ(screen.take(), "\x1b[2A\x1b[J") << "the block goes with its printer";
}

TEST(ProgressPrinter, NeverWritesALineThatWraps) {
  Screen screen;
  Progress p = some_progress();
  p.running[0].label = std::string(100, 'x');
  auto printer = screen.printer(true);
  printer.update(p);
  std::size_t start = 0;
  for (std::size_t end; (end = screen.text.find('\n', start)) != std::string::npos; start = end + 1)
    EXPECT_LE(end - start, 80u);
}

TEST(TimeLeft, OfEqualCasesIsTheirWorkOverTheCores) {
  TimeLeft left;   // one at work at 1 % per second, half done; three to come: 50 s + 300 s on two cores
  EXPECT_DOUBLE_EQ(left.of_all({{false, 0.5, 0.01}, {}, {}, {}}, 2), 175);
}

TEST(TimeLeft, IsNeverLessThanTheLongestCase) {
  TimeLeft left;
  EXPECT_DOUBLE_EQ(left.of_all({{false, 0.0, 0.01}, {false, 0.9, 0.1}}, 8), 100);
}

TEST(TimeLeft, IsUnknownBeforeAnyCaseHasAPace) {
  TimeLeft left;
  EXPECT_LT(left.of_all({{}, {}}, 2), 0);
  EXPECT_LT(left.of_all({{true, 0.5, 0.01}, {}}, 2), 0) << "a bed says nothing about cases";
  left.of_all({{false, 0.5, 0.01}}, 2);
  EXPECT_DOUBLE_EQ(left.of_all({{}}, 2), 100) << "the pace of those before";
  EXPECT_DOUBLE_EQ(left.of_all({}, 2), 0);
}

}   // namespace
}   // namespace bedload
