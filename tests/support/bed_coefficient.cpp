#include "tests/support/bed_coefficient.hpp"

#include <cmath>
#include <random>

#include "solver/fluid/boundaries.hpp"
#include "solver/fluid/face_loops.hpp"

namespace bedload::test {

FaceFields bed_coefficient(const StaggeredGrid& g, Bed bed, double contrast) {
  std::mt19937 random(7);
  const auto uniform = [&] { return random() / 4294967296.0; };
  Field<Centre> clear(g);
  for (int i = 0; i < g.cells[0]; ++i)
    for (int j = 0; j < g.cells[1]; ++j) {
      double top = g.cells[2] / 2;
      if (bed == Bed::rough_surface) top += 6 * uniform() - 3;
      if (bed == Bed::dunes) top += 6 * std::sin(4 * M_PI * i / g.cells[0]) * std::cos(2 * M_PI * j / g.cells[1]);
      for (int k = 0; k < g.cells[2]; ++k) {
        const bool inside = bed == Bed::random_cells ? uniform() < 0.5 : k < top;
        clear[g.index(i, j, k)] = inside ? 1 / contrast : 1;
      }
    }
  fill_centre_ghosts(g, clear);
  FaceFields c(g);
  for (int m = 0; m < 3; ++m)
    for_each_unknown_face(g, m, [&](std::size_t n) { c.component(m)[n] = 0.5 * (clear[n] + clear[n - g.stride(m)]); });
  return c;
}

}   // namespace bedload::test
