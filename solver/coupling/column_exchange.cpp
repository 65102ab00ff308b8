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

void find_forces(const GrainSlices& slices, const GrainResponse& response, std::span<const double> u,
                 std::vector<double>& out) {
  out.resize(slices.first.size());
  for (std::size_t p = 0; p < out.size(); ++p) {
    const double held = response.drag[p].x / (1 + response.relaxation[p].x);
    out[p] = held * (sample(slices, p, u) - response.ballistic[p].x) + explicit_force(response, p);
  }
}

}   // namespace bedload
