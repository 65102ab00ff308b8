#include "solver/coupling/mixture_response.hpp"

#include "solver/fluid/face_loops.hpp"

namespace bedload {
namespace {

void clear(FaceFields& f) {
  for (int c = 0; c < 3; ++c) std::fill_n(f.component(c), f.x.values.size(), 0.0);
}

template <int C>
void deposit_mobile(const Stencil& s, double exchange, double volume, double mass, MixtureResponse& m) noexcept {
  double *b = m.mobile_exchange.component(C), *phi = m.mobile_fraction.component(C), *inertia = m.mobile_inertia.component(C);
  for_each_face<C>(s, [=](std::int32_t n, double w) { b[n] += w * exchange, phi[n] += w * volume, inertia[n] += w * mass; });
}

}  // namespace

void find_mixture_response(const StaggeredGrid& g, const Grains& grains, std::span<const Stencil> stencils, std::span<const double> exchange,
                           double fluid_density, const FaceFields& void_fraction, bool model_b, MixtureResponse& m) {
  clear(m.locked_exchange), clear(m.mobile_exchange), clear(m.mobile_fraction), clear(m.mobile_inertia);
  for (std::size_t p = 0; p < grains.size(); ++p) {
    const double k = exchange[p];
    if (grains.fixed[p]) {
      deposit(stencils[p], {k, k, k}, m.locked_exchange);
      continue;
    }
    const double volume = sphere_volume(grains.diameter[p]) / g.cell_volume(), mass = volume * grains.density[p] / fluid_density;
    deposit_mobile<0>(stencils[p], k, volume, mass, m);
    deposit_mobile<1>(stencils[p], k, volume, mass, m);
    deposit_mobile<2>(stencils[p], k, volume, mass, m);
  }
  for (int c = 0; c < 3; ++c) {
    double *cf = m.fluid.component(c), *cp = m.grains.component(c), *both = m.coefficient.component(c);
    const double *bl = m.locked_exchange.component(c), *bm = m.mobile_exchange.component(c), *phi = m.mobile_fraction.component(c),
                 *inertia = m.mobile_inertia.component(c), *eps = void_fraction.component(c);
    for_each_unknown_face(g, c, [&](std::size_t n) {
      const double on_fluid = model_b ? 1 : eps[n], on_grains = model_b ? 0 : phi[n];
      const double fluid_side = eps[n] + bl[n], grain_side = inertia[n] + bm[n];
      const double determinant = fluid_side * grain_side + bm[n] * inertia[n];
      const bool mobile = determinant > 0;
      cf[n] = mobile ? (on_fluid * grain_side + bm[n] * on_grains) / determinant : on_fluid / fluid_side;
      cp[n] = mobile ? ((fluid_side + bm[n]) * on_grains + bm[n] * on_fluid) / determinant : 0;
      both[n] = eps[n] * cf[n] + phi[n] * cp[n];
    });
  }
}

}  // namespace bedload
