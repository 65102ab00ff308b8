#include "solver/coupling/mixture_response.hpp"

#include <algorithm>

#include "solver/fluid/face_loops.hpp"

namespace bedload {

MixtureResponse::MixtureResponse(const StaggeredGrid& g)
    : fluid(g),
      grains(g),
      coefficient(g),
      locked_exchange(g),
      mobile_exchange(g),
      mobile_fraction(g),
      mobile_inertia(g),
      locked(g),
      exchange(g),
      fraction(g),
      inertia(g) {
  for (int c = 0; c < 3; ++c)
    for_each_unknown_face(g, c, [&](std::size_t n) { fluid.component(c)[n] = coefficient.component(c)[n] = 1; });
}

namespace {

void copy(const StaggeredGrid& g, const Deposited& from, double factor, Deposited& to) {
  to.assign(g, from.reach, [&](int c, std::size_t n) { return factor * from.component(c)[n]; });
}

/// Fills B, phi_M and the inertia. Where no grain is fixed, phi_M is all solid; where densities are alike, the inertia is a
/// multiple of it.
void deposit_grains(const StaggeredGrid& g, const Grains& grains, const Stencils& stencils,
                    std::span<const Vec3> exchange, double fluid_density, const VoidFraction& void_fraction,
                    MixtureResponse& m, const KernelSmoothing& smoothing) {
  const bool all_mobile = std::all_of(grains.fixed.begin(), grains.fixed.end(), [](auto f) { return f == 0; });
  const bool alike = std::all_of(grains.density.begin(), grains.density.end(),
                                 [&](double rho) { return rho == grains.density.front(); });
  m.exchange.clear(stencils.reach);
  m.locked.clear(all_mobile ? Reach{} : stencils.reach), m.fraction.clear(all_mobile ? Reach{} : stencils.reach);
  m.inertia.clear(alike ? Reach{} : stencils.reach);
  const Strides stride(g);
  for (std::size_t p = 0; p < grains.size(); ++p) {
    const Stencil& s = stencils[p];
    const Weights weights(s);
    const bool fixed = grains.fixed[p];
    deposit(weights, stride, quad(exchange[p]), (fixed ? m.locked : m.exchange).at(s));
    if (fixed || (all_mobile && alike)) continue;
    const double volume = sphere_volume(grains.diameter[p]) / g.cell_volume();
    if (!all_mobile) deposit(weights, stride, quad(volume), m.fraction.at(s));
    if (!alike) deposit(weights, stride, quad(volume * grains.density[p] / fluid_density), m.inertia.at(s));
  }
  m.exchange.settle(m.mobile_exchange), smoothing.spread(m.mobile_exchange);
  m.locked.settle(m.locked_exchange), smoothing.spread(m.locked_exchange);
  if (all_mobile) copy(g, void_fraction.solid, 1, m.mobile_fraction);
  else m.fraction.settle(m.mobile_fraction), smoothing.spread(m.mobile_fraction);
  if (alike && grains.size() > 0) copy(g, m.mobile_fraction, grains.density.front() / fluid_density, m.mobile_inertia);
  else m.inertia.settle(m.mobile_inertia), smoothing.spread(m.mobile_inertia);
}

}   // namespace

void find_mixture_response(const StaggeredGrid& g, const Grains& grains, const Stencils& stencils,
                           std::span<const Vec3> exchange, double fluid_density, const VoidFraction& void_fraction,
                           bool model_b, MixtureResponse& m, const KernelSmoothing& smoothing) {
  const Reach former = m.mobile_fraction.reach;
  deposit_grains(g, grains, stencils, exchange, fluid_density, void_fraction, m, smoothing);
  for (int c = 0; c < 3; ++c) {
    double *cf = m.fluid.component(c), *cp = m.grains.component(c), *both = m.coefficient.component(c);
    double* phi = m.mobile_fraction.component(c);
    const double *bl = m.locked_exchange.component(c), *bm = m.mobile_exchange.component(c),
                 *inertia = m.mobile_inertia.component(c), *eps = void_fraction.face.component(c);
    for_each_face_within(g, c, former, [&](std::size_t n) { cf[n] = both[n] = 1, cp[n] = 0; });
    const auto respond = [&](std::size_t n, double taken) {
      const double on_fluid = model_b ? 1 : eps[n], on_grains = model_b ? 0 : taken;
      const double fluid_side = eps[n] + bl[n], grain_side = inertia[n] + bm[n];
      const double determinant = fluid_side * grain_side + bm[n] * inertia[n];
      const bool mobile = determinant > 0;
      cf[n] = mobile ? (on_fluid * grain_side + bm[n] * on_grains) / determinant : on_fluid / fluid_side;
      cp[n] = mobile ? ((fluid_side + bm[n]) * on_grains + bm[n] * on_fluid) / determinant : 0;
      both[n] = eps[n] * cf[n] + phi[n] * cp[n];
    };
    for_each_face_within(g, c, m.mobile_fraction.reach, [&](std::size_t n) { respond(n, phi[n]); });
    for (const OverfilledFace& f : void_fraction.overfilled) {
      if (f.direction != c) continue;
      respond(f.face, f.grain_share * phi[f.face]);
      phi[f.face] *= f.grain_share;
    }
  }
}

}   // namespace bedload
