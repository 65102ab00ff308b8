// `accuracy` in [models]: the cheapest setting that a trade has measured to be good enough.
#pragma once

#include <optional>
#include <string>

#include "studies/study.hpp"

namespace bedload {

struct AccuracyChoice {
  std::string from;      // the trade's file
  std::string setting;   // its name there
  Settings
      settings;   // of all keys that the trade varies: those of the finest setting, changed as the chosen one has them
  std::string fluid = "box";     // its rung of the fluid
  bool fluid_is_named = false;   // by the study: not for the trade to choose
  std::string passed_over;       // a cheaper setting that is good enough but for its rung, and why; empty: none
  bool finest = false;           // the trade's own measure: nothing cheaper is good enough
  double error = 0;              // of theta_c against the finest setting, or its bound [-]
  double target = 0;             // [-]
  double cost = 1;               // core seconds relative to the finest setting
  double pace = 1;               // core seconds measured per core second that `plan` predicts by itself
  double galileo = 0, density_ratio = 0, shields = 0;   // of the scene of the trade [-]
  double diameter = 0, grain_time = 0;                  // of its grains [m], [s]
  int version = 0;                                      // physics_version under which it was measured

  /// What was chosen, and why.
  std::string in_words() const;
};

/// Reads the trade that a study names (`models.accuracy.from`, relative to the study's file) and takes the cheapest of its
/// settings whose error is known to be at most `models.accuracy.target` (the farther bound, in every packing), and which differ from the finest in
/// how it is computed, not in what. Of rungs of the fluid it takes the one that the study names; else a column only where x and
/// y are periodic and the bed is level in all cases, and the finest setting is a box; a profile never. Nothing where no accuracy is asked for; what is wrong is reported.
std::optional<AccuracyChoice> chosen_accuracy(const Study&, const TableReader&, Problems&);

/// Why a chosen setting is of another scale than the scene: seconds and pascals are good for grains of one size; empty if it is not.
std::string of_another_scale(const AccuracyChoice&, const Scene&);

/// Why a scene is too far from that of the trade: a factor of more than 3 in Galileo number, density ratio or Shields number;
/// empty if it is not.
std::string too_far(const AccuracyChoice&, const Scene&);

}   // namespace bedload
