// Every piece of work is done, once, whatever the number of threads.
#include "studies/run_in_parallel.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace bedload {
namespace {

TEST(RunInParallel, DoesEachPieceOnce) {
  for (const int cores : {0, 1, 3, 50}) {
    std::vector<int> done(20, 0);
    run_in_parallel(done.size(), cores, [&](std::size_t n) { ++done[n]; });
    EXPECT_EQ(done, std::vector<int>(20, 1)) << cores << " cores";
  }
}

TEST(RunInParallel, HasNothingToDoForNothing) {
  run_in_parallel(0, 4, [](std::size_t) { FAIL(); });
}

}   // namespace
}   // namespace bedload
