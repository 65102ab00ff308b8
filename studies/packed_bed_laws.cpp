#include "studies/packed_bed_laws.hpp"

#include <cmath>

namespace bedload {

double di_felice(double porosity, double reynolds) {
  const double coefficient = std::pow(0.63 + 4.8 / std::sqrt(reynolds), 2) * reynolds / 24;
  const double chi = 3.7 - 0.65 * std::exp(-std::pow(1.5 - std::log10(reynolds), 2) / 2);
  return coefficient * std::pow(porosity, -chi);
}

double gradient_per_flux(const std::string& law, double porosity, double reynolds) {
  const double phi = 1 - porosity, cube = porosity * porosity * porosity;
  if (law == "ergun") return 150 * phi * phi / cube + 1.75 * phi * reynolds / cube;
  return 18 * phi * di_felice(porosity, reynolds) / porosity;
}

double zero_of_rising(const std::function<double(double)>& rising, double low, double high) {
  for (int halving = 0; halving < 200; ++halving) {
    const double middle = (low + high) / 2;
    (rising(middle) < 0 ? low : high) = middle;
  }
  return high;
}

}   // namespace bedload
