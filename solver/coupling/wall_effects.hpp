// What a plane no-slip wall does to a lone sphere near it: factors on drag and torque, and how much of them the grid shows.
//
// Distances are from the centre, as k = a/z (1 = touching) or gap = (z - a)/a. Creeping flow; a grain among others
// (packing density of the others above 0.04) has no such factors, its drag law knows the neighbours.
#pragma once

#include <optional>

#include "solver/fluid/staggered_grid.hpp"

namespace bedload {

inline constexpr double wall_roughness = 0.01;   // gap, in radii, at which two rough surfaces touch

/// The nearest no-slip wall of the box.
struct NearWall {
  int axis;          // of its normal
  bool upper;        // at the far end of the axis (a lid)
  double distance;   // from the centre of the grain [m]
};

/// None in a box without no-slip walls; a free-slip top is none.
std::optional<NearWall> nearest_wall(const StaggeredGrid&, Vec3 position);

/// Drag on a sphere that moves along a wall, over that of a lone one: Faxen 1922, near contact Goldman, Cox & Brenner 1967
/// (Chem. Eng. Sci. 22, 637), -(8/15) ln gap + 0.9588. Gaps below wall_roughness count as that.
double drag_along_wall(double k);

/// Drag on a sphere that moves towards or from a wall: Bevan & Prieve 2000 (J. Chem. Phys. 113, 1228) for Brenner 1961, within
/// 5 %. Gaps below 0.1 count as 0.1: nearer, it is the film of a contact.
double drag_towards_wall(double k);

/// Drag on a sphere at rest in a shear flow along a wall, over that of a lone one at the speed at its centre: Zeng, Najjar,
/// Balachandar & Fischer 2009 (Phys. Fluids 21, 033302); 1.7005 where it touches (O'Neill 1968), 1 + 9/16 k far off.
double shear_drag_at_wall(double k);

/// Torque on a sphere at rest in a shear flow along a wall, over 4 pi mu gdot a^3: 0.944 where it touches (Goldman, Cox &
/// Brenner 1967), 1 - 3/16 k^3 far off; within 0.6 % of their table between.
double shear_torque_at_wall(double k);

/// Torque on a sphere that spins about an axis along the wall, over 8 pi mu a^3 omega: 1 + 5/16 k^3, near contact
/// -(2/5) ln gap + 0.3817 (Goldman, Cox & Brenner 1967); gaps as in drag_along_wall.
double spin_torque_at_wall(double k);

/// kappa of a lone grain in creeping flow far from walls, mean over places in a cell: the velocity that its own drag gives to the
/// fluid which it samples, per drag, in units of its Stokes mobility. Fitted for this kernel to the discrete equations, cells
/// normal x tangential x tangential [m], drag along or across the flat sides; within 0.06 of its value (test).
double mean_response(bool along, double diameter, double normal, double tangential);

/// Velocity that the grid reflects back at a grain from a wall, per drag of a lone grain [-] (in units of its Stokes
/// mobility): 9/16 k along, 9/8 k towards the wall while the wall is some cells away, never more than `kappa`
/// (mean_response).
/// distance [m] counts as at least 0.75 cells along the wall: nearer, a kernel folded at the wall sees no change.
/// normal, tangential: edges of the cells [m]. Within 0.05 kappa of the discrete equations' own from 0.75
/// cells on (test).
double resolved_reflection(bool along, double distance, double diameter, double kappa, double normal,
                           double tangential);

/// A grain's whole drag near a wall of whose effect the grid already shows a part, axis by axis.
struct WallDrag {
  Vec3 slip{1, 1, 1}, flow{};        // force on the grain = beta [slip (u - v) + flow (u - u_wall)], u as sampled
  Vec3 applied{1, 1, 1}, reflex{};   // what must be applied of any other force to be felt as one; and:
  /// Velocity of the fluid that would be there without the grain. All velocities relative to the wall's.
  Vec3 undisturbed(Vec3 sampled, Vec3 grain) const { return scaled(applied, sampled + scaled(reflex, grain)); }
};

/// In units of the lone grain's drag, f = F_s u - F_t v + f_e is wanted, u undisturbed, f_e any other force. F_t is
/// drag_along_wall or drag_towards_wall; F_s along the wall shear_drag_at_wall, towards it the first image's 1 + 9/8 k (at most F_t).
/// The flow sampled is u + (R - kappa) f, R the resolved reflection, so that
///   f = (F_s u_sampled - F_t v + f_e)/(1 + F_s (R - kappa)).
/// reflected: R. removed: the part of kappa for which beta is corrected already, by 1/(1 - removed); 0 without such a
/// correction. Both per axis and times the drag law's multiplier. share: loneness of the grain, by which all this is
/// blended in.
WallDrag wall_drag(const NearWall&, double diameter, Vec3 removed, Vec3 reflected, double share);

}   // namespace bedload
