// Several sweeps over the x-planes in one pass through memory.
#pragma once

#include <algorithm>

namespace bedload {
namespace wavefront_detail {

template <class Stage>
void finish(int planes, int lag, Stage& stage) {
  for (int i = std::max(lag, planes - lag); i < planes; ++i) stage(i);
  for (int i = 0; i < std::min(lag, planes); ++i) stage(i);
}

}   // namespace wavefront_detail

/// Runs each stage on every plane, a later stage on a plane as soon as the stage before it has passed the planes on
/// both sides, so that planes are still in cache; the result is that of one full sweep after the other. `refresh`
/// renews the ghost planes; it runs after each stage has seen all planes, so a stage reads its own old values across a
/// periodic seam.
template <class Refresh, class First, class Second>
void wavefront(int planes, Refresh&& refresh, First&& first, Second&& second) {
  for (int i = 0; i < planes; ++i) {
    first(i);
    if (i >= 2) second(i - 1);
  }
  refresh();
  wavefront_detail::finish(planes, 1, second);
  refresh();
}

/// The same for three stages.
template <class Refresh, class First, class Second, class Third>
void wavefront(int planes, Refresh&& refresh, First&& first, Second&& second, Third&& third) {
  for (int i = 0; i < planes; ++i) {
    first(i);
    if (i >= 2) second(i - 1);
    if (i >= 4) third(i - 2);
  }
  refresh();
  wavefront_detail::finish(planes, 1, second);
  refresh();
  wavefront_detail::finish(planes, 2, third);
  refresh();
}

}   // namespace bedload
