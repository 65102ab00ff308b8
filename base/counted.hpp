// Numbers of things, as people say them.
#pragma once

#include <string>
#include <string_view>

#include <fmt/format.h>

namespace bedload {

/// "1 case", "2 cases".
template <class Number>
std::string counted(Number number, std::string_view thing) {
  return fmt::format("{} {}{}", number, thing, number == 1 ? "" : "s");
}

}   // namespace bedload
