// `bedload inspect`: what is in a checkpoint.
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/commands.hpp"
#include "app/tables.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "checkpoint/checkpoint.hpp"
#include "checkpoint/checkpoint_series.hpp"
#include "checkpoint/inspect.hpp"
#include "studies/database_values.hpp"

namespace bedload {

namespace fs = std::filesystem;

namespace {

struct Named {
  fs::path file;
  State state;
};

/// The newest whole checkpoint of a case directory, seal and checksums checked.
Named newest_in(const fs::path& directory) {
  std::vector<std::string> broken;
  auto state = newest_whole(directory, [&](const std::string& line) { broken.push_back(line); });
  if (!state && broken.empty())
    throw Error(ErrorKind::not_found, fmt::format("{} has no checkpoint", directory.string()));
  if (!state)
    throw Error(ErrorKind::corrupt,
                fmt::format("{}: no checkpoint is whole: {}", directory.string(), fmt::join(broken, "; ")),
                "`bedload run` puts broken files aside; without a whole one the case has to start from its beginning");
  for (const auto& line : broken) log_warning(line);
  return {directory / fmt::format("ck-{}.h5", state->clock.step), std::move(*state)};
}

Named checkpoint_named(const fs::path& named) {
  if (fs::is_directory(named)) return newest_in(named);
  return {named, read_checkpoint(named)};
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
  const auto [file, state] = checkpoint_named(named);
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
