// Onset of motion: which grains move, and at which hold of a ramp the bed has begun to.
#pragma once

#include <cmath>
#include <span>
#include <string_view>

#include "solver/bed/bed_record.hpp"
#include "solver/grains/grains.hpp"
#include "solver/scene.hpp"

namespace bedload {

enum class OnsetStatus { none, bracketed, censored_below, censored_above, noisy };
std::string_view name_of(OnsetStatus);

/// The threshold of one run: Shields numbers measured at the last still and the first moving hold. Noisy = a hold moved
/// and the next did not; then `lower` is the hold before that first stir and `upper` the later confirmed onset, if any.
struct IncipientMotion {
  OnsetStatus status = OnsetStatus::none;
  double shields =
      0;   // where the criterion passes its value between the last still and first moving hold, log-linear [-];
           // nan unless a moving hold is confirmed and has one before it
  double lower = 0;   // [-]; nan below a first hold that moves
  double upper = 0;   // [-]; nan above a last hold that is still
};

/// The threshold that a search has bracketed, and where a moving bed came to rest; Shields numbers measured in the holds that
/// bound them, nan where none does. `shields` is their geometric mean. Noisy = what moved was measured to be no stronger than
/// what rested.
struct SearchedMotion {
  IncipientMotion onset;
  double stop_lower = 0, stop_upper = 0;   // [-]
};
SearchedMotion searched_motion(const BedRecord&);

/// Onset by ramp: the first hold k at or above `value` that k+1 confirms; pure function of the record.
IncipientMotion incipient_motion(const BedRecord&, Onset::Criterion, double value);

/// Where a measure of motion passes `value` among holds in any order: upper is the lowest Shields number at which it was
/// reached, lower the highest below that at which it was not, `shields` log-linear between them. Censored, never noisy.
IncipientMotion lowest_reached(std::span<const double> shields, std::span<const double> motion, double value);

/// True when the ramp may end: onset confirmed and two more holds recorded, or every hold done.
bool ramp_is_over(const BedRecord&, const Onset&, std::size_t ramp_levels);

/// From one place to another along x [m], by the shorter way round in a box of `period` > 0.
inline double way_along_x(double from, double to, double period) noexcept {
  const double way = to - from;
  return period > 0 ? way - period * std::round(way / period) : way;
}

/// Adds the way that every grain has gone along x since `x_before` [m] to its travel (by the shorter way round in a box of
/// `period` > 0), and takes off each d/2 that is complete; a grain with one has moved. Returns how many there were: the events of the flux criterion.
std::uint64_t count_events(Grains&, std::span<const double> x_before, double period, double diameter) noexcept;

/// Number of grains that have gone d/2 downstream since the hold began, each counted once, wherever it is now.
std::uint64_t count_moved(const Grains&) noexcept;

/// Grains that are faster move [m/s].
constexpr double moving_speed(double speed_scale) { return 0.01 * speed_scale; }

/// Number of grains that are faster than 0.01 sqrt(|s-1| g d) [m/s].
std::uint64_t count_moving(const Grains&, double speed_scale) noexcept;

/// Number of surface grains, A phi_A/(pi d^2/4) with phi_A = 0.8.
double surface_grains(const Scene&);

/// Grain time scale t_d = max(sqrt(d/((s-1) g)), d/U_t) [s]; `terminal_speed` U_t [m/s] is that of the scene's own drag law
/// (coupling/drag_laws), `density_ratio` s. Grains no heavier than the fluid have only d/U_t; 0 if neither is defined.
double grain_time(double diameter, double density_ratio, double gravity, double terminal_speed);

}   // namespace bedload
