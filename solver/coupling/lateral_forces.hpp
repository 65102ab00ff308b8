// Forces across the slip: shear lift by the fluid's vorticity, Magnus force by the grain's spin.
//
// Both are w x k, w = u - v the slip and k a lift vector [m3/s] (per fluid density): they do no work on the slip, turn with
// the axes, and vanish with slip or vorticity. Lift vectors add.
#pragma once

#include "solver/coupling/quad.hpp"

namespace bedload {

/// Lift vector of a sphere in a flow of the given vorticity, Saffman 1965 (J. Fluid Mech. 22, 385) as continued to finite Re
/// by Mei 1992 (Int. J. Multiphase Flow 18, 145): k = 1.615 d^2 sqrt(nu/|omega|) f omega. Far from walls, for
/// d |omega|/(2 |w|) <= 0.4 and Re <= 100. slip [m/s]; vorticity of the fluid, curl u [1/s]; diameter [m]; viscosity [m2/s].
Vec3 saffman_mei(Vec3 slip, Vec3 vorticity, double diameter, double viscosity);
/// The same of four grains, given the magnitudes: lift vector per vorticity [m3].
Quad saffman_mei(Quad slip, Quad vorticity, Quad diameter, double viscosity);

/// Lift vector of a spinning sphere, relative_spin = omega_p - curl(u)/2 [rad/s]: Rubinow & Keller 1961 (J. Fluid Mech. 11,
/// 447), (pi/8) d^3, where slow; Oesterle & Bui Dinh 1998 (Exp. Fluids 25, 16) up to Re 140, never above Rubinow & Keller.
Vec3 magnus(Vec3 slip, Vec3 relative_spin, double diameter, double viscosity);
/// The same of four grains, given the magnitudes: lift vector per relative spin [m3].
Quad magnus(Quad slip, Quad relative_spin, Quad diameter, double viscosity);

/// Lift coefficient, lift/((pi/8) d^2 U^2), of a sphere at rest in a shear flow along a plane wall, gap diameters from it, U
/// the undisturbed speed at its centre and Re = U d/nu: Zeng, Najjar, Balachandar & Fischer 2009 (Phys. Fluids 21, 033302),
/// Re up to 200. For Re -> 0 at the wall it is Leighton & Acrivos 1985: 9.22 gdot^2 a^4.
double wall_lift_coefficient(double gap, double re);

/// Lift vector near a plane wall, `distance` from centre to wall [m]: that of Zeng et al. for a sphere that touches, in the
/// shear `at_wall` = (normal into the fluid) x (u - u_wall)/distance, which is the vorticity of a shear along the wall; that of
/// saffman_mei one diameter away, weighted linearly between (an engineering choice).
Vec3 shear_lift_near_wall(Vec3 slip, Vec3 vorticity, Vec3 at_wall, double diameter, double viscosity, double distance);

/// The lift vector k, cut to half of `drag` (force per slip and fluid density, its least axis [m3/s]). Within the ranges of the laws k
/// stays below that (0.15 of the drag for saffman_mei, 0.44 at a wall). Beyond - a grain that goes along with a strong shear -
/// an explicit lift larger than the implicit drag would grow from step to step.
Vec3 limited_lift(Vec3 lift_vector, double drag);

}   // namespace bedload
