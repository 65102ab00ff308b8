#include "solver/fluid/wavefront.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace bedload {
namespace {

/// Planes of a periodic line with ghost planes 0 and n + 1; a sweep of weight w mixes plane i with both neighbours in
/// place.
struct Line {
  explicit Line(int n) : value(n + 2) {
    for (int i = 1; i <= n; ++i) value[i] = 1.0 / (3 * i + 1);
    refresh();
  }
  void refresh() { value.front() = value[value.size() - 2], value.back() = value[1]; }
  /// Only planes of the given parity change, as in a red-black sweep; across an odd seam two of them meet.
  void sweep(int i, int parity, double w) {
    if (i % 2 == parity) value[i + 1] = w * value[i + 1] + value[i] - 0.3 * value[i + 2];
  }
  bool operator==(const Line&) const = default;

  std::vector<double> value;
};

TEST(Wavefront, GivesTheBitsOfOneFullSweepAfterTheOther) {
  for (int n = 1; n <= 13; ++n) {
    Line plain(n), fused(n);
    for (int number = 0; number < 5; ++number) {
      for (int i = 0; i < n; ++i) plain.sweep(i, number % 2, 0.5 + number);
      plain.refresh();
    }
    const auto stage = [&](int number) { return [&, number](int i) { fused.sweep(i, number % 2, 0.5 + number); }; };
    wavefront(
        n, [&] { fused.refresh(); }, stage(0), stage(1), stage(2), stage(3), stage(4));
    EXPECT_EQ(plain, fused) << n << " planes, five stages";

    Line plain_pair(n), fused_pair(n);
    for (int number = 0; number < 2; ++number) {
      for (int i = 0; i < n; ++i) plain_pair.sweep(i, number, 0.5 + number);
      plain_pair.refresh();
    }
    wavefront(
        n, [&] { fused_pair.refresh(); }, [&](int i) { fused_pair.sweep(i, 0, 0.5); },
        [&](int i) { fused_pair.sweep(i, 1, 1.5); });
    EXPECT_EQ(plain_pair, fused_pair) << n << " planes, two stages";
  }
}

}   // namespace
}   // namespace bedload
