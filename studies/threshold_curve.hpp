// The threshold curve: per parameter set, the Shields number at onset over all seeds.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scheduler/database.hpp"
#include "studies/error_budget.hpp"
#include "studies/motion_measures.hpp"
#include "studies/threshold_fit.hpp"

namespace bedload {

/// One parameter set. What the runs do not say is nan.
struct ThresholdPoint {
  std::string set, label;
  double diameter = 0;              // [m]
  double density_ratio = 0;         // s [-]
  double viscosity = 0;             // nu [m2/s]
  double cell_z = 0;                // height of the cells, per diameter: thresholds depend on it [-]
  std::string method = "ramp";      // ramp (screening) | bisect
  std::string criterion;            // flux | moving_fraction, of the surface grains
  double criterion_value = 0;       // from which on the bed counts as moving [-]
  double galileo = 0;               // sqrt((s-1) g d^3)/nu [-]
  double reynolds = 0;              // Re* = sqrt(theta) Ga of theta_50, or of the one bound there is [-]
  double shields = 0;               // theta_50: half of all packings move below it (threshold_fit) [-]
  double shields_16 = 0;            // one deviation of the logarithm below it, and above; nan where the width
  double shields_84 = 0;            // of the distribution is below the brackets [-]
  double interval_lower = 0;        // where theta_50 lies with `confidence`, the seeds being the sample; nan = open,
  double interval_upper = 0;        // or a single seed, which says nothing of others [-]
  double confidence = 0;            // 0.95; less with fewer than six seeds
  double lower = 0, upper = 0;      // lowest and highest bound of any seed [-]
  double stop = 0;                  // theta_stop: below it half of all moving beds come to rest; bisection alone [-]
  double stop_interval_lower = 0;   // as of theta_50 [-]
  double stop_interval_upper = 0;
  double hysteresis = 0;     // 1 - theta_stop/theta_50 [-]
  double systematic = 0;     // relative error by the pairs of the study (error_budget); nan: mesh not tested [-]
  std::string status;        // bracketed | censored_below | censored_above | noisy
  std::uint64_t seeds = 0;   // finished
  std::uint64_t bracketed = 0, censored_below = 0, censored_above = 0, noisy = 0;   // of them

  /// Calls visit(name, member) for every number and word, in the order of table threshold_curve, of CSV and of JSON.
  template <class Point, class Visit>
  static void each(Point& p, Visit&& visit) {
    visit("label", p.label), visit("diameter_m", p.diameter), visit("density_ratio", p.density_ratio);
    visit("viscosity_m2_per_s", p.viscosity), visit("cell_z_d", p.cell_z);
    visit("method", p.method), visit("criterion", p.criterion), visit("criterion_value", p.criterion_value);
    visit("galileo", p.galileo), visit("friction_reynolds", p.reynolds);
    visit("shields", p.shields), visit("shields_16", p.shields_16), visit("shields_84", p.shields_84);
    visit("interval_lower", p.interval_lower), visit("interval_upper", p.interval_upper);
    visit("confidence", p.confidence), visit("shields_lower", p.lower), visit("shields_upper", p.upper);
    visit("stop", p.stop), visit("stop_interval_lower", p.stop_interval_lower);
    visit("stop_interval_upper", p.stop_interval_upper), visit("hysteresis", p.hysteresis),
        visit("systematic", p.systematic);
    visit("status", p.status), visit("seeds", p.seeds), visit("bracketed", p.bracketed);
    visit("censored_below", p.censored_below), visit("censored_above", p.censored_above), visit("noisy", p.noisy);
    visit("parameter_set", p.set);
  }
};

/// What a run says of the threshold of its packing: the Shields numbers of a row of table thresholds, nan where it has none.
/// Bounds that were measured in the wrong order hold between them all that the run knows.
SeedBracket seed_bracket(std::uint64_t seed, double lower, double upper);

/// Recomputes table threshold_curve from the thresholds of the cases that are in the study, in one transaction. Called
/// with every case's results; to be called too when cases leave or rejoin the study.
void update_threshold_curve(Database&);

/// The curve, ordered by diameter, density ratio, viscosity, then parameter set.
std::vector<ThresholdPoint> threshold_curve(const Database&);

/// For people: aligned columns, and the laminar band and turbulent curves at the same Galileo number beside ours; below them
/// what counts as onset, the error budget, and what a bound that is missing and a noisy ramp mean, where there are such.
std::string curve_as_table(const std::vector<ThresholdPoint>&, const std::vector<BudgetEntry>&);
/// "0.1120-0.1146": where theta_50 lies, with its confidence where that is not 95 %; "> 0.1120" where its upper end is open;
/// "-" where nothing says.
std::string interval_in_words(const ThresholdPoint&);
/// "onset: flux >= 0.01 per surface grain and td; cells 0.5 d high".
std::string onset_in_words(const std::vector<ThresholdPoint>&);
/// For programs: shortest numbers that read back to the same bits, fixed order; an empty field where there is no value.
std::string curve_as_csv(const std::vector<ThresholdPoint>&);
std::string curve_as_json(const std::vector<ThresholdPoint>&, const std::vector<MotionMeasures>&);

}   // namespace bedload
