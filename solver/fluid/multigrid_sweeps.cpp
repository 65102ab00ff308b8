// Sweeps and transfers of one multigrid level; all inner loops run over contiguous cells of one colour.
#include <algorithm>

#include "solver/fluid/float_vectors.hpp"
#include "solver/fluid/multigrid_level.hpp"
#include "solver/fluid/split_rows.hpp"
#include "solver/fluid/wavefront.hpp"

namespace bedload {

/// The cells of one colour and parity of a plane with all that their stencil reads, as pointers that one index serves:
/// couplings w and neighbours x, lower and upper along each direction.
struct MultigridLevel::Stencil {
  const float *wx, *wx_up, *wy, *wy_up, *wz, *wz_up, *inverse_diagonal;
  const float *here, *x, *x_up, *y, *y_up, *z, *z_up;

  /// b + sum of w times neighbour, of cells n...
  template <class V>
  V gathered(V b, int n) const noexcept {
    const auto product = [n](const float* w, const float* v) { return load<V>(w + n) * load<V>(v + n); };
    return ((product(wx, x) + product(wx_up, x_up)) + (product(wy, y) + product(wy_up, y_up))) +
           ((product(wz, z) + product(wz_up, z_up)) + b);
  }
  /// b - A x of cells n...
  template <class V>
  V residual(V b, int n) const noexcept {
    const V own = load<V>(here + n);
    const auto flux = [n, own](const float* w, const float* v) { return load<V>(w + n) * (load<V>(v + n) - own); };
    return ((flux(wx, x) + flux(wx_up, x_up)) + (flux(wy, y) + flux(wy_up, y_up))) +
           ((flux(wz, z) + flux(wz_up, z_up)) + b);
  }
};

/// Calls kernel(stencil, start, first, count, j) for each row of one colour: the stencil's pointers, and others at `start`,
/// serve for the indices first, ..., first + count - 1, whole vectors of four.
template <class Kernel>
void MultigridLevel::for_each_row(int plane, Colour colour, const float* field, Kernel&& kernel) const noexcept {
  const std::size_t dx = at_.plane_stride(), dy = at_.row_stride();
  for (int parity : {0, 1}) {
    const std::size_t first_row = at_.row(plane, 0), in_plane = first_row - at_.row(plane, -1);
    const std::size_t own = 1 + parity * at_.half, other = 1 + (1 - parity) * at_.half + parity;   // the cells above
    const auto matrix = [&](int array, int i, std::size_t offset) {
      return (array < 3 ? coupling_[array] : inverse_diagonal_).data() + kept_[array][i] + in_plane + offset;
    };
    const std::size_t start = first_row + own;
    const float *wy = matrix(1, plane, own), *f = field + start, *above = field + first_row + other;
    const Stencil s{matrix(0, plane, own),
                    matrix(0, plane + 1, own),
                    wy,
                    wy + dy,
                    matrix(2, plane, own),
                    matrix(2, plane, other),
                    matrix(3, plane, own),
                    f,
                    f - dx,
                    f + dx,
                    f - dy,
                    f + dy,
                    above - 1,
                    above};
    const int count = SplitGrid::padded((at_.cells[2] - parity + 1) / 2);
    for (int j = (plane + colour + parity) & 1; j < at_.cells[1]; j += 2)
      kernel(s, start, j * at_.row_stride(), count, j);
  }
}

/// Ghosts are renewed behind the cells that read them, so a whole colour sees the values of before its sweep.
void MultigridLevel::relax(int plane, Colour colour) noexcept {
  for_each_row(plane, colour, x_.data(), [this](const Stencil& s, std::size_t start, int first, int count, int) {
    const float *b = &right_[start] + first, *inverse = s.inverse_diagonal + first;
    float* x = &x_[start] + first;
    for_each_vector(count, [=](auto v, int m) {
      using V = decltype(v);
      store(x + m, load<V>(inverse + m) * s.gathered(load<V>(b + m), first + m));
    });
  });
  wrap(plane);
}

/// The first red half-sweep from zero needs no neighbours.
void MultigridLevel::begin_with_red(int plane) noexcept {
  for_each_row(plane, red, x_.data(), [this](const Stencil& s, std::size_t start, int first, int count, int) {
    const float *b = &right_[start] + first, *inverse = s.inverse_diagonal + first;
    float* __restrict x = &x_[start] + first;
    for (int m = 0; m < count; ++m) x[m] = inverse[m] * b[m];
  });
  wrap(plane);
}

void MultigridLevel::wrap(int plane) noexcept {
  at_.wrap_cells(x_.data(), plane);
  at_.wrap_rows(x_.data(), plane);
}

void MultigridLevel::smooth_and_restrict(MultigridLevel& coarse, Ratio ratio) noexcept {
  if (at_.seam) std::fill(x_.begin(), x_.end(), 0.0f);   // across a seam black cells read black ones
  wavefront(
      at_.cells[0], [&] { at_.wrap_planes(x_.data()); }, [&](int i) { begin_with_red(i); },
      [&](int i) { relax(i, black); }, [&](int i) { relax(i, red); }, [&](int i) { relax(i, black); },
      [&](int i) { ratio == along_z ? restrict_along_z(i, coarse) : restrict_residual(i, coarse, ratio); });
}

double MultigridLevel::correct_and_smooth(const MultigridLevel& coarse, Ratio ratio) noexcept {
  wavefront(
      at_.cells[0], [&] { at_.wrap_planes(x_.data()); },
      [&](int i) { ratio == along_z ? interpolate_along_z(i, coarse) : add_correction(i, coarse, ratio); },
      [&](int i) { relax(i, black); }, [&](int i) { relax(i, red); }, [&](int i) { relax(i, black); },
      [&](int i) {
        relax(i, red);
        DotProduct sum;
        sum.add(at_.plane_of_rows(), &x_[at_.row(i, 0)], &right_[at_.row(i, 0)]);
        sums_[i] = sum.value();
      });
  return sums_.value();
}

double MultigridLevel::apply(int plane, const float* field, float* image) const noexcept {
  for (Colour colour : {red, black})
    for_each_row(plane, colour, field, [image](const Stencil& s, std::size_t start, int first, int count, int) {
      for_each_vector(count,
                      [=, out = image + start + first](auto v, int m) { store(out + m, -s.residual(v, first + m)); });
    });
  at_.clear_ghost_cells(image, plane);   // the coupling across the seam stands there too
  DotProduct sum;
  sum.add(at_.plane_of_rows(), field + at_.row(plane, 0), image + at_.row(plane, 0));
  return sum.value();
}

/// The residual of one colour, rows as even cells and odd cells.
void MultigridLevel::find_residual(int plane, Colour colour) noexcept {
  for_each_row(plane, colour, x_.data(), [&](const Stencil& s, std::size_t start, int first, int count, int j) {
    const float* b = &right_[start] + first;
    float* out = &aggregates_[j * at_.row_stride() + ((plane + j + colour) & 1) * at_.half];
    for_each_vector(count, [=](auto v, int m) { store(out + m, s.residual(load<decltype(v)>(b + m), first + m)); });
  });
}

/// Adds the residual of one colour to the rows of aggregates. Beyond the cells stands a ghost with a coupling, whose
/// residual is none.
void MultigridLevel::add_residual(int plane, Colour colour, Ratio ratio) noexcept {
  for_each_row(plane, colour, x_.data(), [&](const Stencil& s, std::size_t start, int first, int count, int j) {
    const float* b = &right_[start] + first;
    float* sums = &aggregates_[j / ratio[1] * at_.row_stride()];
    const int parity = (plane + j + colour) & 1, cells = (at_.cells[2] - parity + 1) / 2;
    float& beyond = sums[ratio[2] == 2 ? cells : 2 * cells + parity];
    const float kept = beyond;
    for_each_vector(count, [=](auto v, int m) {
      using V = decltype(v);
      const V left = s.residual(load<V>(b + m), first + m);
      if (ratio[2] == 2) return store(sums + m, load<V>(sums + m) + left);
      for (int lane = 0; lane < int(sizeof(V) / sizeof(float)); ++lane) sums[2 * (m + lane) + parity] += left[lane];
    });
    beyond = kept;
  });
}

/// After a black half-sweep only red cells have a residual, unless cells of one colour meet at a seam. The first plane of
/// an aggregate comes first.
void MultigridLevel::restrict_residual(int plane, MultigridLevel& coarse, Ratio ratio) noexcept {
  const int I = plane / ratio[0], nz = coarse.at_.cells[2];
  std::fill_n(aggregates_.begin(), coarse.at_.cells[1] * at_.row_stride(), 0.0f);
  add_residual(plane, red, ratio);
  if (at_.seam) add_residual(plane, black, ratio);
  for (int J = 0; J < coarse.at_.cells[1]; ++J) {
    const float* sums = &aggregates_[J * at_.row_stride()];
    float *even = &coarse.right_[coarse.at_.at(I, J, 0)], *odd = &coarse.right_[coarse.at_.at(I, J, 1)];
    if (plane % ratio[0] == 0) split_row(sums, 1.0f, nz, even, odd);
    else add_split_row(sums, 1.0f, nz, even, odd);
  }
}

/// Without a seam the black half-sweep that follows overwrites black cells before anyone reads them.
void MultigridLevel::add_correction(int plane, const MultigridLevel& coarse, Ratio ratio) noexcept {
  const int I = plane / ratio[0];
  for (int J = 0; J < coarse.at_.cells[1]; ++J)
    join_row(&coarse.x_[coarse.at_.at(I, J, 0)], &coarse.x_[coarse.at_.at(I, J, 1)], coarse.at_.cells[2],
             &aggregates_[J * at_.row_stride()]);
  for (Colour colour : {red, black}) {
    if (colour == black && !at_.seam) continue;
    for_each_row(plane, colour, x_.data(), [&](const Stencil&, std::size_t start, int first, int, int j) {
      const int parity = (plane + j + colour) & 1, count = (at_.cells[2] - parity + 1) / 2;
      const float* __restrict correction = &aggregates_[j / ratio[1] * at_.row_stride()];
      float* __restrict x = &x_[start] + first;
      if (ratio[2] == 2)
        for (int m = 0; m < count; ++m) x[m] += correction[m];
      else
        for (int m = 0; m < count; ++m) x[m] += correction[2 * m + parity];
    });
  }
  wrap(plane);
}

}   // namespace bedload
