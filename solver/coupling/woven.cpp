#include "solver/coupling/woven.hpp"

namespace bedload {
namespace {

constexpr int ghosts = StaggeredGrid::ghosts;

/// The plane inside for which plane p stands, ghosts included: round the period, or reflected at walls; faces on walls, and
/// what would lie beyond them, stand for themselves.
int home_plane(const StaggeredGrid& g, int place, int direction, int p) {
  const int n = g.cells[direction];
  if (g.periodic(direction)) return (p + ghosts * n) % n;
  if (has_hat(place, direction)) return p;
  return std::clamp(p < 0 ? -1 - p : p >= n ? 2 * n - 1 - p : p, 0, n - 1);
}

}   // namespace

Reach home_of(const StaggeredGrid& g, const Reach& reach) {
  if (reach.empty()) return {};
  Reach home;
  for (int c = 0; c < 3; ++c) {
    home.first[c] = std::max(reach.first[c], 0);
    home.last[c] = std::min(reach.last[c], g.cells[c] + (g.periodic(c) ? 0 : 1));
  }
  return home;
}

Reach whole(const StaggeredGrid& g) {
  Reach all;
  for (int c = 0; c < 3; ++c) all.last[c] = g.cells[c] + (g.periodic(c) ? 0 : 1);
  return all;
}

Reach widened(const StaggeredGrid& g, Reach reach, int planes) {
  if (reach.empty()) return reach;
  for (int c = 0; c < 3; ++c) {
    const int n = g.cells[c];
    reach.first[c] = std::max(reach.first[c] - planes, -ghosts);
    reach.last[c] = std::min(reach.last[c] + planes, n + ghosts);
    if (const int beyond = std::max(-reach.first[c], reach.last[c] - n); g.periodic(c) && beyond > 0)
      reach.first[c] = -beyond, reach.last[c] = n + beyond;
  }
  return reach;
}

Reach across_seams(const StaggeredGrid& g, Reach reach) {
  for (int c = 0; c < 3; ++c)
    if (g.periodic(c) && reach.first[c] < 0) reach.first[c] = -ghosts, reach.last[c] = g.cells[c] + ghosts;
  return reach;
}

Reach united(const Reach& a, const Reach& b) {
  if (a.empty() || b.empty()) return a.empty() ? b : a;
  Reach both;
  for (int c = 0; c < 3; ++c)
    both.first[c] = std::min(a.first[c], b.first[c]), both.last[c] = std::max(a.last[c], b.last[c]);
  return both;
}

void Woven::read(const Reach& reach, const FaceFields& fields, const Field<Centre>* in_cells) {
  const auto home = [&](int entry, int direction, int p) {
    return home_plane(grid_, static_cast<int>(where_) + entry, direction, p);
  };
  const int below = reach.first[2], above = reach.last[2], n = grid_.cells[2];
  const int first = std::clamp(0, below, above), last = std::clamp(n, first, above);
  const double* source[4];   // row of each entry, from k = 0
  const auto take = [&](int k) {
    Quad q{};
    for (int t = 0; t < 4; ++t)
      if (source[t]) q[t] = source[t][home(t, 2, k)];
    return q;
  };
  for (int i = reach.first[0]; i < reach.last[0]; ++i)
    for (int j = reach.first[1]; j < reach.last[1]; ++j) {
      for (int t = 0; t < 4; ++t) {
        const double* field = t < 3 ? fields.component(t) : in_cells ? in_cells->data() : nullptr;
        source[t] = field ? field + grid_.index(home(t, 0, i), home(t, 1, j), 0) : nullptr;
      }
      Quad* const row = data_ + grid_.index(i, j, 0);
      for (int k = below; k < first; ++k) row[k] = take(k);
      const double *x = source[0], *y = source[1], *z = source[2], *cell = source[3];
      if (cell)
        for (int k = first; k < last; ++k) row[k] = Quad{x[k], y[k], z[k], cell[k]};
      else
        for (int k = first; k < last; ++k) row[k] = quad({x[k], y[k], z[k]});
      for (int k = last; k < above; ++k) row[k] = take(k);
    }
}

void Woven::clear(const Reach& reach) {
  reach_ = reach;
  for_each_row(grid_, reach, [&](std::size_t row, int length) { std::fill_n(data_ + row, length, Quad{}); });
}

/// Of a plane of ghosts, what stands for a plane inside goes there; what is its own stays.
void Woven::fold_along(int c, const Reach& box) {
  const int n = grid_.cells[c];
  Quad goes;
  for (int t = 0; t < 4; ++t) goes[t] = grid_.periodic(c) || !has_hat(where_, t, c) ? 1 : 0;
  for (int p = box.first[c]; p < box.last[c]; ++p) {
    if (p >= 0 && p < n) continue;
    const std::ptrdiff_t to = (home_plane(grid_, on_cells, c, p) - p) * grid_.stride(c);
    Reach plane = box;
    plane.first[c] = p, plane.last[c] = p + 1;
    for_each_row(grid_, plane, [&](std::size_t row, int length) {
      for (Quad *q = data_ + row, *end = q + length; q != end; ++q) q[to] += *q * goes, *q -= *q * goes;
    });
  }
}

void Woven::settle(Deposited& out, Field<Centre>* in_cells) {
  for (const int c : {2, 1, 0}) fold_along(c, reach_);
  const Reach home = home_of(grid_, reach_);
  if (in_cells)
    for_each_row_beyond(grid_, out.reach, home,
                        [&](std::size_t row, int length) { std::fill_n(in_cells->data() + row, length, 0.0); });
  out.clear_beyond(grid_, home);
  out.reach = home;
  for_each_row(grid_, home, [&](std::size_t row, int length) {
    const Quad* __restrict q = data_ + row;
    double* __restrict x = out.component(0) + row;
    double* __restrict y = out.component(1) + row;
    double* __restrict z = out.component(2) + row;
    for (int k = 0; k < length; ++k) x[k] = q[k][0], y[k] = q[k][1], z[k] = q[k][2];
    if (double* cell = in_cells ? in_cells->data() + row : nullptr)
      for (int k = 0; k < length; ++k) cell[k] = q[k][3];
  });
}

}   // namespace bedload
