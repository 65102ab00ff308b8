// The digest of a state sees every field, every bit of it, and nothing else.
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "checkpoint/checkpoint.hpp"
#include "tests/support/random_state.hpp"

namespace bedload {
namespace {

/// Flips the lowest bit of a number.
template <class Number>
void nudge(Number& number) {
  *reinterpret_cast<unsigned char*>(&number) ^= 1;
}
template <class Element>
void nudge(std::vector<Element>& elements) {
  nudge(elements.back());
}
template <class Where>
void nudge(Field<Where>& field) {
  const StaggeredGrid grid{.cells = field.cells};
  nudge(field[grid.index(field.cells[0] - 1, field.cells[1] - 1, field.cells[2] - 1)]);
}

TEST(StateDigest, ChangesWithOneBitOfAnyField) {
  const State state = random_state(1);
  std::size_t fields = 0;
  State::each_field(state, [&](auto&&...) { ++fields; });
  std::set<std::string> digests{state_digest(state)};
  for (std::size_t changed = 0; changed < fields; ++changed) {
    State other = state;
    std::size_t n = 0;
    State::each_field(other, [&](const char*, auto& field, const char*) {
      if (n++ == changed) nudge(field);
    });
    digests.insert(state_digest(other));
  }
  EXPECT_EQ(digests.size(), fields + 1);
}

TEST(StateDigest, ChangesWithTheLengthOfAnEmptyColumn) {
  State longer;
  longer.record.samples.time.push_back(0);
  EXPECT_NE(state_digest(longer), state_digest(State()));
}

TEST(StateDigest, TellsFieldsOfOneSizeAndAnotherShapeApart) {
  State flat = random_state(2, {.cells = {4, 2, 3}}), tall = random_state(2, {.cells = {2, 4, 3}});
  EXPECT_NE(state_digest(flat), state_digest(tall));
}

TEST(StateDigest, DoesNotSeeGhosts) {
  State state = random_state(3);
  const std::string digest = state_digest(state);
  const StaggeredGrid grid{.cells = state.fluid.pressure.cells};
  state.fluid.pressure[grid.index(-1, 0, 0)] = 7;
  state.fluid.velocity.z[grid.index(0, 0, grid.cells[2])] = 7;
  EXPECT_EQ(state_digest(state), digest);
}

TEST(StateDigest, IsTheSameBeforeAndAfterACheckpoint) {
  const State state = random_state(4);
  EXPECT_EQ(state_digest(state_from_image(checkpoint_image(state), "ck")), state_digest(state));
}

TEST(StateDigest, IsSixtyFourHexadecimalDigits) {
  const std::string digest = state_digest(State());
  EXPECT_EQ(digest.size(), 64u);
  EXPECT_EQ(digest.find_first_not_of("0123456789abcdef"), std::string::npos);
}

}   // namespace
}   // namespace bedload
