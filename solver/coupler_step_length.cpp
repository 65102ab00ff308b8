// How long a step may be.
#include "solver/coupler_rung.hpp"

#include <algorithm>
#include <limits>

namespace bedload {
namespace {

constexpr double largest_cfl = 0.5;
constexpr double largest_grain_travel = 0.2;   // of a cell edge
constexpr double harmless_relaxation = 0.2;    // below it even explicit drag is stable
constexpr double largest_relaxation = 200;     // a = beta T/M of any grain
constexpr int least_substeps = 4;              // where drag holds grains fast, a > 1

/// Duration of the shortest Hertz collision of two like grains of the bed at `speed`, or at the speed of an overlap of
/// 0.1 % if that is more: resting contacts are springs too.
double shortest_contact(const Grains& grains, const GrainProperties& g, double speed) {
  double shortest = std::numeric_limits<double>::infinity(), diameter = 0, density = 0, last = 0, power = 0;
  for (std::size_t p = 0; p < grains.size(); ++p) {
    if (grains.fixed[p]) continue;
    const double d = grains.diameter[p], rho = grains.density[p];
    if (rho != last) last = rho, power = std::pow(rho, 0.4);   // t_c ~ d rho^(2/5)
    const double scale = d * power;
    if (scale < shortest) shortest = scale, diameter = d, density = rho;
  }
  const double resting =
      std::sqrt(std::pow(1e-3, 2.5) * g.young_modulus / (0.98 * (1 - g.poisson * g.poisson) * density));
  return contact_time(diameter, density, g.young_modulus, g.poisson, std::max(speed, resting));
}

}   // namespace

double time_of_fall(const Scene& scene) {
  const GrainProperties& g = scene.bed.grains;
  const double s = g.density / scene.bed.fluid.density, gravity = norm(scene.bed.gravity),
               reduced = std::abs(s - 1) * gravity;
  if (!(reduced > 0)) return std::numeric_limits<double>::infinity();
  return std::max(std::sqrt(g.diameter / reduced),
                  g.diameter / terminal_speed(scene.drag, scene.bed.fluid.viscosity, s, g.diameter, gravity));
}

bool any_mobile(const Grains& grains) {
  return std::find(grains.fixed.begin(), grains.fixed.end(), 0) != grains.fixed.end();
}

void Coupler::Rung::shorten(double& step, double limit, StepLimit by) {
  if (!(limit < step)) return;
  step = limit;
  health.limited_by = by;
}

/// The longest step, in whole DEM steps, that every limit allows (docs/physics_coupling.md, "The fluid step").
double Coupler::Rung::choose_step(const State& state, double longest) {
  double step = longest;
  if (courant_rate > 0) shorten(step, largest_cfl / courant_rate, StepLimit::cfl);
  if (any_mobile(state.grains)) {
    const int least = limit_by_grains(state, step);
    health.substeps = std::max(least, static_cast<int>(step / scene.bed.dem_step * (1 + 1e-12)));
    step = std::min(step, health.substeps * scene.bed.dem_step);
  }
  health.cfl = step * courant_rate;
  health.divergence_left *= step;
  return health.dt = step;
}

/// Travel, relaxation by drag, half the duration of a collision, a tenth of the time in which a grain falls its diameter.
/// Returns the least number of sub-steps: in a single one a dashpot sees, of grains that drag holds fast, only the change of
/// contact forces since the last step, which drag has not met yet, and drives it up.
int Coupler::Rung::limit_by_grains(const State& state, double& step) {
  const Grains& grains = state.grains;
  const double shortest_edge = std::min({reach.x, reach.y, reach.z});
  double fastest = 0;
  for (std::size_t p = 0; p < grains.size(); ++p)
    if (!grains.fixed[p]) fastest = std::max(fastest, norm2(grains.velocity[p]));
  fastest = std::sqrt(fastest);
  if (fastest > 0) shorten(step, largest_grain_travel * shortest_edge / fastest, StepLimit::travel);
  double relaxation_time = std::numeric_limits<double>::infinity();   // the shortest M/beta
  for (std::size_t p = 0; p < grains.size(); ++p)
    if (const double beta = std::max({flow.drag[p].x, flow.drag[p].y, flow.drag[p].z}); !grains.fixed[p] && beta > 0)
      relaxation_time = std::min(relaxation_time, specific_mass(grains, p) / beta);
  shorten(step, largest_relaxation * relaxation_time, StepLimit::drag);
  // Drag that is constant over a step lags behind a collision; that matters only where drag is not weak.
  const double weak_drag = harmless_relaxation * relaxation_time;
  shorten(step, std::max(0.5 * shortest_contact(grains, scene.bed.grains, fastest), weak_drag), StepLimit::contact);
  shorten(step, 0.1 * fall_time, StepLimit::weight);
  return step > relaxation_time ? least_substeps : 1;
}

}   // namespace bedload
