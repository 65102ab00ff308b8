// What bounds the box: the words that fluid and grains share.
#pragma once

namespace bedload {

enum class Side { periodic, wall };   // wall = no-slip
enum class Top { lid, free_slip };    // lid = no-slip plane that moves along x; read only when z is wall

}   // namespace bedload
