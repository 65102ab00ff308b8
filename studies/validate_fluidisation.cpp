// Plane means of pressure and void fraction, from two diameters above the fixed layer to the clear fluid over the bed.
#include "studies/validate_fluidisation.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "solver/coupling/face_void_fraction.hpp"
#include "studies/packed_bed_laws.hpp"
#include "studies/svg_plot.hpp"

namespace bedload {

namespace {

struct RisingFlow {
  double flux = 0;                // [m/s]
  double drop = 0;                // of pressure, measured [Pa]
  double weight = 0;              // of the grains between, submerged, per area [Pa]
  std::vector<double> porosity;   // of the planes of faces between
  double grain_speed = 0;         // root of the mean square over the free grains [m/s]
};

template <class Value>
double plane_mean(const StaggeredGrid& grid, int k, Value&& value) {
  const auto [nx, ny, nz] = grid.cells;
  double sum = 0;
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j) sum += value(grid.index(i, j, k));
  return sum / (double(nx) * ny);
}

double grain_speed(const Grains& grains) {
  double squares = 0, free = 0;
  for (std::size_t p = 0; p < grains.size(); ++p)
    if (!grains.fixed[p]) squares += norm2(grains.velocity[p]), free += 1;
  return std::sqrt(squares / free);
}

RisingFlow rising_flow(const FinishedCase& run) {
  const StaggeredGrid& grid = run.one.scene.grid;
  const FaceFields eps = face_void_fraction(grid, run.state.grains, run.one.scene.smoothing);
  const double h = grid.h.z, rho = run.input("fluid.density"),
               excess = (run.input("grains.density") - rho) * run.input("box.gravity");
  const int lowest = static_cast<int>(std::ceil(2 * run.input("grains.diameter") / h)), highest = grid.cells[2] - 2;
  const auto pressure = [&](std::size_t n) { return run.state.fluid.pressure[n]; };
  RisingFlow flow{.flux = run.state.search.through_flow, .grain_speed = grain_speed(run.state.grains)};
  flow.drop = rho * (plane_mean(grid, lowest, pressure) - plane_mean(grid, highest, pressure) +
                     run.state.fluid.column_gradient * h * (highest - lowest));
  for (int k = lowest + 1; k <= highest; ++k) {
    flow.porosity.push_back(plane_mean(grid, k, [&](std::size_t n) { return eps.z[n]; }));
    flow.weight += (1 - flow.porosity.back()) * excess * h;
  }
  return flow;
}

/// Drop of pressure that the drag law gives at the bed's own porosity [Pa].
double drop_by_law(const FinishedCase& run, const RisingFlow& bed, double flux) {
  const double d = run.input("grains.diameter"), nu = run.input("fluid.viscosity"), rho = run.input("fluid.density");
  double gradients = 0;
  for (const double porosity : bed.porosity) gradients += gradient_per_flux("di_felice", porosity, flux * d / nu);
  return rho * nu * flux / (d * d) * gradients * run.one.scene.grid.h.z;
}

/// Flux at which that drop is the weight [m/s].
double least_flux_by_law(const FinishedCase& run, const RisingFlow& bed) {
  return zero_of_rising([&](double flux) { return drop_by_law(run, bed, flux) - bed.weight; }, 1e-9, 1);
}

/// Wen & Yu (1966): Re = sqrt(33.7^2 + 0.0408 Ar) - 33.7, whatever the porosity [m/s].
double least_flux_by_wen_yu(const FinishedCase& run) {
  const double d = run.input("grains.diameter"), nu = run.input("fluid.viscosity");
  const double s = run.input("grains.density") / run.input("fluid.density");
  const double archimedes = (s - 1) * run.input("box.gravity") * d * d * d / (nu * nu);
  return (std::sqrt(33.7 * 33.7 + 0.0408 * archimedes) - 33.7) * nu / d;
}

/// As it is had from an experiment: where the line through the drops of the bed at rest, in proportion to the flux, meets the
/// mean drop of the bed that is lifted; drops per weight [m/s].
double least_flux_measured(const std::vector<RisingFlow>& resting, const std::vector<RisingFlow>& lifted) {
  double products = 0, squares = 0, level = 0;
  for (const RisingFlow& bed : resting) products += bed.flux * bed.drop / bed.weight, squares += bed.flux * bed.flux;
  for (const RisingFlow& bed : lifted) level += bed.drop / bed.weight / double(lifted.size());
  return level * squares / products;
}

ValidationRow row_of_weight(const RisingFlow& bed) {
  return {.name = fmt::format("fluidised at {:.2g} mm/s: drop of pressure [Pa]", 1e3 * bed.flux),
          .reference = bed.weight,
          .source = "submerged weight per area of the grains in the bed",
          .ours = bed.drop,
          .band = Band::within(0.01)};
}

/// Below minimum fluidisation the drop is less than the weight, and the rest stands on the grains: nothing moves.
void add_rows_at_rest(Findings& found, const FinishedCase& run, const RisingFlow& bed) {
  const auto name = fmt::format("settled, at {:.2g} mm/s: ", 1e3 * bed.flux);
  found.rows.push_back({.name = name + "drop of pressure [Pa]",
                        .reference = drop_by_law(run, bed, bed.flux),
                        .source = "Di Felice 1994, at the bed's plane-mean porosity",
                        .ours = bed.drop,
                        .band = Band::within(0.05)});
  found.rows.push_back({.name = name + "root mean square speed of the grains [of the flux]",
                        .reference = 0,
                        .source = "a bed below minimum fluidisation rests",
                        .ours = bed.grain_speed / bed.flux,
                        .band = Band::within_absolute(1e-3)});
}

void add_rows_of_least_flux(Findings& found, double ours, double by_law, double by_wen_yu, double porosity) {
  found.rows.push_back({.name = "minimum fluidisation [mm/s]",
                        .reference = 1e3 * by_law,
                        .source = "Di Felice 1994, at the porosity of the settled bed",
                        .ours = 1e3 * ours,
                        .band = Band::within(0.05)});
  found.rows.push_back({.name = "minimum fluidisation [mm/s]",
                        .reference = 1e3 * by_wen_yu,
                        .source = "Wen & Yu 1966, standard deviation of 284 measurements 34 %",
                        .ours = 1e3 * ours,
                        .band = Band::within(0.34),
                        .against = Against::experiment});
  found.rows.push_back(ValidationRow::note("porosity of the settled bed [-]", "middle half of the solid", porosity));
}

ValidationFigure figure_of(const std::vector<RisingFlow>& beds, const RisingFlow& slowest, const FinishedCase& run,
                           double by_wen_yu) {
  SvgPlot plot(640, 330, {"flux [mm/s]", 0, 4.5}, {"drop of pressure / weight of the bed", 0, 1.4}, 190);
  plot.shade({1e3 * by_wen_yu * 0.66, 0}, {1e3 * by_wen_yu * 1.34, 1.4}, "#7d8890", 0.15);
  std::vector<PlotPoint> law;
  for (double flux = 1e-4; flux < 4.5e-3; flux += 1e-4)
    law.push_back({1e3 * flux, drop_by_law(run, slowest, flux) / slowest.weight});
  plot.line(law, {"#333", 1.5, ""});
  plot.line({{0, 1}, {4.5, 1}}, {"#333", 1.5, "4 3"});
  for (const RisingFlow& bed : beds)
    plot.marker({1e3 * bed.flux, bed.drop / bed.weight}, Marker::circle, "#1b6ca8", true,
                fmt::format("{:.3g}", bed.drop / bed.weight));
  plot.legend_marker("runs", Marker::circle, "#1b6ca8", true);
  plot.legend_line("Di Felice 1994", {"#333", 1.5, ""});
  plot.legend_line("weight", {"#333", 1.5, "4 3"});
  plot.legend_shade("Wen & Yu 1966", "#7d8890", 0.15);
  return {"minimum-fluidisation",
          "Drop of pressure of water that rises through a settled bed: runs (points), what the drag law of Di Felice "
          "(1994) gives at the porosity of the settled bed (line), the bed's submerged weight (dashed), and minimum "
          "fluidisation by Wen & Yu (1966) with their standard deviation (band).",
          plot.svg()};
}

}   // namespace

Findings fluidised_bed(const std::vector<FinishedCase>& runs) {
  Findings found;
  for (const auto& run : runs) found.rows.push_back(row_of_weight(rising_flow(run)));
  return found;
}

/// Cases by rising flux; the law says which of them have to rest.
Findings minimum_fluidisation(const std::vector<FinishedCase>& runs) {
  Findings found;
  std::vector<RisingFlow> beds, resting, lifted;
  for (const auto& run : runs) beds.push_back(rising_flow(run));
  const double by_law = least_flux_by_law(runs.front(), beds.front()), by_wen_yu = least_flux_by_wen_yu(runs.front());
  for (std::size_t n = 0; n < runs.size(); ++n) {
    const bool rests = beds[n].flux < by_law;
    (rests ? resting : lifted).push_back(beds[n]);
    if (rests) add_rows_at_rest(found, runs[n], beds[n]);
    else found.rows.push_back(row_of_weight(beds[n]));
  }
  add_rows_of_least_flux(found, least_flux_measured(resting, lifted), by_law, by_wen_yu,
                         runs.front().state.record.holds.porosity.front());
  found.figures.push_back(figure_of(beds, beds.front(), runs.front(), by_wen_yu));
  return found;
}

}   // namespace bedload
