// Rows as people and as programs read them.
#pragma once

#include "app/commands.hpp"
#include "scheduler/database.hpp"

namespace bedload {

/// Aligned columns; CSV (RFC 4180); or a JSON array of objects. Numbers in CSV and JSON read back to the same bits.
std::string printed(const Rows&, Form);

}   // namespace bedload
