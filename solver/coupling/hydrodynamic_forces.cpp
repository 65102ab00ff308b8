#include "solver/coupling/hydrodynamic_forces.hpp"

#include <numbers>

namespace bedload {
namespace {

constexpr double largest_removed = 0.7;   // of the slip: errors of the tables grow as 1/(1 - k)

/// beta/rho_f = 3 pi nu d F eps of one grain, or of four; without the eps in Model B.
template <class Law, class Real>
Real drag_coefficient(const Law& law, Real diameter, Real eps, Real slip, double viscosity, bool model_b) {
  const Real multiplier = law.multiplier(eps, eps * slip * diameter / viscosity);
  return 3 * std::numbers::pi * viscosity * diameter * multiplier * (model_b ? Real{} + 1 : eps);
}

/// Share k of the slip that the own drag takes away, beta r/nu, less what the drag solve takes from it by handing beta to each
/// face at the face's own velocity: there the flow is made even. `applied`: the coefficient that the solve gets, per beta.
double slip_taken(double beta, double response, double unevenness, double applied, double viscosity) {
  constexpr double narrow = 0.4;   // response of that unevenness to itself, per k: 0.25 to 0.43 where it matters
  const double k = beta * response / viscosity;
  return k - k * k * unevenness * applied / (1 + narrow * k * applied);
}

/// Drag per *sampled* slip of a lone grain, per axis, such that it feels the law's drag under its slip against the flow that
/// would be there without it: w = (u_s - v)(1 - V D)/(1 - k), by fixed-point passes. In Model A the grain also samples the
/// stress by which the fluid passes its own drag on, V S of it: the drag is less by 1 + V S.
template <class Coefficient>
Vec3 drag_without_own_flow(const Coefficient& coefficient, const SelfDisturbance& disturbance, Vec3 position,
                           Vec3 sampled, double volume, double lone, double viscosity, bool model_b, Vec3& removed,
                           std::uint64_t& clamps) {
  constexpr int passes = 4;
  Vec3 slip = sampled, gain{1, 1, 1}, drag;   // gain: of the slip over the sampled one
  bool clamped = false;
  for (int pass = 0; pass < passes; ++pass) {
    const double beta = coefficient(norm(slip));
    // The own flow goes along with the grain at about a third of its peak, where it is sampled.
    const OwnFlow own = disturbance.at(position, slip + (sampled - slip) / 3, viscosity);
    clamped = false;
    for (int c = 0; c < 3; ++c) {
      const double k = slip_taken(beta, own.drag[c], own.unevenness[c], gain[c], viscosity);
      clamped |= k > largest_removed;
      gain[c] = (1 - lone * volume * own.displacement[c]) / (1 - lone * std::min(k, largest_removed));
      const double stress = model_b ? 0 : lone * volume * own.stress[c];
      drag[c] = beta * gain[c] / (1 + stress);
      removed[c] = 1 - (1 + stress) / gain[c];   // of beta = 0 too
    }
    slip = scaled(sampled, gain);
  }
  clamps += clamped;
  return drag;
}

template <class Law>
void evaluate_drag(const Law& law, const StaggeredGrid& grid, const Grains& grains, double viscosity, bool model_b,
                   FlowAtGrains& flow) {
  const std::size_t n = grains.size();
  for (std::size_t first = 0; first < n; first += 4) {
    const std::size_t count = std::min<std::size_t>(n - first, 4);
    Quad lone{}, eps = quad(1.0), diameter{}, speed{};
    Vec3 slip[4];
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t p = first + k;
      lone[k] = flow.packing.loneness(p);
      const double surroundings = flow.void_fraction[p] + lone[k] * flow.packing.own[p];
      eps[k] = std::clamp(surroundings, least_void, 1.0);
      flow.void_clamps += eps[k] != surroundings && surroundings < least_void;
      diameter[k] = grains.diameter[p];
      slip[k] = flow.velocity[p] - grains.velocity[p];
      speed[k] = norm(slip[k]);
    }
    const Quad beta = drag_coefficient(law, diameter, eps, speed, viscosity, model_b);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t p = first + k;
      flow.drag[p] = {beta[k], beta[k], beta[k]};
      if (!flow.self_disturbance || !(lone[k] > 0)) continue;
      const auto coefficient = [&](double at) {
        return drag_coefficient(law, grains.diameter[p], eps[k], at, viscosity, model_b);
      };
      flow.drag[p] = drag_without_own_flow(coefficient, *flow.self_disturbance, grains.position[p], slip[k],
                                           sphere_volume(grains.diameter[p]) / grid.cell_volume(), lone[k], viscosity,
                                           model_b, flow.removed[p], flow.disturbance_clamps);
    }
  }
}

}   // namespace

void sample_flow(const StaggeredGrid& grid, const Grains& grains, const Stencils& stencils, const FaceFields& velocity,
                 const FaceFields& acceleration, const Field<Centre>& void_fraction, const DragLaw& law,
                 double viscosity, const Terms& terms, FlowAtGrains& flow, const KernelSmoothing& smoothing) {
  const std::size_t n = grains.size();
  flow.velocity.resize(n), flow.acceleration.resize(n), flow.void_fraction.resize(n);
  flow.drag.assign(n, {}), flow.force.assign(n, {});
  flow.void_clamps = flow.disturbance_clamps = flow.lift_clamps = 0;
  if (n == 0) return;
  const Field<Centre>& eps = smoothing.seen(void_fraction, flow.seen.void_fraction);
  if (!flow.woven.fits(grid)) flow.woven = Woven(grid), flow.woven_too = Woven(grid);
  flow.woven.read(stencils.reach, smoothing.seen(velocity, flow.seen.velocity), &eps);
  flow.woven_too.read(stencils.reach, smoothing.seen(acceleration, flow.seen.acceleration));
  const Strides stride(grid);
  for (std::size_t p = 0; p < n; ++p) {
    const Weights weights(stencils[p]);
    const Quad read = sample(weights, stride, flow.woven.at(stencils[p]));
    flow.velocity[p] = on_faces(read), flow.void_fraction[p] = in_cell(read);
    flow.acceleration[p] = on_faces(sample(weights, stride, flow.woven_too.at(stencils[p])));
  }
  if (terms.drag || terms.wall_forces || terms.added_mass)
    find_packing(grid, grains, eps, flow.void_fraction, flow.packing, smoothing);
  find_drag(grid, grains, law, viscosity, terms, flow);
}

void find_drag(const StaggeredGrid& grid, const Grains& grains, const DragLaw& law, double viscosity,
               const Terms& terms, FlowAtGrains& flow) {
  flow.packing.crowded = terms.crowded;
  if (!terms.drag) return;
  if (terms.self_disturbance) flow.removed.assign(grains.size(), {});
  if (terms.self_disturbance && !flow.self_disturbance) flow.self_disturbance.emplace(grid);
  std::visit([&](const auto& l) { evaluate_drag(l, grid, grains, viscosity, terms.model_b(), flow); }, law);
}

}   // namespace bedload
