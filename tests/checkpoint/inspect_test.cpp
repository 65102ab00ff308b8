// What inspect says of a state.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "checkpoint/inspect.hpp"

namespace bedload {
namespace {

FieldSummary of(const State& state, const std::string& name) {
  const auto fields = summarise(state);
  const auto found = std::ranges::find(fields, name, &FieldSummary::name);
  return found == fields.end() ? FieldSummary{"missing"} : *found;
}

TEST(Inspect, TellsShapeUnitAndExtremes) {
  State state;
  state.grains.position = {{1, -2, 3}, {4, 5, 6}};
  const FieldSummary position = of(state, "grains/position");
  EXPECT_EQ(position.unit, "m");
  EXPECT_EQ(position.shape, (std::vector<std::uint64_t>{2, 3}));
  EXPECT_EQ(position.min, -2);
  EXPECT_EQ(position.max, 6);
}

TEST(Inspect, LeavesNanOutOfTheExtremesAndHasNoneForNothing) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  State state;
  state.grains.travel = {nan, 2, 1, nan};
  EXPECT_EQ(of(state, "grains/travel").min, 1);
  EXPECT_EQ(of(state, "grains/travel").max, 2);
  EXPECT_TRUE(std::isnan(of(state, "grains/diameter").min));
  EXPECT_EQ(of(state, "grains/diameter").shape, (std::vector<std::uint64_t>{0}));
}

TEST(Inspect, LeavesGhostsOut) {
  State state;
  const StaggeredGrid grid{.cells = {2, 2, 2}};
  state.fluid.pressure = Field<Centre>(grid, 3);
  state.fluid.pressure[grid.index(-1, 0, 0)] = 99;
  EXPECT_EQ(of(state, "fluid/pressure").max, 3);
}

TEST(Inspect, ListsEveryFieldOnce) {
  std::size_t fields = 0;
  const State state;
  State::each_field(state, [&](auto&&...) { ++fields; });
  EXPECT_EQ(summarise(state).size(), fields);
}

}   // namespace
}   // namespace bedload
