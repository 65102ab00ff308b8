// Fluid: flows without grains, laminar and turbulent.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "studies/svg_plot.hpp"
#include "studies/validation.hpp"

namespace bedload {

namespace {

/// Cubic through the four samples nearest to x, where sample m stands at (m + 1/2) h.
template <class Sample>
double interpolated(double x, double h, Sample&& sample) {
  const int first = static_cast<int>(std::floor(x / h - 0.5)) - 1;
  double value = 0;
  for (int a = 0; a < 4; ++a) {
    double weight = 1;
    for (int b = 0; b < 4; ++b)
      if (b != a) weight *= (x / h - 0.5 - (first + b)) / (a - b);
    value += weight * sample(first + a);
  }
  return value;
}

/// Streamwise velocity at height z [m/s] of a flow that depends on z alone.
double speed_at(const FinishedCase& run, double z) {
  const StaggeredGrid& g = run.one.scene.grid;
  return interpolated(z, g.h.z, [&](int k) { return run.state.fluid.velocity.x[g.index(0, 0, k)]; });
}

/// Stress on the bottom by the books of the last half of the last hold [Pa].
double stress_on_bottom(const FinishedCase& run) {
  const BedScene& bed = run.one.scene.bed;
  return run.state.record.holds.shields_measured.back() * shields_stress(bed.fluid, bed.grains, norm(bed.gravity));
}

// ---- Couette and Poiseuille

/// u/U at z/H of a fluid at rest whose lid starts to move: t in units of H^2/nu.
double couette_start(double z, double t) {
  double u = z;
  for (int n = 1; n < 200; ++n) {
    const double k = n * std::numbers::pi;
    u += 2 / k * (n % 2 ? -1 : 1) * std::exp(-k * k * t) * std::sin(k * z);
  }
  return u;
}

Findings couette(const std::vector<FinishedCase>& runs) {
  Findings found;
  for (const auto& run : runs) {
    const BedScene& bed = run.one.scene.bed;
    const double height = bed.length.z, speed = run.one.scene.drive.levels.front();
    const double t = run.state.clock.time * bed.fluid.viscosity / (height * height);
    for (const double z : {0.25, 0.5, 0.75, 0.9})
      found.rows.push_back({.name = fmt::format("Couette start, u/U at z/H {:.2g}, nu t/H2 {:.2g}", z, t),
                            .reference = couette_start(z, t),
                            .source = "series solution of du/dt = nu d2u/dz2",
                            .ours = speed_at(run, z * height) / speed,
                            .band = Band::within(0.005)});
  }
  return found;
}

Findings poiseuille(const std::vector<FinishedCase>& runs) {
  Findings found;
  for (const auto& run : runs) {
    const BedScene& bed = run.one.scene.bed;
    const double height = bed.length.z, gradient = run.one.scene.drive.levels.front();
    found.rows.push_back({.name = "Poiseuille, fastest flow [mm/s]",
                          .reference = 1e3 * gradient * height * height / (8 * bed.fluid.density * bed.fluid.viscosity),
                          .source = "G H2/(8 mu)",
                          .ours = 1e3 * speed_at(run, 0.5 * height),
                          .band = Band::within(0.005)});
    found.rows.push_back({.name = "Poiseuille, stress on the bottom [mPa]",
                          .reference = 1e3 * gradient * height / 2,
                          .source = "balance: G H/2",
                          .ours = 1e3 * stress_on_bottom(run),
                          .band = Band::within(1e-6)});
  }
  return found;
}

// ---- Taylor-Green

struct Vortices {
  double error = 0;       // mean |u - exact|, of the exact amplitude
  double amplitude = 0;   // root mean square of u, of the exact one
};

Vortices vortices(const FinishedCase& run) {
  const StaggeredGrid& g = run.one.scene.grid;
  const Vec3 length = g.length();
  const double k = 2 * std::numbers::pi / length.x, nu = run.one.scene.bed.fluid.viscosity;
  const double decayed = run.one.scene.start_speed * std::exp(-2 * nu * k * k * run.state.clock.time);
  double error = 0, squares = 0, exact_squares = 0;
  for (int i = 0; i < g.cells[0]; ++i)
    for (int j = 0; j < g.cells[1]; ++j) {
      const double u = run.state.fluid.velocity.x[g.index(i, j, 0)];
      const double exact = decayed * std::sin(k * i * g.h.x) * std::cos(k * (j + 0.5) * g.h.y);
      error += std::abs(u - exact), squares += u * u, exact_squares += exact * exact;
    }
  return {error / (decayed * g.cells[0] * g.cells[1]), std::sqrt(squares / exact_squares)};
}

Findings taylor_green(const std::vector<FinishedCase>& runs) {
  Findings found;
  for (std::size_t n = 0; n < runs.size(); ++n) {
    const int cells = runs[n].one.scene.grid.cells[0];
    const Vortices here = vortices(runs[n]);
    if (n == 0) continue;   // too coarse for more than to be compared with
    found.rows.push_back({.name = fmt::format("Taylor-Green, amplitude left, {} cells [of the exact one]", cells),
                          .reference = 1,
                          .source = "exp(-2 nu k2 t), Taylor & Green 1937",
                          .ours = here.amplitude,
                          .band = Band::within(0.005)});
    found.rows.push_back({.name = fmt::format("Taylor-Green, order of the L1 error, {} to {} cells",
                                              runs[n - 1].one.scene.grid.cells[0], cells),
                          .reference = 2,
                          .source = "operators of second order",
                          .ours = std::log2(vortices(runs[n - 1]).error / here.error),
                          .band = Band::at_least(0.1)});
  }
  return found;
}

// ---- Lid-driven cavity

struct Station {
  const char* what;
  bool vertical;      // w at x on the middle of the height, else u at z on the middle of the length
  double at;          // of the edge
  double reference;   // of the lid's speed
  const char* source;
};

constexpr const char* ghia = "Ghia, Ghia & Shin 1982";

/// Velocity over that of the lid at a station.
double velocity_at(const FinishedCase& run, const Station& s) {
  const StaggeredGrid& g = run.one.scene.grid;
  const int middle = g.cells[0] / 2;   // face (for u) and plane (for w) in the middle of an even number of cells
  const FaceFields& u = run.state.fluid.velocity;
  const double length = g.length().x, lid = run.one.scene.drive.levels.front();
  if (s.vertical) return interpolated(s.at * length, g.h.x, [&](int i) { return u.z[g.index(i, 0, middle)]; }) / lid;
  return interpolated(s.at * length, g.h.z, [&](int k) { return u.x[g.index(middle, 0, k)]; }) / lid;
}

/// Change of the stress on the bottom in the last tenth of the run, of that stress.
double unsteadiness(const FinishedCase& run) {
  const auto& samples = run.state.record.samples;
  const double end = samples.time.back();
  std::size_t n = samples.time.size() - 1;
  while (n > 0 && samples.time[n] > 0.9 * end) --n;
  return samples.shields_measured.back() / samples.shields_measured[n] - 1;
}

ValidationFigure cavity_figure(const FinishedCase& run, double reynolds, const std::vector<Station>& stations) {
  SvgPlot plot(640, 420, {"velocity over that of the lid", -0.6, 1}, {"x/L, z/L", 0, 1}, 180);
  const Stroke along{.colour = "#1f5fa8"}, across{.colour = "#b5541c"};
  for (const bool vertical : {false, true}) {
    std::vector<PlotPoint> curve;
    for (double x = 0.02; x <= 0.98; x += 0.01) curve.push_back({velocity_at(run, {"", vertical, x, 0, ""}), x});
    plot.line(curve, vertical ? across : along);
  }
  for (const Station& s : stations)
    plot.marker({s.reference, s.at}, Marker::circle, s.vertical ? across.colour : along.colour, false, s.source);
  plot.legend_line("u over z at x = L/2", along);
  plot.legend_line("w over x at z = L/2", across);
  plot.legend_marker("references", Marker::circle, "#333", false);
  return {.name = fmt::format("fluid-cavity-{:.0f}", reynolds),
          .caption = fmt::format("Lid-driven cavity, Re {:.0f}, {} x {} cells: velocities on the centre lines, and the "
                                 "extremes of the references in the table.",
                                 reynolds, run.one.scene.grid.cells[0], run.one.scene.grid.cells[2]),
          .svg = plot.svg()};
}

/// Ghia's tables, except where they are known to be farther off than the band.
std::vector<Station> stations_at(double reynolds) {
  if (reynolds < 200)
    return {{"least u", false, .4531, -.21090, ghia},
            {"greatest w", true, .2344, .17527, ghia},
            {"least w", true, .8104, -.253803,
             "Marchi, Suero & Araki 2009 (Ghia's own value, -0.2453, deviates from it by 3.4 %)"}};
  if (reynolds < 600)
    return {{"least u", false, .2813, -.32726, ghia},
            {"greatest w", true, .2266, .30203, ghia},
            {"least w", true, .8594, -.44993, ghia}};
  return {{"least u", false, .1719, -.38289, "Ghia, Ghia & Shin 1982 (Botella & Peyret 1998 have -0.38857)"},
          {"greatest w", true, .1563, .37095, "Ghia, Ghia & Shin 1982 (Botella & Peyret 1998 have 0.37694)"},
          {"least w", true, .9063, -.51550, "Ghia, Ghia & Shin 1982 (Botella & Peyret 1998 have -0.52708)"}};
}

Findings cavity(const std::vector<FinishedCase>& runs) {
  Findings found;
  for (const auto& run : runs) {
    const Scene& scene = run.one.scene;
    const double reynolds = scene.drive.levels.front() * scene.bed.length.x / scene.bed.fluid.viscosity;
    const int cells = scene.grid.cells[0];
    const auto stations = stations_at(reynolds);
    for (const Station& s : stations)
      found.rows.push_back(
          {.name = fmt::format("cavity Re {:.0f}, {} cells, {} [of the lid's]", reynolds, cells, s.what),
           .reference = s.reference,
           .source = s.source,
           .ours = velocity_at(run, s),
           .band = Band::within(reynolds > 600 || cells < 64 ? 0.03 : 0.02)});
    found.rows.push_back(
        {.name = fmt::format("cavity Re {:.0f}, {} cells, change of the stress on its bottom in the last "
                             "tenth [of it]",
                             reynolds, cells),
         .reference = 0,
         .source = "steady",
         .ours = unsteadiness(run),
         .band = Band::within_absolute(0.01)});
    if (cells >= 64) found.figures.push_back(cavity_figure(run, reynolds, stations));
  }
  return found;
}

// ---- Log layer

Findings log_layer(const std::vector<FinishedCase>& runs) {
  Findings found;
  SvgPlot plot(640, 420, {"z u*/nu", 30, 3000, true}, {"u/u*", 0, 30}, 190);
  for (const auto& run : runs) {
    const Scene& scene = run.one.scene;
    const double nu = scene.bed.fluid.viscosity, depth = scene.bed.length.z;
    const double driven = scene.drive.levels.front() * depth, u_star = std::sqrt(driven / scene.bed.fluid.density);
    const double rough = scene.bottom_roughness;
    const auto law = [&](double z) {
      if (rough > 0) return std::log(30 * z / rough) / 0.41;
      return std::log(z * u_star / nu) / 0.41 + 5.2;
    };
    const char* name = rough > 0 ? "rough" : "smooth";
    for (const double z : {0.2, 0.4, 0.6, 0.8})
      found.rows.push_back({.name = fmt::format("log layer, {} bottom, u/u* at z/H {:.1f}", name, z),
                            .reference = law(z * depth),
                            .source = rough > 0 ? "ln(30 z/k_s)/0.41, Nikuradse 1933" : "ln(z u*/nu)/0.41 + 5.2",
                            .ours = speed_at(run, z * depth) / u_star,
                            .band = Band::within(0.10),
                            .against = Against::experiment});
    found.rows.push_back({.name = fmt::format("log layer, {} bottom, stress on it [Pa]", name),
                          .reference = driven,
                          .source = "balance: G H",
                          .ours = stress_on_bottom(run),
                          .band = Band::within(0.005)});
    const Stroke line{.colour = rough > 0 ? "#b5541c" : "#1f5fa8"};
    std::vector<PlotPoint> curve;
    for (double z = 0.01; z <= 1; z *= 1.05) curve.push_back({z * depth * u_star / nu, law(z * depth)});
    plot.line(curve, line);
    const StaggeredGrid& g = scene.grid;
    for (int k = 0; k < g.cells[2]; ++k)
      plot.marker({(k + 0.5) * g.h.z * u_star / nu, run.state.fluid.velocity.x[g.index(0, 0, k)] / u_star},
                  Marker::circle, line.colour, false, "");
    plot.legend_line(fmt::format("log law, {} bottom", name), line);
  }
  plot.legend_marker("planes of the grid", Marker::circle, "#333", false);
  found.figures.push_back({.name = "fluid-log-layer",
                           .caption = "Turbulent film under a gradient: mean flow against the log law.",
                           .svg = plot.svg()});
  return found;
}

}   // namespace

std::vector<Rung> fluid_rungs() {
  const auto coarse_vortices = [](const Case& one) { return one.scene.grid.cells[0] < 96; };
  return {
      {"fluid-couette", "a lid begins to move over a fluid at rest", couette, every_case},
      {"fluid-poiseuille", "a gradient drives the fluid between two walls", poiseuille, every_case},
      {"fluid-taylor-green", "vortices decay", taylor_green, coarse_vortices},
      {"fluid-cavity-coarse", "the lid of a closed cavity moves, Re 100, coarse cells", cavity, every_case},
      {"fluid-cavity-100", "the lid of a closed cavity moves, Re 100", cavity, {}},
      {"fluid-cavity-400", "the lid of a closed cavity moves, Re 400", cavity, {}},
      {"fluid-cavity-1000", "the lid of a closed cavity moves, Re 1000", cavity, {}},
      {"fluid-log-layer", "a turbulent film over a smooth and a rough bottom", log_layer, every_case},
  };
}

}   // namespace bedload
