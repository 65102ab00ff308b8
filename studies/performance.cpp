#include "studies/performance.hpp"

#include <fmt/format.h>

namespace bedload {

void Performance::add(const StepHealth& health, std::size_t grains, std::size_t cells) {
  grain_steps += static_cast<double>(grains) * health.substeps;
  cell_steps += static_cast<double>(cells);
  fluid_steps += 1;
  substeps += health.substeps;
  if (health.limited_by != StepLimit::asked) ++shortened[static_cast<std::size_t>(health.limited_by)];
  void_clamps += health.void_clamps > 0;
  unconverged += !health.converged;
  model_time += health.dt;
}

/// "8.7 DEM steps per fluid step; shortened by CFL in 12 %": what the interval became, and why.
std::string describe_steps(const Performance& p) {
  constexpr const char* names[] = {"asked", "CFL", "drag relaxation", "grain travel", "contact time", "grain time"};
  std::string line = fmt::format("{:.3g} DEM steps per fluid step", p.substeps / p.fluid_steps);
  for (std::size_t k = 1; k < p.shortened.size(); ++k)
    if (p.shortened[k] > 0)
      line += fmt::format("; shortened by {} in {:.3g} % of the steps", names[k], 100 * p.shortened[k] / p.fluid_steps);
  if (p.void_clamps > 0)
    line += fmt::format("; the void fraction was clamped at 0.26 in {:.3g} %", 100 * p.void_clamps / p.fluid_steps);
  if (p.unconverged > 0)
    line +=
        fmt::format("; a linear solve hit its limit of iterations in {:.3g} %", 100 * p.unconverged / p.fluid_steps);
  return line;
}

std::string describe(const Performance& p, const StepTimes& t) {
  if (!(t.total > 0)) return "no coupled step was done";
  const auto share = [&](double part) { return 100 * part / t.total; };
  const double rest = t.total - (t.sample + t.drag + t.contacts + t.deposit + t.transport + t.pressure);
  return fmt::format(
             "{:.0f} fluid steps in {:.1f} s: {:.3g} grain-steps/s, {:.3g} fluid cell-steps/s, {:.3g} model seconds "
             "per hour\n"
             "share of a step: contacts and motion {:.1f} %, pressure {:.1f} %, drag {:.1f} %, deposit {:.1f} %, "
             "sample "
             "{:.1f} %, "
             "transport {:.1f} %, rest {:.1f} %",
             p.fluid_steps, t.total, p.grain_steps / t.total, p.cell_steps / t.total, 3600 * p.model_time / t.total,
             share(t.contacts), share(t.pressure), share(t.drag), share(t.deposit), share(t.sample), share(t.transport),
             share(rest)) +
         "\n" + describe_steps(p);
}

}   // namespace bedload
