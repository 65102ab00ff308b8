// A search for the threshold of one bed: which hold comes next, as a pure function of those that are done.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "solver/bed/bed_record.hpp"

namespace bedload {

/// What a hold is for. `staircase`: coarse steps upwards, each from what the last one left, to learn where to look.
/// `onset`: the settled bed under a flow that is imposed at once. `stir`: the same bed set in motion. `stop`: what a stir
/// has left, under a weaker flow. `shear`: the history of a bed, before all others and in no record.
enum class HoldPurpose : std::uint64_t { ramp = 0, staircase = 1, onset = 2, stir = 3, stop = 4, shear = 5 };

/// Arrested: hardly anything moves any more. Mobile: the flux is at or above the criterion, and does not die away.
/// Undecided: neither.
enum class HoldVerdict : std::uint64_t { none = 0, arrested = 1, undecided = 2, mobile = 3 };
std::string_view name_of(HoldPurpose);
std::string_view name_of(HoldVerdict);

/// What a search knows of a hold that is done.
struct JudgedHold {
  HoldPurpose purpose = HoldPurpose::onset;
  double level = 0;   // nominal Shields number [-]
  HoldVerdict verdict = HoldVerdict::none;
};

/// What comes next.
struct PlannedHold {
  HoldPurpose purpose = HoldPurpose::onset;
  double level = 0;            // nominal Shields number [-]
  double duration = 0;         // [s]
  bool from_settled = false;   // begins with the settled bed, else with what the last hold left
  bool operator==(const PlannedHold&) const = default;
};

/// Where and how finely to look (physics of the estimator: docs/physics_bed.md).
struct OnsetSearchPlan {
  std::vector<double> staircase;   // rising nominal Shields numbers [-]
  double bracket = 0.04;           // upper/lower - 1 at which a search is over [-]
  double stair = 0;                // how long a step of the staircase is held [s]
  double hold = 0;                 // of onset and stop; an undecided one goes on for twice as long, once [s]
  double shift = 0;   // of onset's levels against the staircase's, in stairs; a packing's own (-1/2 to 1/2)
};

/// Nominal Shields numbers between which a bed begins to move, or stops: the highest at which it came to rest below the
/// lowest at which it moved; 0 and infinity where there is none.
struct LevelBracket {
  double lower = 0, upper = 0;
};

/// What a record says of its holds, in their order.
std::vector<JudgedHold> judged_holds(const BedRecord::Holds&);

/// The next hold of the search; none when it is over.
std::optional<PlannedHold> next_hold(const OnsetSearchPlan&, std::span<const JudgedHold> done);

/// What holds of this purpose (onset or stop) have found so far.
LevelBracket bracket_of(std::span<const JudgedHold> done, HoldPurpose);

/// Judges a hold by the flux in its middle and in its last third [-] against the criterion's value (docs/physics_bed.md):
/// mobile at or above it, unless less than 0.3 of the middle third is left; arrested below a tenth of it.
HoldVerdict judge_hold(double middle_flux, double last_flux, double value);

/// The flux in the middle and in the last third of a hold, from the samples of it: `time` their ends [s], `flux` their means;
/// each counts in the third that its end is in.
struct Thirds {
  double middle = 0, last = 0;
};
Thirds thirds_of(std::span<const double> time, std::span<const double> flux, double start, double end);

}   // namespace bedload
