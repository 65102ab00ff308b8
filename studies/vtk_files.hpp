// A state as VTK and ParaView read it: VTKHDF 1.0 files of fluid and grains, and an XDMF index over time.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "solver/scene.hpp"
#include "solver/state.hpp"

namespace bedload {

/// ImageData whose points are the cell centres, arrays [nz][ny][nx] of doubles: velocity [..][3], the means of opposite faces
/// [m/s]; pressure without its hydrostatic part [Pa]; void_fraction as the coupling deposits it [-]. PointData, since VTK 9.1
/// fails on CellData of images.
std::vector<std::byte> fluid_for_vtk(const Scene&, State);

/// UnstructuredGrid of one vertex per grain, in order of id: id, diameter [m], density [kg/m3], velocity [m/s], spin [rad/s],
/// fixed, contacts (with grains and walls) [-], contact_force, the mean over the last step [N].
std::vector<std::byte> grains_for_vtk(const State&);

struct ViewedMoment {
  std::string name;         // in the names of its files: a step, or "bed"
  double time = 0;          // [s]
  std::size_t grains = 0;   // how many
};

/// Names of a moment's files, without directory.
std::string fluid_file(const std::string& moment);
std::string grains_file(const std::string& moment);

/// The XDMF 3 index of files that stand beside it.
std::string xdmf_index(const Scene&, const std::vector<ViewedMoment>&);

}   // namespace bedload
