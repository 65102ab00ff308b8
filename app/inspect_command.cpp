// `bedload inspect`: what is in a checkpoint.
#include <filesystem>

#include <fmt/format.h>

#include "app/commands.hpp"
#include "app/tables.hpp"
#include "base/error.hpp"
#include "checkpoint/checkpoint.hpp"
#include "checkpoint/checkpoint_series.hpp"
#include "checkpoint/inspect.hpp"
#include "studies/database_values.hpp"

namespace bedload {

namespace fs = std::filesystem;

namespace {

/// A checkpoint file, or the newest of a case directory.
fs::path checkpoint_named(const fs::path& named) {
  if (!fs::is_directory(named)) return named;
  const auto newest = newest_position(named);
  if (!newest) throw Error(ErrorKind::not_found, fmt::format("{} has no whole checkpoint", named.string()));
  return named / fmt::format("ck-{}.h5", newest->step);
}

Rows field_rows(const State& state) {
  Rows rows{{"field", "unit", "shape", "min", "max"}, {}};
  for (const auto& field : summarise(state))
    rows.rows.push_back({field.name, field.unit, fmt::format("{}", fmt::join(field.shape, " x ")),
                         real_or_null(field.min), real_or_null(field.max)});
  return rows;
}

}   // namespace

int inspect_command(const std::string& named, bool digest, bool verify, Form form) {
  const auto file = checkpoint_named(named);
  const auto state = read_checkpoint(file);   // checks seal and checksums
  if (digest) {
    fmt::print("{}\n", state_digest(state));
  } else if (verify) {
    fmt::print("{}: whole\n", file.string());
  } else {
    fmt::print("{}", printed(field_rows(state), form));
  }
  return 0;
}

}   // namespace bedload
