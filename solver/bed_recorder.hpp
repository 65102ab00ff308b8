// BedRecorder: what is measured during a hold, from one coupled step to a row of the record.
#pragma once

#include <memory>

#include "solver/bed/grain_hops.hpp"
#include "solver/bed/onset_search.hpp"
#include "solver/coupler.hpp"
#include "solver/mixture_momentum.hpp"

namespace bedload {

/// All sums live in State (Search::half, Search::sample); here are only the scales of the scene and scratch.
class BedRecorder {
 public:
  explicit BedRecorder(const Scene&);

  /// When the hold's flow has been imposed: no sums yet, and every grain rests or moves.
  void begin_hold(State&) const;
  /// Before a step: begins the windows that are due and notes where the grains are.
  void before_step(State&);
  /// After a step: counts events, adds forces, and writes a row of samples and tracks when one is due: then true.
  bool after_step(State&, const StepHealth&, const StepBooks&);
  /// At the end of a hold: its row and its profiles.
  void close_hold(State&);
  /// Above which a grain counts as moving [m/s].
  double slow_speed() const;
  /// The bed as the flow finds it: packing, coordination, and profiles as those of hold -1.
  void record_settled_bed(State&) const;

 private:
  void add_profile(const State&, ProfileSums&) const;
  void close_block(State&) const;
  HoldVerdict verdict_of(const State&) const;
  void record_sample(State&, const StepHealth&);
  void record_tracks(State&) const;
  double outer_force(const State&, const StepBooks&) const;
  double flux(double events, double duration) const;
  double driven_below(const State&) const;
  double lid_shields(const State&, const Window&) const;
  RestRule rest_rule() const;
  void record_hops(State&) const;
  double measured_shields(const State&, const Window&, const StreamwiseMomentum& now) const;
  double momentum_residual(const Grains&, const Window&, const StreamwiseMomentum& now) const;

  const Scene scene_;
  const double area_;             // of the box, seen from above [m2]
  const double stress_scale_;     // (rho_p - rho_f) g d [Pa]
  const double speed_scale_;      // sqrt(|s-1| g d) [m/s]
  const double surface_grains_;   // N_s [-]
  const double grain_time_;       // t_d [s]

  MixtureMomentum momentum_of_;
  std::vector<double> x_before_;
  double time_before_ = 0;
  bool in_last_half_ = false;   // the step under way; set by before_step
};

}   // namespace bedload
