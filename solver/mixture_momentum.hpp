// The streamwise momentum of fluid and grains, as the coupled step conserves it.
#pragma once

#include <vector>

#include "solver/coupling/void_fraction.hpp"
#include "solver/fluid/column_flow.hpp"
#include "solver/scene.hpp"
#include "solver/state.hpp"

namespace bedload {

struct StreamwiseMomentum {
  double fluid_below = 0;   // of the fluid below a level [kg m/s]
  double total = 0;         // of all fluid and all grains [kg m/s]
};

/// Evaluates rho_f sum eps_f u_f V_c + sum m v with the void fraction of the coupling. Keeps scratch between calls.
class MixtureMomentum {
 public:
  explicit MixtureMomentum(const Scene&);
  StreamwiseMomentum operator()(const State&, double level);

 private:
  void add_cells(const State&, std::vector<double>& plane);    // sum of eps u over each plane of cells
  void add_layers(const State&, std::vector<double>& plane);   // eps u of each layer

  FluidRung rung_;
  Column column_;   // of a rung below the box
  StaggeredGrid grid_;
  KernelSmoothing smoothing_;
  double fluid_density_;
  Stencils stencils_;
  VoidFraction void_fraction_;
};

}   // namespace bedload
