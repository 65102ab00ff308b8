// What the liquid between two grains does to their collision.
#pragma once

namespace bedload {

/// Nothing, or one of the two: both are the film between the grains, so together they would count it twice.
struct ContactTerms {
  bool wet_restitution = false;   // the rebound falls with the Stokes number of the approach
  bool lubrication = false;       // the film resists approach and parting, before contact and during it
};

}   // namespace bedload
