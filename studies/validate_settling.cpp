// Settling: a sphere alone in still fluid, against its own drag law, against experiments, and on finer and finer meshes.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "solver/coupling/drag_laws.hpp"
#include "solver/coupling/self_disturbance.hpp"
#include "studies/svg_plot.hpp"
#include "studies/validation.hpp"

namespace bedload {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The sphere of a case, from the case alone.
struct Sphere {
  DragLawName law;
  double diameter, density_ratio, viscosity, gravity, added_mass;

  explicit Sphere(const FinishedCase& run)
      : law(run.one.scene.drag),
        diameter(run.input("grains.diameter")),
        density_ratio(run.input("grains.density") / run.input("fluid.density")),
        viscosity(run.input("fluid.viscosity")),
        gravity(run.input("box.gravity")),
        added_mass(run.one.scene.terms.added_mass ? 0.5 : 0) {}

  double terminal() const { return terminal_speed(law, viscosity, density_ratio, diameter, gravity); }

  /// dv/dt of a fall at v: (s + C_A) dv/dt = (s - 1) g - 18 nu F v/d^2.
  double acceleration(double v) const {
    const double f =
        std::visit([&](const auto& l) { return l.multiplier(1, v * diameter / viscosity); }, drag_law(law));
    return ((density_ratio - 1) * gravity - 18 * viscosity * f * v / (diameter * diameter)) /
           (density_ratio + added_mass);
  }
  /// Speed at time t from rest: the ordinary differential equation by Runge & Kutta's fourth order.
  double speed_at(double t) const {
    constexpr int steps = 20000;
    const double dt = t / steps;
    double v = 0;
    for (int n = 0; n < steps; ++n) {
      const double a = acceleration(v), b = acceleration(v + dt / 2 * a), c = acceleration(v + dt / 2 * b),
                   e = acceleration(v + dt * c);
      v += dt / 6 * (a + 2 * b + 2 * c + e);
    }
    return v;
  }
  std::string name() const { return fmt::format("{}{}", name_of(law), added_mass > 0 ? ", added mass" : ""); }
};

double fall_speed(const Trajectory& path, double t) {
  const std::size_t row = path.row_at(t * (1 - 1e-9));
  return row < path.size() ? -path.velocity[row].z : nan;
}

// ---- From rest

Findings from_rest(const std::vector<FinishedCase>& runs) {
  Findings found;
  for (const auto& run : runs) {
    const Sphere sphere(run);
    const Trajectory path = trajectory_of(run, 0);
    for (const double asked : {0.5e-3, 2e-3, 5e-3}) {
      const std::size_t row = path.row_at(asked * (1 - 1e-9));
      const double t = row < path.size() ? path.time[row] : nan;
      found.rows.push_back({.name = fmt::format("speed after {:.2g} ms, {} [mm/s]", 1e3 * t, sphere.name()),
                            .reference = 1e3 * sphere.speed_at(t),
                            .source = "dv/dt of the law, Runge-Kutta",
                            .ours = 1e3 * fall_speed(path, t),
                            .band = Band::within(0.005)});
    }
    found.rows.push_back({.name = fmt::format("terminal speed, {} [mm/s]", sphere.name()),
                          .reference = 1e3 * sphere.terminal(),
                          .source = "W' = 3 pi mu d F U",
                          .ours = -1e3 * path.velocity.back().z,
                          .band = Band::within(0.001)});
  }
  return found;
}

// ---- Mordant & Pinton's spheres

/// V (1 - exp(-3 t/tau)) was fitted to the measured falls.
struct Measured {
  int number;
  double speed, time;   // V [m/s], tau [s]
};

Findings mordant(const std::vector<FinishedCase>& runs, const Measured& measured) {
  Findings found;
  for (const auto& run : runs) {
    const Sphere sphere(run);
    const Trajectory path = trajectory_of(run, 0);
    const double band = sphere.law == DragLawName::di_felice ? 0.13 : 0.08;
    found.rows.push_back({.name = fmt::format("sphere {}, terminal speed, {} [m/s]", measured.number, sphere.name()),
                          .reference = measured.speed,
                          .source = "Mordant & Pinton 2000",
                          .ours = -path.velocity.back().z,
                          .band = Band::within(band),
                          .against = Against::experiment});
    const std::size_t row = path.row_at(measured.time / 3);
    const double t = row < path.size() ? path.time[row] : nan;
    found.rows.push_back(
        {.name = fmt::format("sphere {}, speed after {:.3g} ms, {} [m/s]", measured.number, 1e3 * t, sphere.name()),
         .reference = sphere.speed_at(t),
         .source = "dv/dt of the law, Runge-Kutta",
         .ours = fall_speed(path, t),
         .band = Band::within(0.005)});
  }
  return found;
}

// ---- Table 1 of "Numerical Simulation of Incipient Sediment Motion Driven by Fluid Flow"

/// Mean and ripple of the fall speed over the last four cells of fall, or the last half of a shorter one [m/s].
struct LastCells {
  double mean = nan, ripple = nan, growth = nan;   // growth: last cell (quarter) over the one before it, less one
};

LastCells last_cells(const Trajectory& path, double cell) {
  LastCells seen;
  const auto depth = [&](std::size_t n) { return path.position.front().z - path.position[n].z; };
  const auto row = [&](double z) {
    std::size_t n = 0;
    while (n + 1 < path.size() && depth(n) < z) ++n;
    return n;
  };
  const std::size_t end = path.size() - 1;
  const double fallen = depth(end), window = std::min(4 * cell, 0.5 * fallen), part = window / 4;
  const auto mean = [&](std::size_t a, std::size_t b) { return (depth(b) - depth(a)) / (path.time[b] - path.time[a]); };
  const std::size_t begin = row(fallen - window), last = row(fallen - part), before = row(fallen - 2 * part);
  if (last >= end || before >= last || begin >= before) return seen;
  seen.mean = mean(begin, end);
  seen.growth = mean(last, end) / mean(before, last) - 1;
  seen.ripple = 0;
  for (std::size_t n = last; n <= end; ++n)
    seen.ripple = std::max(seen.ripple, std::abs(-path.velocity[n].z / mean(last, end) - 1));
  return seen;
}

/// What a grain that is not freed of its own flow falls too fast, by the response of the grid alone: the fluid at the grain is
/// carried along with r W'/nu whatever the slip (in Model A the grain also samples V S of its drag as stress).
double known_error(const FinishedCase& run, const Sphere& sphere) {
  const StaggeredGrid& grid = run.one.scene.grid;
  const SelfDisturbance table(grid);
  const Vec3 place = trajectory_of(run, 0).position.back();
  const double volume = sphere_volume(sphere.diameter), weight = (sphere.density_ratio - 1) * sphere.gravity * volume;
  const double law = sphere.terminal();
  double carried = 0, stress = 0;
  constexpr int places = 16;
  for (int i = 0; i < places; ++i) {
    const Vec3 x{place.x, place.y, (std::floor(place.z / grid.h.z) + (i + 0.5) / places) * grid.h.z};
    double speed = law, k = 0;
    for (int pass = 0; pass < 5;
         ++pass) {   // the cell's Reynolds number is that of the fall less a third of its own flow
      const OwnFlow own = table.at(x, {0, 0, speed}, sphere.viscosity);
      k = own.drag.z * weight / (sphere.viscosity * law);
      k -= k * k * own.unevenness.z;
      speed = law * (1 + 2 * k / 3);
      if (pass == 4) stress += volume / grid.cell_volume() * own.stress.z / places;
    }
    carried += k / places;
  }
  return carried - stress;
}

/// One mesh of the table: what is seen of the fall, and what it should be.
struct Fall {
  const FinishedCase& run;
  Sphere sphere;
  LastCells seen;
  double cells, law, stokes;   // edge of a cell [d]; terminal speeds [m/s]
  std::string name;

  explicit Fall(const FinishedCase& finished)
      : run(finished),
        sphere(finished),
        seen(last_cells(trajectory_of(finished, 0), finished.one.scene.grid.h.z)),
        cells(finished.one.scene.grid.h.z / sphere.diameter),
        law(sphere.terminal()),
        stokes(terminal_speed(DragLawName::stokes, sphere.viscosity, sphere.density_ratio, sphere.diameter,
                              sphere.gravity)),
        name(fmt::format("h = {:.3g} d, {}", cells, corrected() ? "corrected" : "raw")) {}

  bool corrected() const { return run.one.scene.terms.self_disturbance; }
};

ValidationRow row_of_ripple(const std::string& name, double ripple, double most) {
  return {.name = name + ": ripple over a cell [-]",
          .reference = 0,
          .source = "a fall is smooth",
          .ours = ripple,
          .band = Band::within_absolute(most)};
}

/// Freed of its own flow: the law's speed, steady, smooth.
std::vector<ValidationRow> rows_corrected(const Fall& fall) {
  return {{.name = fall.name + ": speed of fall [mm/s]",
           .reference = 1e3 * fall.law,
           .source = "Di Felice's law; Re of the duct 45: walls not felt",
           .ours = 1e3 * fall.seen.mean,
           .band = Band::within(0.01)},
          row_of_ripple(fall.name, fall.seen.ripple, fall.cells < 2 ? 0.03 : 0.01),
          {.name = fall.name + ": growth over a cell [-]",
           .reference = 0,
           .source = "a fall at its terminal speed",
           .ours = fall.seen.growth,
           .band = Band::within_absolute(0.005)},
          {.name = fall.name + ": error against Stokes [-]",
           .reference = fall.law / fall.stokes - 1,
           .source = "Di Felice's law over Stokes'",
           .ours = fall.seen.mean / fall.stokes - 1,
           .band = Band::within_absolute(0.01)}};
}

/// As it samples the flow: too fast by what the grid is known to add.
std::vector<ValidationRow> rows_raw(const Fall& fall) {
  return {{.name = fall.name + ": error against the law [-]",
           .reference = known_error(fall.run, fall.sphere),
           .source = "response of the grid to its own force",
           .ours = fall.seen.mean / fall.law - 1,
           .band = Band::within_absolute(fall.cells < 2    ? 0.05
                                         : fall.cells < 10 ? 0.015
                                                           : 0.003)},
          ValidationRow::note(fall.name + ": error against Stokes [-]",
                              fmt::format("the law itself: {:.3g}", fall.law / fall.stokes - 1),
                              fall.seen.mean / fall.stokes - 1)};
}

Findings table_of_meshes(const std::vector<FinishedCase>& runs) {
  Findings found;
  for (const auto& run : runs) {
    const Fall fall(run);
    const auto rows = fall.corrected() ? rows_corrected(fall) : rows_raw(fall);
    found.rows.insert(found.rows.end(), rows.begin(), rows.end());
    const double seconds = run.core_seconds / static_cast<double>(run.fluid_steps) * 500;
    found.rows.push_back(
        ValidationRow::note(fall.name + ": 500 fluid steps [s]", "CPU time of one core, this machine", seconds));
    found.falls.push_back({.cell = fall.cells,
                           .corrected = fall.corrected(),
                           .against_law = fall.seen.mean / fall.law - 1,
                           .against_stokes = fall.seen.mean / fall.stokes - 1,
                           .ripple = fall.seen.ripple,
                           .seconds_of_500_steps = seconds});
  }
  return found;
}

// ---- Speeds, walls and places

/// Where a column of fall stands among the edges of the cells.
std::string column(const FinishedCase& run) {
  const Vec3 start = trajectory_of(run, 0).position.front(), h = run.one.scene.grid.h;
  const auto share = [](double cells) { return cells - std::floor(cells + 1e-9); };
  const double x = share(start.x / h.x), y = share(start.y / h.y);
  const auto is = [](double a, double b) { return std::abs(a - b) < 1e-6; };
  if (is(x, 0) && is(y, 0)) return "column of edges";
  if (is(x, 0.5) && is(y, 0.5)) return "column of centres";
  if ((is(x, 0) && is(y, 0.5)) || (is(x, 0.5) && is(y, 0))) return "column of faces";
  return fmt::format("column at ({:.2g}, {:.2g}) h", x, y);
}

std::string fall_name(const FinishedCase& run, const Sphere& sphere) {
  return fmt::format("h = {:.3g} d, Re_p {:.2g}, {}", run.one.scene.grid.h.z / sphere.diameter,
                     sphere.terminal() * sphere.diameter / sphere.viscosity, column(run));
}

void fall_rows(Findings& found, const FinishedCase& run, double factor, const char* source) {
  const Sphere sphere(run);
  const LastCells seen = last_cells(trajectory_of(run, 0), run.one.scene.grid.h.z);
  const auto name = fall_name(run, sphere);
  found.rows.push_back({.name = name + ": speed of fall [mm/s]",
                        .reference = 1e3 * sphere.terminal() * factor,
                        .source = source,
                        .ours = 1e3 * seen.mean,
                        .band = Band::within(0.01)});
  found.rows.push_back(row_of_ripple(name, seen.ripple, 0.01));
}

Findings free_of_walls(const std::vector<FinishedCase>& runs) {
  Findings found;
  for (const auto& run : runs) fall_rows(found, run, 1, "Di Felice's law; walls not felt");
  return found;
}

/// Along the axis of a square duct of half width l, creeping flow, to first order in a/l (Happel & Bart 1974, Appl. Sci. Res.
/// 29, 241): the duct's Reynolds number U l/nu must be small, and a/l.
Findings duct(const std::vector<FinishedCase>& runs) {
  Findings found;
  for (const auto& run : runs) {
    const double ratio = run.input("grains.diameter") / run.one.scene.bed.length.x;   // a/l
    fall_rows(found, run, 1 - 1.9033 * ratio, "Happel & Bart 1974: 1 - 1.9033 a/l, Re of the duct < 0.5");
  }
  return found;
}

/// Where the run ends, above the floor: 1 - (9/8) a/z to first order in a/z (Lorentz 1907), Re_p < 0.1.
Findings floor_ahead(const std::vector<FinishedCase>& runs) {
  Findings found;
  for (const auto& run : runs) {
    const Sphere sphere(run);
    const Trajectory path = trajectory_of(run, 0);
    const double a_over_z = sphere.diameter / 2 / path.position.back().z;
    found.rows.push_back({.name = fmt::format("Re_p {:.2g}, a/z {:.3f} above the floor: speed over the lone one's [-]",
                                              sphere.terminal() * sphere.diameter / sphere.viscosity, a_over_z),
                          .reference = 1 - 9.0 / 8 * a_over_z,
                          .source = "Lorentz 1907: 1 - (9/8) a/z",
                          .ours = -path.velocity.back().z / sphere.terminal(),
                          .band = Band::within(0.03)});
  }
  return found;
}

bool corrected_alone(const Case& one) { return one.scene.terms.self_disturbance; }

}   // namespace

std::vector<Rung> settling_rungs() {
  const auto sphere = [](const Measured& measured) {
    return [measured](const std::vector<FinishedCase>& runs) { return mordant(runs, measured); };
  };
  return {
      {"settling-from-rest", "a sphere is let go in still water, three laws, with and without added mass", from_rest,
       every_case},
      {"settling-mordant-1", "sphere 1 of Mordant & Pinton, glass, 0.5 mm", sphere({1, 0.0741, 0.055}), every_case},
      {"settling-mordant-2", "sphere 2 of Mordant & Pinton, glass, 1.5 mm", sphere({2, 0.218, 0.142}), every_case},
      {"settling-mordant-4", "sphere 4 of Mordant & Pinton, steel, 0.8 mm", sphere({4, 0.316, 0.108}), every_case},
      {"settling-table-25",
       "the settling sphere of \"Numerical Simulation of Incipient Sediment Motion Driven by Fluid Flow\", cells of 25 "
       "d",
       table_of_meshes, every_case},
      {"settling-table-5",
       "the settling sphere of \"Numerical Simulation of Incipient Sediment Motion Driven by Fluid Flow\", cells of 5 "
       "d",
       table_of_meshes, corrected_alone},
      {"settling-table-2_5",
       "the settling sphere of \"Numerical Simulation of Incipient Sediment Motion Driven by Fluid Flow\", cells of "
       "2.5 d",
       table_of_meshes,
       {}},
      {"settling-table-1_25",
       "the settling sphere of \"Numerical Simulation of Incipient Sediment Motion Driven by Fluid Flow\", cells of "
       "1.25 d",
       table_of_meshes,
       {}},
      {"settling-places", "a sphere falls down columns of edges, centres and faces of the cells", free_of_walls, {}},
      {"settling-re-5", "a sphere falls at Re_p 5", free_of_walls, {}},
      {"settling-duct", "a sphere creeps down the axis of a duct", duct, {}},
      {"settling-floor", "a sphere creeps towards the floor", floor_ahead, {}},
  };
}

}   // namespace bedload
