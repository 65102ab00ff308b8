// Gradient, divergence and Laplacian on the staggered grid, second order.
#pragma once

#include "solver/fluid/staggered_grid.hpp"

namespace bedload {

/// (grad q) on every unknown face; zero on walls. Reads one ghost layer of q.
void gradient(const StaggeredGrid&, const Field<Centre>& q, FaceFields& out);

/// div(factor F) on every cell; faces on walls count with the value they hold (zero for a flux). Reads face n.
void divergence(const StaggeredGrid&, const FaceFields& flux, Field<Centre>& out, double factor = 1);

/// Largest |div F| of all cells.
double largest_divergence(const StaggeredGrid&, const FaceFields& flux);

/// -grad q + viscosity lap u + drive on every unknown face; zero on walls. Reads one filled ghost layer of both.
void acceleration(const StaggeredGrid&, const Field<Centre>& q, const FaceFields& velocity, double viscosity,
                  Vec3 drive, FaceFields& out);
/// The velocity after `dt` of that acceleration, on every unknown face; `out` is another field.
void accelerated(const StaggeredGrid&, const Field<Centre>& q, const FaceFields& velocity, double viscosity, Vec3 drive,
                 double dt, FaceFields& out);

/// Laplacian of each component on every unknown face; zero on walls. Reads one filled ghost layer.
void laplacian(const StaggeredGrid&, const FaceFields& velocity, FaceFields& out);

/// Force of the fluid on the bottom and on the lid (or top) per rho_f: nu du/dz integrated over the wall [m4/s2],
/// components x and y.
struct WallShear {
  Vec3 bottom, top;
};
WallShear wall_shear(const StaggeredGrid&, const FaceFields& velocity, double viscosity);
/// The same with a viscosity that varies: on each wall that of `on_edge`, component t on the edges along t.
WallShear wall_shear(const StaggeredGrid&, const FaceFields& velocity, const FaceFields& on_edge);

}   // namespace bedload
