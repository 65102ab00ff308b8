// Ghost layers: periodic copies, no-slip reflection, the moving lid, free slip.
#pragma once

#include "solver/fluid/staggered_grid.hpp"

namespace bedload {

/// Which ghosts are filled: both layers, or the inner one alone, for what reads no farther than its neighbours. (Beyond walls
/// that they are normal to, faces get both.)
enum class GhostLayers { inner, both };

/// Fills the ghost layers of a velocity: periodic copy; at walls normal faces 0 and n are zero and the field beyond is
/// odd, tangential ghosts reflect about the wall's speed (u = lid_speed on the lid, even under a free-slip top).
void fill_velocity_ghosts(const StaggeredGrid&, FaceFields& velocity, double lid_speed,
                          GhostLayers = GhostLayers::both);

/// The same for a centre field: periodic copy, even at walls (zero normal gradient).
void fill_centre_ghosts(const StaggeredGrid&, Field<Centre>&);

/// Face quantities that are no velocity (flux, void fraction, coefficient): periodic copy; nothing beyond walls is
/// read.
void fill_face_ghosts(const StaggeredGrid&, FaceFields&, GhostLayers = GhostLayers::both);

/// Only what a divergence reads: in periodic directions face n is face 0.
void close_faces(const StaggeredGrid&, FaceFields&) noexcept;

}   // namespace bedload
