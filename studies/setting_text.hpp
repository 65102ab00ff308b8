// Settings as they stand in a study file.
#pragma once

#include <string>

#include "studies/setting.hpp"

namespace bedload {

/// The value in TOML: 0.3, "1 d", ["buoyancy", "drag"].
std::string as_toml(const Setting&);

}   // namespace bedload
