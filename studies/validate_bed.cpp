// Beds and suspensions: what the drag of many grains adds up to.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <fmt/format.h>

#include "solver/bed/bed_profiles.hpp"
#include "solver/coupling/face_void_fraction.hpp"
#include "studies/packed_bed_laws.hpp"
#include "studies/svg_plot.hpp"
#include "studies/validate_fluidisation.hpp"
#include "studies/validation.hpp"

namespace bedload {

namespace {

/// Volume flux of fluid along x per area [m/s].
double flux_along_x(const FinishedCase& run) {
  const StaggeredGrid& grid = run.one.scene.grid;
  const FaceFields eps = face_void_fraction(grid, run.state.grains, run.one.scene.smoothing);
  double sum = 0;
  for (int i = 0; i < grid.cells[0]; ++i)
    for (int j = 0; j < grid.cells[1]; ++j)
      for (int k = 0; k < grid.cells[2]; ++k) {
        const auto n = grid.index(i, j, k);
        sum += eps.x[n] * run.state.fluid.velocity.x[n];
      }
  return sum / double(grid.cell_count());
}

double solid_fraction_of_box(const FinishedCase& run) {
  const Vec3 box = run.one.scene.bed.length;
  double solid = 0;
  for (const double d : run.state.grains.diameter) solid += sphere_volume(d);
  return solid / (box.x * box.y * box.z);
}

// ---- Uniform fixed beds

constexpr double uniform = 0.01, random_positions = 0.02;   // bands: a crystal, and grains placed at random

/// Beyond a void fraction of about one half the grains have lost the order of a crystal.
Findings packed_bed(const std::vector<FinishedCase>& runs) {
  Findings found;
  for (const auto& run : runs) {
    const double d = run.input("grains.diameter"), nu = run.input("fluid.viscosity"), flux = flux_along_x(run);
    const double eps = 1 - solid_fraction_of_box(run), re = flux * d / nu;
    const auto& law = run.one.inputs.word("models.drag");
    const double gradient = run.input("drive.gradient.from") / run.input("fluid.density");
    found.rows.push_back({.name = fmt::format("eps {:.2f}, Re {:.2g}, {}, Model {}: gradient [mu U/d2]", eps, re, law,
                                              run.one.scene.terms.model_b() ? "B" : "A"),
                          .reference = gradient_per_flux(law, eps, re),
                          .source = law == "ergun" ? "Ergun 1952" : di_felice_source,
                          .ours = gradient * d * d / (nu * flux),
                          .band = Band::within(eps > 0.55 ? random_positions : uniform)});
  }
  return found;
}

bool quick_packed(const Case& one) {
  const double phi = double(one.scene.bed.source.count) * std::numbers::pi / 6 / 1000;
  return (phi < 0.45 || phi > 0.62) &&
         (one.inputs.number("drive.gradient.from") < 2 || one.inputs.number("drive.gradient.from") > 5e4);
}

// ---- Hindered settling

Findings frozen_suspension(const std::vector<FinishedCase>& runs) {
  Findings found;
  std::map<std::pair<double, double>, double> plain;   // mean drag by (count, flux), without self_disturbance
  const auto drag_of = [](const FinishedCase& run) {
    double sum = 0;
    for (const Vec3& f : run.drag) sum += f.z;
    return sum / double(run.drag.size());
  };
  for (const auto& run : runs) {
    const double d = run.input("grains.diameter"), nu = run.input("fluid.viscosity");
    const double flux = run.input("drive.through_flow.from"), eps = 1 - solid_fraction_of_box(run), re = flux * d / nu;
    const double stokes = 3 * std::numbers::pi * run.input("fluid.density") * nu * d * flux, drag = drag_of(run);
    const auto place = std::pair(double(run.drag.size()), flux);
    const auto name = fmt::format("frozen, phi {:.2f}, Re {:.3g}", 1 - eps, re);
    if (!run.one.scene.terms.self_disturbance) {
      plain[place] = drag;
      found.rows.push_back({.name = name + ": mean drag [3 pi mu d U]",
                            .reference = di_felice(eps, re),
                            .source = di_felice_source,
                            .ours = drag / stokes,
                            .band = Band::within(random_positions)});
    } else if (plain.contains(place)) {
      found.rows.push_back({.name = name + ": the same with self_disturbance [without it]",
                            .reference = 1,
                            .source = "a correction for lone grains leaves suspensions alone",
                            .ours = drag / plain[place],
                            .band = Band::within(0.001)});
    }
  }
  return found;
}

/// Speed of a lone grain by the law [m/s].
double lone_speed(const FinishedCase& run) {
  const double d = run.input("grains.diameter"), nu = run.input("fluid.viscosity");
  const double stokes =
      (run.input("grains.density") / run.input("fluid.density") - 1) * run.input("box.gravity") * d * d / (18 * nu);
  return zero_of_rising([&](double speed) { return di_felice(1, speed * d / nu) * speed - stokes; }, 0, 2 * stokes);
}

/// What the law gives for U/U_t: 3 pi mu d F(eps, Re) U = eps W', U the flux of fluid past the grains.
double hindered_speed(const FinishedCase& run, double eps) {
  const double d = run.input("grains.diameter"), nu = run.input("fluid.viscosity"), alone = lone_speed(run);
  const double weight = di_felice(1, alone * d / nu) * alone;
  return zero_of_rising([&](double speed) { return di_felice(eps, speed * d / nu) * speed - eps * weight; }, 0, alone) /
         alone;
}

Findings free_suspension(const std::vector<FinishedCase>& runs) {
  Findings found;
  std::map<double, std::vector<PlotPoint>> seen, law;   // by lone grain's Reynolds number
  for (const auto& run : runs) {
    double fall = 0;
    for (const Vec3& v : run.state.grains.velocity) fall -= v.z;
    fall /= double(run.state.grains.size());
    const double phi = solid_fraction_of_box(run), alone = lone_speed(run);
    const double re = alone * run.input("grains.diameter") / run.input("fluid.viscosity");
    const double expected = hindered_speed(run, 1 - phi);
    found.rows.push_back({.name = fmt::format("free, Re_t {:.3g}, phi {:.2f}: U/U_t [-]", re, phi),
                          .reference = expected,
                          .source = "Di Felice 1994, zero net flux",
                          .ours = fall / alone,
                          .band = Band::within(0.1)});
    const double key = std::round(1e3 * re) / 1e3;
    seen[key].push_back({phi, fall / alone}), law[key].push_back({phi, expected});
  }
  SvgPlot plot(640, 330, {"solid fraction", 0, 0.55}, {"settling speed / lone grain's", 0, 1}, 190);
  constexpr const char* colours[] = {"#1b6ca8", "#b5442b", "#3a7d44"};
  std::size_t n = 0;
  for (const auto& [re, points] : seen) {
    const auto* colour = colours[n++ % std::size(colours)];
    plot.line(law[re], {colour, 1.5, ""});
    for (const auto& p : points) plot.marker(p, Marker::circle, colour, true, fmt::format("{:.3g}", p.y));
    plot.legend_marker(fmt::format("Re_t = {:.3g}", re), Marker::circle, colour, true);
  }
  plot.legend_line("Di Felice 1994", {"#333", 1.5, ""});
  found.figures.push_back({"hindered-settling",
                           "Settling speed of a suspension against its solid fraction: runs (points) and what the drag "
                           "law of Di Felice (1994) gives at zero net volume flux (lines).",
                           plot.svg()});
  return found;
}

// ---- Flow over and in a frozen bed

/// Plane-mean solid fraction at height z, smoothed as the kernel smooths it: quadratic B-splines of width h_z, folded back
/// at the bottom.
double smoothed_solid(const FinishedCase& run, double z) {
  const double h = run.one.scene.grid.h.z;
  const Vec3 box = run.one.scene.bed.length;
  const auto spline = [&](double distance) {
    const double r = std::abs(distance) / h;
    return r < 0.5 ? 0.75 - r * r : r < 1.5 ? 0.5 * (1.5 - r) * (1.5 - r) : 0;
  };
  double solid = 0;
  const auto& grains = run.state.grains;
  for (std::size_t p = 0; p < grains.size(); ++p)
    solid += sphere_volume(grains.diameter[p]) * (spline(z - grains.position[p].z) + spline(z + grains.position[p].z));
  return solid / (box.x * box.y * h);
}

/// Brinkman (1949, Appl. Sci. Res. A 1, 27): eps nu u'' = 18 nu phi F(eps, Re) eps u/d^2 between a bottom at rest and a lid,
/// by second-order differences on `n` fine cells, the law's Reynolds number iterated.
std::vector<double> brinkman(const FinishedCase& run, int n) {
  const double d = run.input("grains.diameter"), nu = run.input("fluid.viscosity");
  const double height = run.one.scene.bed.length.z, h = height / n, lid = run.state.search.lid_speed;
  std::vector<double> phi(n), u(n, 0.0);
  for (int k = 0; k < n; ++k) phi[k] = smoothed_solid(run, (k + 0.5) * h);
  for (int pass = 0; pass < 30; ++pass) {
    std::vector<double> upper(n), right(n);
    for (int k = 0; k < n; ++k) {   // Thomas
      const double eps = 1 - phi[k], re = std::max(1e-9, eps * std::abs(u[k]) * d / nu);
      const double sink = 18 * phi[k] * di_felice(eps, re) * h * h / (d * d);
      const double below = k > 0 ? 1 : 0, above = k < n - 1 ? 1 : 0;
      const double diagonal = -(2 + sink + (k == 0) + (k == n - 1));   // walls half a cell away
      const double pivot = diagonal - (k > 0 ? below * upper[k - 1] : 0);
      upper[k] = above / pivot;
      right[k] = ((k == n - 1 ? -2 * lid : 0) - (k > 0 ? below * right[k - 1] : 0)) / pivot;
    }
    for (int k = n - 1; k >= 0; --k) u[k] = right[k] - (k < n - 1 ? upper[k] * u[k + 1] : 0);
  }
  return u;
}

/// The flow of one mesh beside Brinkman's, between heights that matter: from 1 d below the surface to 2 d above it.
struct OverABed {
  double cells;                   // height of a cell [d]
  std::vector<PlotPoint> ours;    // speed of the planes of cells [% of the lid's], height [d]
  std::vector<PlotPoint> exact;   // of Brinkman's problem
  double difference;              // mean of |ours - exact| over the mean of exact there [-]
};

OverABed over_a_bed(const FinishedCase& run) {
  constexpr int fine = 4000;
  const double d = run.input("grains.diameter"), height = run.one.scene.bed.length.z, h = run.one.scene.grid.h.z;
  const double per_lid = 100 / run.state.search.lid_speed, surface = 5.5 * d;
  const auto exact = brinkman(run, fine);
  const auto exact_at = [&](double z) {
    const double at = z / height * fine - 0.5;
    const auto k = static_cast<std::size_t>(std::clamp(at, 0.0, fine - 2.0));
    return exact[k] + (exact[k + 1] - exact[k]) * (at - double(k));
  };
  const auto ours = plane_means(run.state.fluid.velocity.x, run.one.scene.grid);
  OverABed flow{.cells = h / d, .ours = {}, .exact = {}, .difference = 0};
  double size = 0;
  for (std::size_t k = 0; k < ours.size(); ++k) {
    const double z = (double(k) + 0.5) * h;
    flow.ours.push_back({per_lid * ours[k], z / d});
    if (z < surface - d || z > surface + 2 * d) continue;
    flow.difference += std::abs(ours[k] - exact_at(z)), size += exact_at(z);
  }
  flow.difference /= size;
  for (int k = 0; k < fine; k += 8)
    if (exact[k] > 0) flow.exact.push_back({per_lid * exact[k], (k + 0.5) * height / fine / d});
  return flow;
}

/// The coarsest mesh says where the convergence begins, each finer one is nearer, the finest is there.
ValidationRow row_of(const OverABed& flow, const OverABed* coarser) {
  const auto name = fmt::format(
      "cells {:.2g} d high: flow from 1 d below to 2 d above the surface, difference in the mean of |u| [%]",
      flow.cells);
  if (!coarser)
    return ValidationRow::note(name, "Brinkman 1949, the same eps(z): where the convergence begins",
                               100 * flow.difference);
  const bool finest = flow.cells < 0.3;
  return {.name = name,
          .reference = finest ? 0 : 100 * coarser->difference,
          .source = finest ? "Brinkman 1949, the same eps(z)" : "less than on the cells before",
          .ours = 100 * flow.difference,
          .band = finest ? Band{0, 3, false} : Band::at_most()};
}

ValidationFigure figure_of(const std::vector<OverABed>& meshes) {
  SvgPlot plot(640, 360, {"flow speed / speed of the lid [%]", 0.01, 100, true}, {"height [d]", 3, 11}, 190);
  constexpr const char* colours[] = {"#1b6ca8", "#b5442b", "#3a7d44"};
  for (std::size_t n = 0; n < meshes.size(); ++n) {
    const auto* colour = colours[n % std::size(colours)];
    for (const PlotPoint& p : meshes[n].ours)
      if (p.x > 0) plot.marker(p, Marker::circle, colour, true, "");
    plot.line(meshes[n].exact, {colour, 1.2, ""});
    plot.legend_marker(fmt::format("cells {:.2g} d high", meshes[n].cells), Marker::circle, colour, true);
  }
  plot.legend_line("Brinkman 1949", {"#333", 1.2, ""});
  return {"brinkman",
          "Flow over and in a frozen bed, sheared by a lid: plane means (points) and the solution of Brinkman's "
          "one-dimensional problem with the same smoothed void fraction (lines).",
          plot.svg()};
}

/// Cases from the coarsest cells to the finest.
Findings brinkman_bed(const std::vector<FinishedCase>& runs) {
  Findings found;
  std::vector<OverABed> meshes;
  for (const auto& run : runs) {
    meshes.push_back(over_a_bed(run));
    found.rows.push_back(row_of(meshes.back(), meshes.size() > 1 ? &meshes[meshes.size() - 2] : nullptr));
  }
  found.figures.push_back(figure_of(meshes));
  return found;
}

// ---- At rest

Findings bed_at_rest(const std::vector<FinishedCase>& runs) {
  Findings found;
  for (const auto& run : runs) {
    double fastest = 0;
    for (int c = 0; c < 3; ++c) {
      const double* u = run.state.fluid.velocity.component(c);
      for (std::size_t n = 0; n < run.state.fluid.velocity.x.values.size(); ++n)
        fastest = std::max(fastest, std::abs(u[n]));
    }
    found.rows.push_back({.name = fmt::format("fastest flow after {} steps [lone grain's speed]", run.fluid_steps),
                          .reference = 0,
                          .source = "a bed at rest drives no flow",
                          .ours = fastest / lone_speed(run),
                          .band = Band::within_absolute(1e-4)});
  }
  return found;
}

bool quick_frozen(const Case& one) {
  return one.scene.bed.source.count < 1000 && one.inputs.number("drive.through_flow.from") < 1e-2;
}
bool quick_free(const Case& one) { return one.scene.bed.source.count < 500; }

}   // namespace

std::vector<Rung> bed_rungs() {
  return {
      {"bed-packed", "flow through uniform fixed beds", packed_bed, quick_packed},
      {"bed-hindered-frozen", "flow through grains held at random places", frozen_suspension, quick_frozen},
      {"bed-hindered-free", "settling of a suspension", free_suspension, quick_free},
      {"bed-fluidised", "a bed lifted by rising fluid", fluidised_bed, {}},
      {"bed-minimum-fluidisation",
       "fluid rises through a settled bed, up to more than lifts it",
       minimum_fluidisation,
       {}},
      {"bed-brinkman", "a lid shears fluid over a frozen bed", brinkman_bed, every_case},
      {"bed-at-rest", "a settled bed in still fluid", bed_at_rest, every_case},
  };
}

}   // namespace bedload
