#include "solver/coupling/hydrodynamic_forces.hpp"

#include <numbers>

namespace bedload {
namespace {

constexpr double least_void = 0.26;   // below close packing of equal spheres no drag law means anything

template <class Law>
void evaluate_drag(const Law& law, const Grains& grains, double viscosity, bool model_b, FlowAtGrains& flow) {
  flow.void_clamps = 0;
  for (std::size_t p = 0; p < grains.size(); ++p) {
    const double sampled = flow.void_fraction[p];
    const double eps = std::clamp(sampled, least_void, 1.0);
    flow.void_clamps += eps != sampled && sampled < least_void;
    const double d = grains.diameter[p];
    const double re = eps * norm(flow.velocity[p] - grains.velocity[p]) * d / viscosity;
    const double beta = 3 * std::numbers::pi * viscosity * d * law.multiplier(eps, re) * (model_b ? 1 : eps);
    flow.drag[p] = {beta, beta, beta};
  }
}

}   // namespace

void sample_flow(const StaggeredGrid& grid, const Grains& grains, std::span<const Stencil> stencils,
                 FaceFields& velocity, FaceFields& acceleration, Field<Centre>& void_fraction, const DragLaw& law,
                 double viscosity, const Terms& terms, FlowAtGrains& flow) {
  const std::size_t n = grains.size();
  flow.velocity.resize(n), flow.acceleration.resize(n), flow.void_fraction.resize(n);
  flow.drag.assign(n, {}), flow.force.assign(n, {});
  extend_samples(grid, velocity), extend_samples(grid, acceleration), extend_samples(grid, void_fraction);
  const Strides stride(grid);
  for (std::size_t p = 0; p < n; ++p) {
    flow.velocity[p] = sample(stencils[p], stride, velocity);
    flow.acceleration[p] = sample(stencils[p], stride, acceleration);
    flow.void_fraction[p] = sample<on_cells>(stencils[p], stride, void_fraction.data());
  }
  if (!terms.drag) return;
  std::visit([&](const auto& l) { evaluate_drag(l, grains, viscosity, terms.model_b(), flow); }, law);
}

}   // namespace bedload
