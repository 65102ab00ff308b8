// Scene: every parameter of one box of fluid and grains, in SI, validated once, never changed by a run.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "solver/bed/flow_ramp.hpp"
#include "solver/fluid/staggered_grid.hpp"
#include "solver/grains/bed_scene.hpp"

namespace bedload {

enum class DragLawName { stokes, schiller_naumann, di_felice };

/// Which forces act between fluid and grains (besides contacts and weight).
struct Terms {
  bool drag = true, buoyancy = true, pressure_gradient = true, viscous_stress = true;
  /// pressure_gradient and viscous_stress are the grains' half of the void fraction in the fluid's equation:
  /// both (Model A) or neither (Model B).
  bool model_b() const { return !pressure_gradient; }
  bool operator==(const Terms&) const = default;
};

struct Onset {
  enum class Method { ramp, none };
  enum class Criterion { flux, moving_fraction };
  Method method = Method::ramp;
  Criterion criterion = Criterion::flux;
  double value = 1e-2;
};

struct Steps {
  double fluid_interval = 0;   // longest fluid step asked for [s]: 10 DEM steps, or the study file's
};

struct RecordPlan {
  double every = 0;                    // [s]
  std::vector<std::uint64_t> tracks;   // grain ids whose trajectories are kept
};

struct Scene {
  BedScene bed;         // fluid, grains, walls, gravity, DEM step
  StaggeredGrid grid;   // cells of the box; same length, sides and top as bed
  FlowRamp drive;
  Onset onset;
  DragLawName drag = DragLawName::di_felice;
  Terms terms;
  Steps steps;
  RecordPlan record;
  bool bed_only = false;   // finished once the bed has settled (a bed directory)
};

/// Why a scene cannot run: the parameter by its name in a study file, what is wrong with it, the likely fix.
struct SceneProblem {
  std::string parameter, message, hint;
};
std::vector<SceneProblem> problems_of(const Scene&);
/// The same of the grains alone; needs neither their stiffness nor steps.
std::vector<SceneProblem> grain_problems_of(const BedScene&);

/// Refuses a scene that cannot run (ErrorKind::study_invalid), all problems in one message, one per line.
void validate(const Scene&);

}   // namespace bedload
