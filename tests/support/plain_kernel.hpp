// The kernel written plainly, one field and one grain at a time: what the woven fields of the solver are compared with.
#pragma once

#include "solver/coupling/kernel.hpp"

namespace bedload::test {

/// Weight of a plane of cells or faces, of the three round a grain along one direction.
inline double plain_weight(const Stencil& s, int place, int direction, int plane) {
  const double f = s.fraction[direction];
  if (has_hat(place, direction)) return plane == 0 ? 0 : plane == 1 ? 1 - f : f;
  return quadratic_spline(f - 0.5)[plane];
}

/// Calls visit(padded index, weight) for each value of a field that a grain reads.
template <class Visit>
void for_each_weight(const Stencil& s, Strides stride, int place, Visit&& visit) {
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      for (int c = 0; c < 3; ++c)
        visit(s.corner + a * stride.x + b * stride.y + c,
              plain_weight(s, place, 0, a) * plain_weight(s, place, 1, b) * plain_weight(s, place, 2, c));
}

/// Value of one field at a grain, its ghosts extended.
inline double sample(const Stencil& s, Strides stride, int place, const double* field) {
  double sum = 0;
  for_each_weight(s, stride, place, [&](std::ptrdiff_t n, double w) { sum += w * field[n]; });
  return sum;
}
inline Vec3 sample(const Stencil& s, Strides stride, const FaceFields& f, int first = on_x_faces) {
  return {sample(s, stride, first, f.component(0)), sample(s, stride, first + 1, f.component(1)),
          sample(s, stride, first + 2, f.component(2))};
}

/// Adds `amount` with the same weights; ghosts go home by fold_deposits.
inline void deposit(const Stencil& s, Strides stride, Vec3 amount, FaceFields& f, int first = on_x_faces) {
  for (int c = 0; c < 3; ++c)
    for_each_weight(s, stride, first + c, [&](std::ptrdiff_t n, double w) { f.component(c)[n] += w * amount[c]; });
}

inline void clear(FaceFields& f) {
  for (int c = 0; c < 3; ++c) std::fill_n(f.component(c), f.x.values.size(), 0.0);
}

/// Fills the ghosts that grains read: periodic copies; reflected at walls with the same sign (what lies on walls keeps its own
/// value). `first`: on_x_faces or on_x_edges.
void extend_samples(const StaggeredGrid&, FaceFields&, int first = on_x_faces);
void extend_samples(const StaggeredGrid&, Field<Centre>&);

/// Adds what grains wrote into ghosts to what they stand for, and clears the ghosts.
void fold_deposits(const StaggeredGrid&, FaceFields&, int first = on_x_faces);

}   // namespace bedload::test
