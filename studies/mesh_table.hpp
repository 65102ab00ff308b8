// One sphere's fall on finer and finer meshes, side by side: what the grid does to a grain that makes its own flow.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "studies/validation.hpp"

namespace bedload {

inline constexpr const char* mesh_group = "settling";   // whose falls they are

/// The falls that the rungs of a ladder show, coarse meshes first, on each the raw one first.
std::vector<MeshFall> mesh_falls(const std::vector<RungResult>&);

/// Heads of the columns, with units, and the cells of a fall, for people.
std::vector<std::string> mesh_columns();
std::vector<std::string> mesh_cells(const MeshFall&);

inline constexpr const char* mesh_caption =
    "The settling sphere of \"Numerical Simulation of Incipient Sediment Motion Driven by Fluid Flow\" by the edge h "
    "of "
    "its cells: raw, the grain also meets the flow that it makes itself; corrected, it does not. Errors of the speed "
    "of "
    "fall against the terminal speed of the drag law in use and of Stokes' law, ripple of the speed over a cell, time "
    "of "
    "500 fluid steps on one core.";

/// Error against the drag law over h/d; nothing without falls.
std::optional<ValidationFigure> mesh_figure(const std::vector<MeshFall>&);

}   // namespace bedload
