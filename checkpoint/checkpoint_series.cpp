// Which checkpoint counts: the newest whole one. What is broken is put aside, what is old removed.
#include "checkpoint/checkpoint_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "base/durable_file.hpp"
#include "base/error.hpp"
#include "checkpoint/checkpoint.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;

struct CheckpointFile {
  std::uint64_t step;
  fs::path path;
};

/// The step in "ck-<step>.h5"; nothing for any other name.
std::optional<std::uint64_t> step_in_name(const std::string& name) {
  constexpr std::string_view head = "ck-", tail = ".h5";
  if (!name.starts_with(head) || !name.ends_with(tail)) return {};
  std::uint64_t step = 0;
  const char *first = name.data() + head.size(), *last = name.data() + name.size() - tail.size();
  const auto [end, error] = std::from_chars(first, std::max(first, last), step);
  if (error != std::errc() || end != last) return {};
  return step;
}

/// Newest first. A directory that does not exist holds none.
std::vector<CheckpointFile> checkpoints_in(const fs::path& directory) {
  std::vector<CheckpointFile> files;
  std::error_code error;
  for (fs::directory_iterator entry(directory, error), end; !error && entry != end; entry.increment(error))
    if (const auto step = step_in_name(entry->path().filename().string())) files.push_back({*step, entry->path()});
  if (error && error != std::errc::no_such_file_or_directory)
    throw Error(ErrorKind::io, fmt::format("{}: cannot list the directory: {}", directory.string(), error.message()));
  std::ranges::sort(files, std::greater(), &CheckpointFile::step);
  return files;
}

/// A broken file keeps its bytes for whoever wants to know why, under a name that no series looks at.
fs::path put_aside(const fs::path& path) {
  fs::path aside = path;
  aside += ".broken";
  std::error_code error;
  fs::rename(path, aside, error);
  if (error) throw Error(ErrorKind::io, fmt::format("{}: cannot put it aside: {}", path.string(), error.message()));
  return aside;
}

/// True for a file that is broken in itself; false for one of a newer bedload, and for a disk that cannot be read now.
bool is_broken(const Error& error) {
  return error.kind == ErrorKind::corrupt && dynamic_cast<const WrittenByNewer*>(&error) == nullptr;
}

/// What `read` makes of the newest checkpoint that is whole, with nothing changed on disk.
template <class Made, class Read>
std::optional<Made> first_whole(const fs::path& directory, const Read& read, const CheckpointSeries::Say& say) {
  constexpr int listings = 10;   // far more than a worker can outpace; bounded for links that lead nowhere
  for (int n = 0; n < listings; ++n) {
    std::vector<std::string> broken;
    std::optional<Made> made;
    bool vanished = false;   // removed or put aside between our listing and our reading: there may be a newer one now
    for (const CheckpointFile& file : checkpoints_in(directory)) {
      try {
        made = read(file.path);
        break;
      } catch (const Error& error) {
        if (error.kind == ErrorKind::not_found) vanished = true;
        else if (is_broken(error)) broken.emplace_back(error.what());
        else throw;
      }
    }
    if (!made && vanished) continue;
    for (const std::string& line : broken) say(line);
    return made;
  }
  return {};
}

}   // namespace

CheckpointSeries::CheckpointSeries(fs::path directory, int keep, Say say)
    : directory_(std::move(directory)), keep_(keep), say_(std::move(say)) {}

std::optional<State> CheckpointSeries::newest() {
  std::string broken;
  for (const CheckpointFile& file : checkpoints_in(directory_)) {
    try {
      State state = read_checkpoint(file.path);
      if (!broken.empty()) say_(fmt::format("falling back to {}", file.path.filename().string()));
      return state;
    } catch (const Error& error) {
      if (!is_broken(error)) throw;
      broken = error.what();
      say_(fmt::format("{}; kept as {}", broken, put_aside(file.path).filename().string()));
    }
  }
  if (broken.empty()) return {};
  throw Error(ErrorKind::corrupt,
              fmt::format("{}: no checkpoint is whole; the last one tried: {}", directory_.string(), broken),
              "the broken files are kept; running the case again starts it from its beginning");
}

void CheckpointSeries::publish(const State& state) {
  write_checkpoint(directory_ / fmt::format("ck-{}.h5", state.clock.step), state);
  const std::vector<CheckpointFile> files = checkpoints_in(directory_);
  for (std::size_t n = std::size_t(keep_); n < files.size(); ++n) {
    std::error_code ignored;   // one too many does no harm, and the next publication tries again
    fs::remove(files[n].path, ignored);
  }
  remove_stray_temporaries(directory_);
}

std::optional<State> newest_whole(const fs::path& directory, const CheckpointSeries::Say& say) {
  return first_whole<State>(directory, read_checkpoint, say);
}

std::vector<std::uint64_t> checkpoint_steps(const fs::path& directory) {
  std::vector<std::uint64_t> steps;
  for (const CheckpointFile& file : checkpoints_in(directory)) steps.insert(steps.begin(), file.step);
  return steps;
}

std::optional<CheckpointPosition> newest_position(const fs::path& directory) {
  const auto position_in = [](const fs::path& file) {
    const CheckpointHeader header = header_from_image(read_file(file), file.string());
    return CheckpointPosition{header.step, header.phase == Search::finished};
  };
  return first_whole<CheckpointPosition>(directory, position_in, [](const std::string&) {});
}

}   // namespace bedload
