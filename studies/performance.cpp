#include "studies/performance.hpp"

#include <fmt/format.h>

namespace bedload {

void Performance::add(const StepHealth& health, std::size_t grains, std::size_t cells) {
  grain_steps += static_cast<double>(grains) * health.substeps;
  cell_steps += static_cast<double>(cells);
  fluid_steps += 1;
  model_time += health.dt;
}

std::string describe(const Performance& p, const StepTimes& t) {
  if (!(t.total > 0)) return "no coupled step was done";
  const auto share = [&](double part) { return 100 * part / t.total; };
  const double rest = t.total - (t.sample + t.drag + t.contacts + t.deposit + t.transport + t.pressure);
  return fmt::format(
      "{:.0f} fluid steps in {:.1f} s: {:.3g} grain-steps/s, {:.3g} fluid cell-steps/s, {:.3g} model seconds per hour\n"
      "share of a step: contacts and motion {:.1f} %, pressure {:.1f} %, drag {:.1f} %, deposit {:.1f} %, sample "
      "{:.1f} %, "
      "transport {:.1f} %, rest {:.1f} %",
      p.fluid_steps, t.total, p.grain_steps / t.total, p.cell_steps / t.total, 3600 * p.model_time / t.total,
      share(t.contacts), share(t.pressure), share(t.drag), share(t.deposit), share(t.sample), share(t.transport),
      share(rest));
}

}   // namespace bedload
