// Published threshold curves of turbulent flow, as functions of the Galileo number, and the band of laminar beds.
#pragma once

#include <span>
#include <string_view>

namespace bedload {

/// theta_c over Ga = sqrt((s-1) g d^3)/nu; D* = Ga^(2/3).
struct PublishedCurve {
  std::string_view name;
  std::string_view source;
  double (*shields)(double galileo);
};

/// Soulsby, Brownlie, Parker, Cao, Guo, van Rijn. They are fits to turbulent flow in water and disagree by 2x; a laminar,
/// drag-only model is not expected to fall on them above Re* of about 5.
std::span<const PublishedCurve> published_curves();

/// The few that stand beside a table of results.
std::span<const PublishedCurve> curves_for_tables();

/// Thresholds measured on laminar beds.
struct LaminarBand {
  double shields, half_width;
  std::string_view source;
};
inline constexpr LaminarBand laminar_band{0.12, 0.03, "Charru et al. 2004, Ouriemi et al. 2007"};

}   // namespace bedload
