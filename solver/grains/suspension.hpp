// Grains in suspension: placed at random over the whole box, without touching.
#pragma once

#include <vector>

#include "solver/grains/bed_scene.hpp"

namespace bedload {

/// Places [m] of grains of these diameters [m]: a face-centred cubic arrangement with vacancies that fills the box,
/// then hard-sphere Monte Carlo moves (Metropolis et al. 1953, J. Chem. Phys. 21, 1087) until its order is lost; above a
/// solid fraction of about one half, where hard spheres crystallise, what remains is a shaken crystal. Deterministic in
/// (scene, diameters). Refuses (study_invalid) more grains than a crystal of the largest has room for.
void check_suspension_fits(const BedScene&, double largest_diameter);   // the same refusal, at no cost
std::vector<Vec3> places_in_suspension(const BedScene&, const std::vector<double>& diameters);

}   // namespace bedload
