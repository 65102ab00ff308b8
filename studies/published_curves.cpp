// The formulas, each with its source.
#include "studies/published_curves.hpp"

#include <array>
#include <cmath>

namespace bedload {

namespace {

double grain_size(double galileo) { return std::cbrt(galileo * galileo); }   // D*

double brownlie(double galileo) {
  const double r = std::pow(galileo, -0.6);
  return 0.22 * r + 0.06 * std::pow(10, -7.7 * r);
}

double parker(double galileo) { return brownlie(galileo) / 2; }

double soulsby(double galileo) {
  const double d = grain_size(galileo);
  return 0.30 / (1 + 1.2 * d) + 0.055 * (1 - std::exp(-0.020 * d));
}

double van_rijn(double galileo) {
  const double d = grain_size(galileo);
  if (d <= 4) return 0.24 / d;
  if (d <= 10) return 0.14 * std::pow(d, -0.64);
  if (d <= 20) return 0.04 * std::pow(d, -0.10);
  if (d <= 150) return 0.013 * std::pow(d, 0.29);
  return 0.055;
}

double cao(double galileo) {
  if (galileo <= 6.61) return 0.1414 * std::pow(galileo, -0.2306);
  if (galileo >= 282.84) return 0.045;
  return std::pow(1 + std::pow(0.0223 * galileo, 2.8358), 0.3542) / (3.0946 * std::pow(galileo, 0.6769));
}

double guo(double galileo) {
  const double d = grain_size(galileo);
  return 0.23 / d + 0.054 * (1 - std::exp(-std::pow(d, 0.85) / 23));
}

constexpr std::array<PublishedCurve, 6> curves{{
    {"Soulsby 1997", "Soulsby 1997, Dynamics of Marine Sands, eq. 77", soulsby},
    {"Brownlie 1981", "Brownlie 1981, Caltech report KH-R-43A", brownlie},
    {"Parker 2003", "Parker et al. 2003, after Neill: half of Brownlie 1981", parker},
    {"Cao 2006", "Cao, Pender & Meng 2006, J. Hydraul. Eng. 132, 1097", cao},
    {"Guo 2002", "Guo 2002, Hunter Rouse and Shields diagram", guo},
    {"van Rijn 1984", "van Rijn 1984, J. Hydraul. Eng. 110, 1431", van_rijn},
}};

}   // namespace

std::span<const PublishedCurve> published_curves() { return curves; }
std::span<const PublishedCurve> curves_for_tables() { return std::span(curves).first(3); }

}   // namespace bedload
