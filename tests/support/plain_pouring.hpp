// Plain pouring, the oracle of bed preparation: steps as asked for, all grains moved together.
#pragma once

#include "solver/grains/contact_history.hpp"
#include "solver/grains/grain_dynamics.hpp"

namespace bedload::test {

struct PouredBed {
  Grains grains;
  ContactHistory contacts;
  double grain_steps = 0;   // sub-steps of single grains that it took
  bool settled = false;
};

/// Grains of stiffness and step as asked for fall by Stokes' drag (at most 100 sqrt(g'/d)) in collisions of restitution
/// min(e, 0.9), until the mean kinetic energy per grain is below 1e-6 W' d and each is carried.
PouredBed pour_plainly(BedScene);

}   // namespace bedload::test
