#include "studies/mesh_table.hpp"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

#include "studies/svg_plot.hpp"

namespace bedload {

namespace {

constexpr const char *raw_colour = "#b5482a", *corrected_colour = "#0b6e99";

}   // namespace

std::vector<MeshFall> mesh_falls(const std::vector<RungResult>& rungs) {
  std::vector<MeshFall> falls;
  for (const auto& rung : rungs) falls.insert(falls.end(), rung.findings.falls.begin(), rung.findings.falls.end());
  std::ranges::stable_sort(falls, {}, [](const MeshFall& fall) { return std::tuple(-fall.cell, fall.corrected); });
  return falls;
}

std::vector<std::string> mesh_columns() {
  return {"h [d]", "self-disturbance", "error against the law", "error against Stokes", "ripple", "500 steps [s]"};
}

std::vector<std::string> mesh_cells(const MeshFall& fall) {
  return {fmt::format("{:.3g}", fall.cell),
          fall.corrected ? "corrected" : "raw",
          fmt::format("{:+.2f} %", 100 * fall.against_law),
          fmt::format("{:+.2f} %", 100 * fall.against_stokes),
          fmt::format("{:.2f} %", 100 * fall.ripple),
          fmt::format("{:.2f}", fall.seconds_of_500_steps)};
}

std::optional<ValidationFigure> mesh_figure(const std::vector<MeshFall>& falls) {
  if (falls.empty()) return {};
  double least = -2, most = 2;   // [%]
  for (const auto& fall : falls)
    least = std::min(least, 120 * fall.against_law), most = std::max(most, 120 * fall.against_law);
  SvgPlot plot(640, 300, {"edge of a cell, h/d", 1, 40, true}, {"error of the speed of fall [%]", least, most}, 190);
  plot.shade({1, -1}, {40, 1}, "#7d8890", 0.2);
  plot.line({{1, 0}, {40, 0}}, {"#333", 1, ""});
  for (const bool corrected : {false, true}) {
    const char* colour = corrected ? corrected_colour : raw_colour;
    std::vector<PlotPoint> line;
    for (const auto& fall : falls)
      if (fall.corrected == corrected) line.push_back({fall.cell, 100 * fall.against_law});
    plot.line(line, {colour, 1.5, ""});
    for (const auto& point : line)
      plot.marker(point, Marker::circle, colour, corrected, fmt::format("h = {:.3g} d: {:+.2f} %", point.x, point.y));
    plot.legend_marker(corrected ? "corrected" : "raw", Marker::circle, colour, corrected);
  }
  plot.legend_shade("1 %", "#7d8890", 0.2);
  return ValidationFigure{.name = "settling-meshes",
                          .caption =
                              "Error of the speed of fall against the drag law in use, over the edge of a cell in "
                              "diameters of the sphere.",
                          .svg = plot.svg()};
}

}   // namespace bedload
