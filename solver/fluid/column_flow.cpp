// Backward Euler on a staggered column: u in the middle of layers, stresses on their edges, one tridiagonal solve.
#include "solver/fluid/column_flow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/fluid/wall_law.hpp"

namespace bedload {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Integral of ds/l over a stretch at whose beginning l = length, and along which it rises by `slope` per way.
double integral_of_inverse(double length, double slope, double stretch) {
  if (length <= 0) return infinite;
  const double rise = slope * stretch / length;
  return stretch / length * (rise > 0 ? std::log1p(rise) / rise : 1);
}

/// nu_t that makes the no-slip gradient over `distance` bear the stress of the wall law; 0 where the sublayer is resolved.
double wall_eddies(double slip, double distance, double viscosity, double sand_roughness) {
  const double speed = std::abs(slip);
  if (speed == 0) return 0;
  return std::max(0.0, wall_stress(speed, distance, viscosity, sand_roughness) * distance / speed - viscosity);
}

}   // namespace

ColumnFlow::ColumnFlow(const Column& given) : column_(given) {
  const auto n = static_cast<std::size_t>(column_.layers);
  for (auto* of_layers : {&void_, &void_after_, &stress_divergence_, &lower_, &diagonal_, &upper_, &change_})
    of_layers->assign(n, 0);
  for (auto* of_edges : {&conductance_, &eddies_, &turning_, &square_of_length_, &viscous_, &stress_})
    of_edges->assign(n + 1, 0);
  std::fill(conductance_.begin(), conductance_.end(), column_.viscosity / column_.thickness);
  conductance_.front() *= 2;   // half a layer to the wall
  conductance_.back() *= column_.top == Top::lid ? 2 : 0;
  lid_ = {{column_.layers * column_.thickness, false, 0, 0}};
}

void ColumnFlow::measure(std::span<const double> u, const SolidLayers& solid, double lid_speed) {
  clamps_ = find_void(solid.fraction, void_);
  if (column_.packing > 0) find_eddies(u, solid.fraction, lid_speed);
  find_stress(u, solid, lid_speed);
  find_stress_divergence(solid);
}

void ColumnFlow::find_shear(std::span<const double> u, double lid_speed, std::vector<double>& out) const {
  const double h = column_.thickness;
  out.resize(u.size());
  for (std::size_t k = 0; k < u.size(); ++k) {
    const double below = k > 0 ? 0.5 * (u[k - 1] + u[k]) : 0;
    const double above = k + 1 < u.size() ? 0.5 * (u[k] + u[k + 1]) : column_.top == Top::lid ? lid_speed : u[k];
    out[k] = (above - below) / h;
  }
}

void ColumnFlow::step(std::span<double> u, const SolidLayers& solid, const LayerExchange& exchange,
                      const ColumnDrive& drive, double dt) {
  measure(u, solid, drive.lid_speed);
  if (!exchange.turn_rate.empty()) add_couples(u, exchange, drive.lid_speed);
  assemble(u, exchange, drive, dt);
  solve();
  // Stresses at the end of the step; those of eddies are linear about its start.
  for (std::size_t e = 0; e < eddies_.size(); ++e) {
    const double above = e < u.size() ? change_[e] : 0, below = e > 0 ? change_[e - 1] : 0;
    const double void_above = e < u.size() ? void_[e] : 0, void_below = e > 0 ? void_[e - 1] : 0;
    const double viscous = conductance_[e] * (void_above * above - void_below * below);
    viscous_[e] += viscous;
    stress_[e] += viscous + (2 * eddies_[e] + turning_[e]) * (above - below);
  }
  for (std::size_t k = 0; k < u.size(); ++k) u[k] += change_[k];
  find_stress_divergence(solid);
  book(u, solid, exchange, drive, dt);
}

/// eps of every layer; returns in how many it was clamped.
int ColumnFlow::find_void(std::span<const double> solid_fraction, std::vector<double>& out) {
  int clamps = 0;
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k] = std::max(1 - solid_fraction[k], least_void);
    if (1 - solid_fraction[k] < least_void) ++clamps;
  }
  return clamps;
}

/// l^2 at inner edges. Li & Sawamoto's l (1995) is linear in a layer of constant phi; the mean of
/// 1/l between two middles makes a log law exact, as (F15) does.
void ColumnFlow::find_lengths(std::span<const double> solid_fraction, double lid_slip) {
  const std::size_t n = solid_fraction.size();
  const double h = column_.thickness, packing = column_.packing;
  std::size_t first = n;   // layer above the highest that is packed: l = 0 below it
  while (first > 0 && solid_fraction[first - 1] < packing) --first;
  bare_ = first == 0;
  std::fill(square_of_length_.begin(), square_of_length_.end(), 0.0);
  if (column_.top == Top::lid) {
    lid_[0].friction_speed = std::sqrt(wall_stress(std::abs(lid_slip), 0.5 * h, column_.viscosity, 0));
    find_surface_terms(column_.layers, h, column_.viscosity, lid_, lid_terms_);
  }
  double length = bare_ ? von_karman * roughness_length(column_.sand_roughness) : 0;
  double from_below = infinite;   // of the half layer below the edge
  for (std::size_t k = first; k < n; ++k) {
    const double slope = von_karman * (1 - solid_fraction[k] / packing), middle = length + slope * 0.5 * h;
    const double inverse = (from_below + integral_of_inverse(length, slope, 0.5 * h)) / h;
    const double lid = column_.top == Top::lid ? lid_terms_.faces[k] : 0;
    square_of_length_[k] = 1 / (inverse * inverse + lid);
    from_below = integral_of_inverse(middle, slope, 0.5 * h);
    length = middle + slope * 0.5 * h;
  }
}

/// eps nu_t over the distance at every edge, of the flow as the step found it; on walls that of the wall law.
void ColumnFlow::find_eddies(std::span<const double> u, std::span<const double> solid_fraction, double lid_speed) {
  const double h = column_.thickness, nu = column_.viscosity;
  const bool lid = column_.top == Top::lid;
  find_lengths(solid_fraction, lid_speed - u.back());
  for (std::size_t e = 1; e < u.size(); ++e)
    eddies_[e] = 0.5 * (void_[e - 1] + void_[e]) * square_of_length_[e] * std::abs(u[e] - u[e - 1]) / (h * h);
  eddies_.front() = bare_ ? void_.front() * wall_eddies(u.front(), 0.5 * h, nu, column_.sand_roughness) / (0.5 * h) : 0;
  eddies_.back() = lid ? void_.back() * wall_eddies(lid_speed - u.back(), 0.5 * h, nu, 0) / (0.5 * h) : 0;
}

/// Stresses of the flow as the step found it.
void ColumnFlow::find_stress(std::span<const double> u, const SolidLayers& solid, double lid_speed) {
  const std::size_t n = u.size();
  for (std::size_t e = 0; e <= n; ++e) {
    const double above = e < n ? void_[e] * u[e] + solid.flux[e] : lid_speed;
    const double below = e > 0 ? void_[e - 1] * u[e - 1] + solid.flux[e - 1] : 0;
    const double slip = (e < n ? u[e] : lid_speed) - (e > 0 ? u[e - 1] : 0);
    viscous_[e] = conductance_[e] * (above - below);
    stress_[e] = viscous_[e] + eddies_[e] * slip;
  }
}

/// What solid feels of the viscous stress: where eps is clamped, the part that is left to it.
void ColumnFlow::find_stress_divergence(const SolidLayers& solid) {
  for (std::size_t k = 0; k < stress_divergence_.size(); ++k) {
    const double left = 1 - void_[k], share = solid.fraction[k] > left ? left / solid.fraction[k] : 1;
    stress_divergence_[k] = share * (viscous_[k + 1] - viscous_[k]) / column_.thickness;
  }
}

/// Couples act on the fluid as half of their own as stress, with the transpose of find_shear(): on an edge the mean of the layers
/// beside it, on a wall that of the outermost layer, on a free surface none. So no edge gives what another does not take.
void ColumnFlow::add_couples(std::span<const double> u, const LayerExchange& exchange, double lid_speed) {
  const std::size_t n = u.size();
  const double h = column_.thickness;
  for (std::size_t e = 0; e <= n; ++e) {
    const bool wall = e == 0 || e == n;
    if (e == n && column_.top != Top::lid) continue;
    const std::size_t low = e > 0 ? e - 1 : 0, high = std::min(e, n - 1);
    const double slip = (e < n ? u[e] : lid_speed) - (e > 0 ? u[e - 1] : 0), stretch = wall ? 0.5 * h : h;
    turning_[e] = 0.125 * (exchange.turn_rate[low] + exchange.turn_rate[high]) / stretch;
    stress_[e] += turning_[e] * slip - 0.25 * (exchange.turn_pull[low] + exchange.turn_pull[high]);
  }
}

/// The system for the change of u, each row that of a layer times h: on its right what the flow found would gain in dt. An
/// eddy stress l^2 |S| S has twice its own coefficient as slope: with one less, as if nu_t stood still, thin layers would ring.
void ColumnFlow::assemble(std::span<const double> u, const LayerExchange& exchange, const ColumnDrive& drive,
                          double dt) {
  const double h = column_.thickness;
  for (std::size_t k = 0; k < u.size(); ++k) {
    const double eps = void_[k], below = 2 * eddies_[k] + turning_[k], above = 2 * eddies_[k + 1] + turning_[k + 1];
    const double viscous = viscous_[k + 1] - viscous_[k], all = stress_[k + 1] - stress_[k];
    diagonal_[k] =
        eps * h / dt + eps * eps * (conductance_[k] + conductance_[k + 1]) + below + above + exchange.rate[k] * h;
    lower_[k] = k > 0 ? -eps * void_[k - 1] * conductance_[k] - below : 0;
    upper_[k] = k + 1 < u.size() ? -eps * void_[k + 1] * conductance_[k + 1] - above : 0;
    change_[k] =
        all - (1 - eps) * viscous + eps * h * drive.acceleration - h * (exchange.rate[k] * u[k] - exchange.pull[k]);
  }
}

/// Thomas's algorithm; right-hand side and solution are change_. No pivots: the matrix of a step is symmetric and positive
/// definite, that of carry() has columns that dominate.
void ColumnFlow::solve() {
  const std::size_t n = change_.size();
  for (std::size_t k = 1; k < n; ++k) {
    const double factor = lower_[k] / diagonal_[k - 1];
    diagonal_[k] -= factor * upper_[k - 1];
    change_[k] -= factor * change_[k - 1];
  }
  change_[n - 1] /= diagonal_[n - 1];
  for (std::size_t k = n - 1; k-- > 0;) change_[k] = (change_[k] - upper_[k] * change_[k + 1]) / diagonal_[k];
}

void ColumnFlow::book(std::span<const double> u, const SolidLayers& solid, const LayerExchange& exchange,
                      const ColumnDrive& drive, double dt) {
  const double h = column_.thickness;
  books_ = {.on_bottom = stress_.front(), .on_lid = -stress_.back()};
  for (std::size_t k = 0; k < u.size(); ++k) {
    books_.gained += h * void_[k] * change_[k] / dt;
    books_.driving += h * void_[k] * drive.acceleration;
    books_.on_grains += h * (exchange.rate[k] * u[k] - exchange.pull[k] + solid.fraction[k] * stress_divergence_[k]);
  }
}

/// Implicit upwind, with the fluid volume that passes up through an edge per layer: what the layers below it have lost.
void ColumnFlow::carry(std::span<double> u, std::span<const double> before, std::span<const double> after) {
  find_void(before, void_), find_void(after, void_after_);
  double from_below = 0;
  for (std::size_t k = 0; k < u.size(); ++k) {
    const double up = k + 1 < u.size() ? from_below + void_[k] - void_after_[k] : 0;
    diagonal_[k] = void_after_[k] + std::max(up, 0.0) - std::min(from_below, 0.0);
    lower_[k] = -std::max(from_below, 0.0);
    upper_[k] = std::min(up, 0.0);
    change_[k] = void_[k] * u[k];
    from_below = up;
  }
  solve();
  std::copy(change_.begin(), change_.end(), u.begin());
}

}   // namespace bedload
