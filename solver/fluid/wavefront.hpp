// Several sweeps over the x-planes in one pass through memory.
#pragma once

#include <algorithm>

namespace bedload {

/// Runs each stage on every plane, a later stage on a plane as soon as the stage before it has passed the planes on
/// both sides, so that planes are still in cache; the result is that of one full sweep after the other. `refresh`
/// renews the ghost planes; it runs after each stage has seen all planes, so a stage reads its own old values across a
/// periodic seam.
template <class Refresh, class... Stages>
void wavefront(int planes, Refresh&& refresh, Stages&&... stages) {
  for (int i = 0; i < planes; ++i) {
    int lag = 0;
    const auto advance = [&](auto& stage) {
      if (i >= 2 * lag) stage(i - lag);
      ++lag;
    };
    (advance(stages), ...);
  }
  int lag = 0;
  const auto finish = [&](auto& stage) {
    for (int i = std::max(lag, planes - lag); i < planes; ++i) stage(i);
    for (int i = 0; i < std::min(lag, planes); ++i) stage(i);
    refresh();
    ++lag;
  };
  (finish(stages), ...);
}

}   // namespace bedload
