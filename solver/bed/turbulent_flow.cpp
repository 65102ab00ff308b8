// The closure's shear, summed from the bed to the top.
#include "solver/bed/turbulent_flow.hpp"

#include <algorithm>
#include <cmath>

#include "solver/fluid/mixing_length.hpp"
#include "solver/fluid/wall_law.hpp"

namespace bedload {
namespace {

/// du/dz under the stress tau/rho_f: (nu + l^2 |du/dz|) du/dz = tau/rho_f.
double shear(double stress, double viscosity, double square_of_length) {
  return 2 * stress / (viscosity + std::sqrt(viscosity * viscosity + 4 * square_of_length * std::abs(stress)));
}

}   // namespace

TurbulentFlow turbulent_flow(const Scene& scene, double bed_height, double friction_speed) {
  const StaggeredGrid& grid = scene.grid;
  const int layers = grid.cells[2];
  const double h = grid.h.z, nu = scene.bed.fluid.viscosity, speed = std::abs(friction_speed);
  const double height = layers * h, gap = height - bed_height, sign = friction_speed < 0 ? -1 : 1;
  const bool lid = scene.drive.kind == FlowRamp::Kind::lid, free_slip = scene.bed.top == Top::free_slip;
  const double roughness = bed_height > 0 ? scene.bed.grains.diameter : scene.bottom_roughness;
  const auto stress = [&](double z) {
    const double share = (z - bed_height) / gap;
    return sign * speed * speed * (lid ? 1 : free_slip ? 1 - share : 1 - 2 * share);
  };
  std::vector<TurbulentSurface> surfaces{{bed_height, true, roughness, speed}};
  if (!free_slip) surfaces.push_back({height, false, 0, speed});
  SurfaceTerms terms;
  find_surface_terms(layers, h, nu, surfaces, terms);

  TurbulentFlow flow{std::vector<double>(static_cast<std::size_t>(layers)), 0};
  const int first =
      std::min(layers - 1, static_cast<int>(std::floor(bed_height / h + 0.5)));   // first centre above z_b
  double u = sign * wall_speed(speed, std::max(0.0, (first + 0.5) * h - bed_height), nu, roughness);
  for (int k = first; k < layers; ++k) {
    const auto n = static_cast<std::size_t>(k);
    if (k > first) u += h * shear(stress(k * h), nu, 1 / (filter_term(grid) + terms.faces[n]));
    flow.planes[n] = u;
  }
  if (lid) flow.lid_speed = u + sign * wall_speed(speed, 0.5 * h, nu, 0);
  return flow;
}

double friction_speed_under_lid(const Scene& scene, double bed_height, double lid_speed) {
  const double wanted = std::abs(lid_speed);
  double low = 0, high = wanted + std::sqrt(scene.bed.fluid.viscosity * wanted / (0.5 * scene.grid.h.z));
  for (int n = 0; n < 100 && high - low > 1e-14 * high; ++n) {
    const double middle = 0.5 * (low + high);
    (turbulent_flow(scene, bed_height, middle).lid_speed < wanted ? low : high) = middle;
  }
  return std::copysign(0.5 * (low + high), lid_speed);
}

}   // namespace bedload
