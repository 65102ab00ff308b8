// Fields as grains read and write them: the values that belong to one cell side by side, and beyond the sides of the box the
// image of what lies inside.
//
// A grain near a side writes to ghosts as if the box went on: settle() brings that home (round the period, or reflected at a
// wall); read() fills ghosts with what lies at home: the transpose. Work is done only where grains reach, so that a lone grain
// in a large box, or a bed at the bottom of a channel, costs no more than what it touches.
#pragma once

#include <memory>

#include "solver/coupling/kernel.hpp"

namespace bedload {

/// The planes that a deposit within `reach` fills once it is home: ghosts left out, faces on walls kept.
Reach home_of(const StaggeredGrid&, const Reach&);
/// The whole grid, without ghosts, faces on walls included.
Reach whole(const StaggeredGrid&);
/// The reach widened by `planes` cells in every direction; whole where it then meets a seam, with as
/// many planes of ghosts on either side as it goes beyond.
Reach widened(const StaggeredGrid&, Reach, int planes);
/// With all ghosts beyond the seams that a reach meets: for what grains write on their way across one.
Reach across_seams(const StaggeredGrid&, Reach);
/// What holds both.
Reach united(const Reach&, const Reach&);

/// Calls body(padded index, length) for each row along z of a box.
template <class Body>
inline void for_each_row(const StaggeredGrid& g, const Reach& box, Body&& body) {
  for (int i = box.first[0]; i < box.last[0]; ++i)
    for (int j = box.first[1]; j < box.last[1]; ++j) body(g.index(i, j, box.first[2]), box.last[2] - box.first[2]);
}

/// The same for the parts of rows of a box that lie outside another.
template <class Body>
inline void for_each_row_beyond(const StaggeredGrid& g, const Reach& box, const Reach& inner, Body&& body) {
  const int below = box.first[2], above = box.last[2];
  const int first = std::clamp(inner.first[2], below, std::max(below, above)),
            last = std::clamp(inner.last[2], first, std::max(first, above));
  for (int i = box.first[0]; i < box.last[0]; ++i)
    for (int j = box.first[1]; j < box.last[1]; ++j) {
      const bool crosses = i >= inner.first[0] && i < inner.last[0] && j >= inner.first[1] && j < inner.last[1];
      const auto part = [&](int from, int to) {
        if (from < to) body(g.index(i, j, from), to - from);
      };
      if (!crosses) part(below, above);
      else part(below, first), part(last, above);
    }
}

/// Calls visit(padded index) for every unknown face normal to c in a box.
template <class Visit>
inline void for_each_face_within(const StaggeredGrid& g, int c, Reach box, Visit&& visit) {
  box.first[c] = std::max(box.first[c], g.first_face(c));
  for (int t = 0; t < 3; ++t) box.last[t] = std::min(box.last[t], g.cells[t]);
  for_each_row(g, box, [&](std::size_t row, int length) {
    for (std::size_t n = row; n < row + std::max(length, 0); ++n) visit(n);
  });
}

/// A field on faces or edges that grains have written: zero where they did not reach.
struct Deposited : FaceFields {
  Deposited() = default;
  explicit Deposited(const StaggeredGrid& g) : FaceFields(g) {}
  Reach reach;   // no ghosts

  /// value(direction, padded index) within a reach, zero beyond.
  template <class Value>
  void assign(const StaggeredGrid& g, const Reach& to, Value&& value) {
    clear_beyond(g, to);
    reach = to;
    for_each_row(g, to, [&](std::size_t row, int length) {
      for (int c = 0; c < 3; ++c)
        for (std::size_t n = row; n < row + length; ++n) component(c)[n] = value(c, n);
    });
  }
  void clear(const StaggeredGrid& g) {
    for_each_row(g, reach, [&](std::size_t row, int length) {
      for (int c = 0; c < 3; ++c) std::fill_n(component(c) + row, length, 0.0);
    });
    reach = {};
  }
  /// Clears what lies outside a box that is about to be written whole.
  void clear_beyond(const StaggeredGrid& g, const Reach& box) {
    for_each_row_beyond(g, reach, box, [&](std::size_t row, int length) {
      for (int c = 0; c < 3; ++c) std::fill_n(component(c) + row, length, 0.0);
    });
  }
};

/// Leaves memory as it comes: pages that grains never reach are never touched.
template <class T>
struct Untouched : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = Untouched<U>;
  };
  using std::allocator<T>::allocator;
  template <class U>
  void construct(U* place) noexcept {
    ::new (static_cast<void*>(place)) U;
  }
  template <class U>
  void construct(U* place, const U& value) noexcept {
    ::new (static_cast<void*>(place)) U(value);
  }
};

/// A woven field, in the padded shape of all fields; it holds values within the reach of the last read or clear. Copies share
/// its memory: scratch that many use in turns stays in the cache.
class Woven {
 public:
  Woven() = default;
  explicit Woven(const StaggeredGrid& g, On where = On::faces)
      : grid_(g), where_(where), cells_(std::make_shared<Cells>(g.padded_size())), data_(cells_->data()) {}
  /// In the memory of another, which the use of either overwrites.
  Woven(const Woven& other, On where) : Woven(other) { where_ = where; }

  bool fits(const StaggeredGrid& g) const { return grid_ == g && cells_; }
  const Quad* at(const Stencil& s) const { return data_ + s.corner; }
  Quad* at(const Stencil& s) { return data_ + s.corner; }
  Quad* data() { return data_; }

  /// Takes the fields up within the reach; `in_cells` may be null.
  void read(const Reach&, const FaceFields&, const Field<Centre>* in_cells = nullptr);
  /// Zero within the reach: before a deposit.
  void clear(const Reach&);
  /// After a deposit: brings home what was written into ghosts, and writes it out; the rest of the field is zero.
  void settle(Deposited&, Field<Centre>* in_cells = nullptr);

 private:
  void fold_along(int direction, const Reach&);

  StaggeredGrid grid_;
  On where_ = On::faces;
  Reach reach_;   // of the last clear
  using Cells = std::vector<Quad, Untouched<Quad>>;
  std::shared_ptr<Cells> cells_;
  Quad* data_ = nullptr;   // of cells_
};

}   // namespace bedload
