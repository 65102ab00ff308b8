// The limits of health.
#include "solver/step_judgement.hpp"

#include <fmt/format.h>

namespace bedload {
namespace {

// Each lies well beyond what the limits of the fluid step aim at, and well before the scheme itself breaks down.
constexpr double largest_cfl_after = 2;   // aimed at: 0.5 with the velocities before the step
constexpr double largest_travel = 0.5;    // of a cell edge; aimed at: 0.2; the deposit cannot carry 1
constexpr double largest_overlap =
    0.3;   // of the smaller diameter; aimed at: 0.02. Hertz's contact, a small one, is lost
constexpr double largest_divergence = 0.5;   // share of a cell's volume that a step may lose or make

}   // namespace

std::string ailment(const StepHealth& health) {
  if (!health.finite) return "a velocity, spin, contact force or pressure is not finite";
  if (!health.settles) return "the bed does not come to rest";
  if (health.lost_grain)
    return fmt::format("a grain moved {:.2g} cells in one step, or its centre passed a wall", health.grain_travel);
  if (!health.converged)
    return fmt::format("a linear solve did not converge (drag {} iterations, pressure {}, residual {:.2g})",
                       health.drag_iterations, health.pressure_iterations, health.divergence);
  if (health.grain_travel > largest_travel)
    return fmt::format("a grain moved {:.2g} cells in one step (at most {})", health.grain_travel, largest_travel);
  if (health.deepest_overlap > largest_overlap)
    return fmt::format("grains overlap by {:.2g} of a diameter (at most {})", health.deepest_overlap, largest_overlap);
  if (health.cfl_after > largest_cfl_after)
    return fmt::format("the flow sped up to a Courant number of {:.2g} within the step (at most {})", health.cfl_after,
                       largest_cfl_after);
  if (health.divergence_left > largest_divergence)
    return fmt::format("the flow makes or loses {:.2g} of a cell's volume per step (at most {})",
                       health.divergence_left, largest_divergence);
  return {};
}

}   // namespace bedload
