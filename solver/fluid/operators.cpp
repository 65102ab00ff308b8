// Central differences of second order, row by row along z.
#include "solver/fluid/operators.hpp"

#include <cmath>

#include "solver/fluid/face_loops.hpp"

namespace bedload {

void gradient(const StaggeredGrid& g, const Field<Centre>& q, FaceFields& out) {
  for (int c = 0; c < 3; ++c) {
    const std::ptrdiff_t s = g.stride(c);
    const double per_h = 1 / g.h[c];
    for_each_face_row(g, c, [&](std::size_t row, int length) {
      const double* __restrict value = q.data() + row;
      double* __restrict slope = out.component(c) + row;
      for (int k = 0; k < length; ++k) slope[k] = (value[k] - value[k - s]) * per_h;
    });
  }
  clear_walls(g, out);
}

void divergence(const StaggeredGrid& g, const FaceFields& flux, Field<Centre>& out, double factor) {
  const std::ptrdiff_t sx = g.stride(0), sy = g.stride(1);
  const double per_x = 1 / g.h.x, per_y = 1 / g.h.y, per_z = 1 / g.h.z;
  for_each_cell_row(g, [&](std::size_t row, int length) {
    const double* __restrict fx = flux.x.data() + row;
    const double* __restrict fy = flux.y.data() + row;
    const double* __restrict fz = flux.z.data() + row;
    double* __restrict div = out.data() + row;
    for (int k = 0; k < length; ++k)
      div[k] = (fx[k + sx] * factor - fx[k] * factor) * per_x + (fy[k + sy] * factor - fy[k] * factor) * per_y +
               (fz[k + 1] * factor - fz[k] * factor) * per_z;
  });
}

double largest_divergence(const StaggeredGrid& g, const FaceFields& flux) {
  const std::ptrdiff_t sx = g.stride(0), sy = g.stride(1);
  const double per_x = 1 / g.h.x, per_y = 1 / g.h.y, per_z = 1 / g.h.z;
  LaneMax largest;
  for_each_cell_row(g, [&](std::size_t row, int length) {
    const double *fx = flux.x.data() + row, *fy = flux.y.data() + row, *fz = flux.z.data() + row;
    largest.add_row(length, [=](int k) {
      return std::abs((fx[k + sx] - fx[k]) * per_x + (fy[k + sy] - fy[k]) * per_y + (fz[k + 1] - fz[k]) * per_z);
    });
  });
  return largest.value();
}

void laplacian(const StaggeredGrid& g, const FaceFields& velocity, FaceFields& out) {
  const std::ptrdiff_t sx = g.stride(0), sy = g.stride(1);
  const double ax = 1 / (g.h.x * g.h.x), ay = 1 / (g.h.y * g.h.y), az = 1 / (g.h.z * g.h.z);
  for (int c = 0; c < 3; ++c) {
    for_each_face_row(g, c, [&](std::size_t row, int length) {
      const double* __restrict u = velocity.component(c) + row;
      double* __restrict lap = out.component(c) + row;
      for (int k = 0; k < length; ++k)
        lap[k] = ((u[k + sx] - u[k]) - (u[k] - u[k - sx])) * ax + ((u[k + sy] - u[k]) - (u[k] - u[k - sy])) * ay +
                 ((u[k + 1] - u[k]) - (u[k] - u[k - 1])) * az;
    });
  }
  clear_walls(g, out);
}

namespace {

/// take(c, row, length, a) for each row of unknown faces normal to c, where a(k) is the acceleration of face row + k. All components of a plane follow each other:
/// they read the same pressure.
template <class Take>
void for_each_acceleration(const StaggeredGrid& g, const Field<Centre>& q, const FaceFields& velocity, double viscosity,
                           Vec3 drive, Take&& take) {
  const std::ptrdiff_t sx = g.stride(0), sy = g.stride(1);
  const double ax = 1 / (g.h.x * g.h.x), ay = 1 / (g.h.y * g.h.y), az = 1 / (g.h.z * g.h.z);
  const auto of_component = [&](int i, int c) {
    const std::ptrdiff_t s = g.stride(c);
    const double per_h = 1 / g.h[c], along = drive[c];
    for_each_face_row_of_plane(g, c, i, [&](std::size_t row, int length) {
      const double* u = velocity.component(c) + row;
      const double* value = q.data() + row;
      take(c, row, length, [=](int k) {
        const double lap = ((u[k + sx] - u[k]) - (u[k] - u[k - sx])) * ax +
                           ((u[k + sy] - u[k]) - (u[k] - u[k - sy])) * ay +
                           ((u[k + 1] - u[k]) - (u[k] - u[k - 1])) * az;
        return -((value[k] - value[k - s]) * per_h) + viscosity * lap + along;
      });
    });
  };
  for (int i = 0; i < g.cells[0]; ++i)
    for (int c = 0; c < 3; ++c) of_component(i, c);
}

}   // namespace

void acceleration(const StaggeredGrid& g, const Field<Centre>& q, const FaceFields& velocity, double viscosity,
                  Vec3 drive, FaceFields& out) {
  for_each_acceleration(g, q, velocity, viscosity, drive, [&](int c, std::size_t row, int length, auto a) {
    double* __restrict to = out.component(c) + row;
    for (int k = 0; k < length; ++k) to[k] = a(k);
  });
  clear_walls(g, out);
}

void accelerated(const StaggeredGrid& g, const Field<Centre>& q, const FaceFields& velocity, double viscosity,
                 Vec3 drive, double dt, FaceFields& out) {
  for_each_acceleration(g, q, velocity, viscosity, drive, [&](int c, std::size_t row, int length, auto a) {
    double* __restrict to = out.component(c) + row;
    const double* u = velocity.component(c) + row;
    for (int k = 0; k < length; ++k) to[k] = u[k] + dt * a(k);
  });
}

namespace {

/// scale (u in the cells beside the wall - ghost)/h_z integrated over both walls, times at(c, index of the edge on the wall).
template <class AtEdge>
WallShear shear_on_walls(const StaggeredGrid& g, const FaceFields& velocity, double scale, AtEdge&& at) {
  WallShear shear;
  if (g.periodic(2)) return shear;
  const double weight = scale * g.h.x * g.h.y / g.h.z;
  for (int c = 0; c < 2; ++c) {
    const double* u = velocity.component(c);
    for (int i = c == 0 ? g.first_face(0) : 0; i < g.cells[0]; ++i) {
      double bottom = 0, top = 0;
      for (int j = c == 1 ? g.first_face(1) : 0; j < g.cells[1]; ++j) {
        const std::size_t low = g.index(i, j, 0), high = g.index(i, j, g.cells[2] - 1);
        bottom += at(c, low) * (u[low] - u[low - 1]);
        top += at(c, high + 1) * (u[high] - u[high + 1]);
      }
      shear.bottom[c] += weight * bottom;
      shear.top[c] += weight * top;
    }
  }
  return shear;
}

}   // namespace

WallShear wall_shear(const StaggeredGrid& g, const FaceFields& velocity, double viscosity) {
  return shear_on_walls(g, velocity, viscosity, [](int, std::size_t) { return 1.0; });
}

WallShear wall_shear(const StaggeredGrid& g, const FaceFields& velocity, const FaceFields& on_edge) {
  return shear_on_walls(g, velocity, 1, [&](int c, std::size_t n) { return on_edge.component(1 - c)[n]; });
}

}   // namespace bedload
