#include "solver/coupling/mixture_response.hpp"

#include "solver/fluid/face_loops.hpp"

namespace bedload {
namespace {

/// Exchange, volume and mass of one grain on the faces of one direction, in one pass over its rows.
template <Place P>
void deposit_mobile(const Stencil& s, Strides stride, double exchange, double volume, double mass,
                    MixtureResponse& m) noexcept {
  double *b = m.mobile_exchange.component(P), *phi = m.mobile_fraction.component(P),
         *inertia = m.mobile_inertia.component(P);
  const Row along = row_weights<P>(s);
  for_each_row<P>(s, stride, [=](std::ptrdiff_t n, double w) {
    const Row weight = w * along;
    add_row(b + n, exchange * weight), add_row(phi + n, volume * weight), add_row(inertia + n, mass * weight);
  });
}

}   // namespace

void find_mixture_response(const StaggeredGrid& g, const Grains& grains, std::span<const Stencil> stencils,
                           std::span<const Vec3> exchange, double fluid_density, const VoidFraction& void_fraction,
                           bool model_b, MixtureResponse& m, const KernelSmoothing& smoothing) {
  clear(m.locked_exchange), clear(m.mobile_exchange), clear(m.mobile_fraction), clear(m.mobile_inertia);
  const Strides stride(g);
  for (std::size_t p = 0; p < grains.size(); ++p) {
    const Vec3 k = exchange[p];
    if (grains.fixed[p]) {
      deposit(stencils[p], stride, k, m.locked_exchange);
      continue;
    }
    const double volume = sphere_volume(grains.diameter[p]) / g.cell_volume(),
                 mass = volume * grains.density[p] / fluid_density;
    deposit_mobile<on_x_faces>(stencils[p], stride, k.x, volume, mass, m);
    deposit_mobile<on_y_faces>(stencils[p], stride, k.y, volume, mass, m);
    deposit_mobile<on_z_faces>(stencils[p], stride, k.z, volume, mass, m);
  }
  for (FaceFields* f : {&m.locked_exchange, &m.mobile_exchange, &m.mobile_fraction, &m.mobile_inertia})
    if (grains.size() > 0) fold_deposits(g, *f), smoothing.spread(*f);
  for (int c = 0; c < 3; ++c) {
    double *cf = m.fluid.component(c), *cp = m.grains.component(c), *both = m.coefficient.component(c);
    double* phi = m.mobile_fraction.component(c);
    const double *bl = m.locked_exchange.component(c), *bm = m.mobile_exchange.component(c),
                 *inertia = m.mobile_inertia.component(c), *eps = void_fraction.face.component(c);
    const auto respond = [&](std::size_t n, double taken) {
      const double on_fluid = model_b ? 1 : eps[n], on_grains = model_b ? 0 : taken;
      const double fluid_side = eps[n] + bl[n], grain_side = inertia[n] + bm[n];
      const double determinant = fluid_side * grain_side + bm[n] * inertia[n];
      const bool mobile = determinant > 0;
      cf[n] = mobile ? (on_fluid * grain_side + bm[n] * on_grains) / determinant : on_fluid / fluid_side;
      cp[n] = mobile ? ((fluid_side + bm[n]) * on_grains + bm[n] * on_fluid) / determinant : 0;
      both[n] = eps[n] * cf[n] + phi[n] * cp[n];
    };
    for_each_unknown_face(g, c, [&](std::size_t n) { respond(n, phi[n]); });
    for (const OverfilledFace& f : void_fraction.overfilled) {
      if (f.direction != c) continue;
      respond(f.face, f.grain_share * phi[f.face]);
      phi[f.face] *= f.grain_share;
    }
  }
}

}   // namespace bedload
