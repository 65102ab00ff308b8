// The flow that a lone grain samples of its own making, on the grid in use.
//
// Forces are handed to the fluid and the flow is sampled with the same weights, so that a grain sees, on top of the flow that
// would be there without it, what its own drag and its own moving volume have made of it. Drag laws want the slip against the
// undisturbed flow. The own part follows from the discrete equations alone: the response of the staggered grid to a force that
// moves through it (docs/physics_coupling.md, "Self-disturbance").
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "solver/fluid/staggered_grid.hpp"

namespace bedload {

/// What a grain samples of its own making, per axis. V = V_p/V_c is its volume per cell.
struct OwnFlow {
  Vec3 drag;           // velocity along an axis, per force along it over nu [1/m]
  Vec3 displacement;   // velocity against the grain's own, per own velocity and V [-]
  Vec3 stress;         // -grad q + nu lap u along an axis, per force along it over V_c [-]
  Vec3
      unevenness;   // variance, over its faces, of the velocity that a steady force makes there, over the mean squared [-]
};

/// Tables for one grid, computed as they are asked for (a few milliseconds per node); deterministic.
class SelfDisturbance {
 public:
  explicit SelfDisturbance(const StaggeredGrid&);

  /// For a grain at `position` that moves against the fluid with -slip [m/s] in a fluid of kinematic viscosity [m2/s]. The
  /// force is along the slip. Exact, for a linear fluid without walls, when the slip is along an axis or slow.
  OwnFlow at(Vec3 position, Vec3 slip, double viscosity) const noexcept;

 private:
  /// A function of the position relative to the faces of one component: a sum of products of three functions along its
  /// normal, three in the next direction, three in the one after.
  using Shape = std::array<double, 27>;
  /// Along one axis at one Reynolds number of the cell.
  struct Axis {
    Shape drag;      // the force along the motion
    double stress;   // mean share of the transverse own stress that is left
    Shape displacement;
    std::array<double, 18>
        steady;   // velocity of a face under a steady force on another [1/m], 0-1 faces along, 0-2 across
  };
  using Node = std::array<Axis, 3>;
  const Node& node(int) const;
  double unevenness(const Axis&, const double (&along)[2], const std::array<double, 3>& a,
                    const std::array<double, 3>& b) const noexcept;

  StaggeredGrid grid_;
  double edge_;                                      // of a cube of a cell's volume [m]
  mutable std::vector<std::optional<Node>> nodes_;   // each a function of the grid alone
};

}   // namespace bedload
