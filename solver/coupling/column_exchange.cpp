// Slices of spheres as weights between grains and layers; sums in the order of grain ids.
#include "solver/coupling/column_exchange.hpp"

#include <algorithm>

#include "solver/grains/slice_volume.hpp"

namespace bedload {
namespace {

/// Calls visit(layer, part) for the layers that a grain reaches, from below.
template <class Visit>
void for_each_slice(const GrainSlices& slices, std::size_t grain, Visit&& visit) {
  for (std::size_t n = slices.begin[grain], k = slices.first[grain]; n < slices.begin[grain + 1]; ++n, ++k)
    visit(k, slices.part[n]);
}

double layer_volume(const Column& column, double area) { return area * column.thickness; }

double explicit_force(const GrainResponse& response, std::size_t grain) {
  return response.force.empty() ? 0 : response.force[grain].x;
}

}   // namespace

void find_slices(const Column& column, const Grains& grains, GrainSlices& slices) {
  const double h = column.thickness, last = column.layers - 1;
  const auto layer = [&](double z) { return static_cast<std::size_t>(std::clamp(z / h, 0.0, last)); };
  slices.first.resize(grains.size()), slices.begin.resize(grains.size() + 1), slices.part.clear();
  for (std::size_t p = 0; p < grains.size(); ++p) {
    const double radius = 0.5 * grains.diameter[p], z = grains.position[p].z;
    const double per_volume = 1 / slice_volume(radius, -radius, radius);
    const std::size_t low = layer(z - radius), high = layer(z + radius);
    slices.first[p] = low, slices.begin[p] = slices.part.size();
    double below = -radius;
    for (std::size_t k = low; k <= high; ++k) {
      const double above = k == high ? radius : static_cast<double>(k + 1) * h - z;
      slices.part.push_back(per_volume * slice_volume(radius, below, above));
      below = above;
    }
  }
  slices.begin[grains.size()] = slices.part.size();
}

void average_grains(const Column& column, const Grains& grains, const GrainSlices& slices, double area,
                    SolidLayers& out) {
  const auto layers = static_cast<std::size_t>(column.layers);
  out.fraction.assign(layers, 0), out.flux.assign(layers, 0);
  for (std::size_t p = 0; p < grains.size(); ++p) {
    const double solid = sphere_volume(grains.diameter[p]) / layer_volume(column, area);
    const double moving = grains.fixed[p] ? 0 : solid * grains.velocity[p].x;
    for_each_slice(slices, p, [&](std::size_t k, double part) {
      out.fraction[k] += part * solid;
      out.flux[k] += part * moving;
    });
  }
}

double sample(const GrainSlices& slices, std::size_t grain, std::span<const double> profile) {
  double mean = 0;
  for_each_slice(slices, grain, [&](std::size_t k, double part) { mean += part * profile[k]; });
  return mean;
}

void find_exchange(const Column& column, const GrainSlices& slices, const GrainResponse& response, double area,
                   LayerExchange& out) {
  const auto layers = static_cast<std::size_t>(column.layers);
  const double per_volume = 1 / layer_volume(column, area);
  out.rate.assign(layers, 0), out.pull.assign(layers, 0);
  for (std::size_t p = 0; p < slices.first.size(); ++p) {
    const double rate = per_volume * response.drag[p].x / (1 + response.relaxation[p].x);
    const double pull = rate * response.ballistic[p].x - per_volume * explicit_force(response, p);
    for_each_slice(slices, p, [&](std::size_t k, double part) {
      out.rate[k] += part * rate;
      out.pull[k] += part * pull;
    });
  }
}

/// m_a [(u_p - v) + (u_k - u_p)/(1 + a)]/T on slice k: with the second part whole, each step would raise what varies over a
/// grain's height by (eps + A)/(eps + A/(1 + a)).
void add_added_mass(const Column& column, const Grains& grains, const GrainSlices& slices, const AddedMass& added,
                    std::span<const double> u, double area, double dt, LayerExchange& out, std::vector<double>& along) {
  const double per_volume = 1 / layer_volume(column, area);
  along.assign(static_cast<std::size_t>(column.layers), 0);
  for (std::size_t p = 0; p < grains.size(); ++p) {
    const double share = per_volume * added.volume[p], at_grain = added.flow[p].x;
    const double slip = at_grain - (grains.fixed[p] ? 0 : grains.velocity[p].x);
    const double answer = 1 / (1 + added.relaxation[p].x);
    for_each_slice(slices, p, [&](std::size_t k, double part) {
      along[k] += part * share;
      out.pull[k] += part * share / dt * (slip + answer * (u[k] - at_grain));
    });
  }
}

void find_couples(const Column& column, const GrainSlices& slices, std::span<const Vec3> strength,
                  std::span<const Vec3> target, double area, double dt, LayerExchange& out) {
  const auto layers = static_cast<std::size_t>(column.layers);
  const double per_time = 1 / (layer_volume(column, area) * dt);
  out.turn_rate.assign(layers, 0), out.turn_pull.assign(layers, 0);
  for (std::size_t p = 0; p < slices.first.size(); ++p) {
    const double rate = per_time * strength[p].y, pull = rate * target[p].y;
    for_each_slice(slices, p, [&](std::size_t k, double part) {
      out.turn_rate[k] += part * rate;
      out.turn_pull[k] += part * pull;
    });
  }
}

void find_forces(const GrainSlices& slices, const GrainResponse& response, std::span<const double> u,
                 std::vector<double>& out) {
  out.resize(slices.first.size());
  for (std::size_t p = 0; p < out.size(); ++p) {
    const double held = response.drag[p].x / (1 + response.relaxation[p].x);
    out[p] = held * (sample(slices, p, u) - response.ballistic[p].x) + explicit_force(response, p);
  }
}

}   // namespace bedload
