// What a checkpoint costs: 20 000 grains, 100 000 contacts, 40 000 cells.
#include <benchmark/benchmark.h>

#include <filesystem>

#include "checkpoint/checkpoint.hpp"
#include "solver/state.hpp"
#include "tests/support/random_state.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

const State& large_state() {
  static const State state =
      random_state(1, {.grains = 20'000, .contacts = 100'000, .rows = 1'000, .cells = {40, 25, 40}});
  return state;
}

void count_bytes(benchmark::State& run, std::size_t bytes) {
  run.counters["MB"] = double(bytes) / 1e6;
  run.SetBytesProcessed(std::int64_t(bytes) * std::int64_t(run.iterations()));
}

void BuildImage(benchmark::State& run) {
  std::size_t bytes = 0;
  for (auto _ : run) bytes = checkpoint_image(large_state()).size();
  count_bytes(run, bytes);
}

void ReadImage(benchmark::State& run) {
  const auto image = checkpoint_image(large_state());
  for (auto _ : run) benchmark::DoNotOptimize(state_from_image(image, "image"));
  count_bytes(run, image.size());
}

void ReadHeader(benchmark::State& run) {
  const auto image = checkpoint_image(large_state());
  for (auto _ : run) benchmark::DoNotOptimize(header_from_image(image, "image"));
  count_bytes(run, image.size());
}

void WriteToDisk(benchmark::State& run) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "ck-1.h5";
  for (auto _ : run) write_checkpoint(path, large_state());
  count_bytes(run, std::filesystem::file_size(path));
}

void DigestState(benchmark::State& run) {
  for (auto _ : run) benchmark::DoNotOptimize(state_digest(large_state()));
}

BENCHMARK(BuildImage)->Unit(benchmark::kMillisecond);
BENCHMARK(ReadImage)->Unit(benchmark::kMillisecond);
BENCHMARK(ReadHeader)->Unit(benchmark::kMillisecond);
BENCHMARK(WriteToDisk)->Unit(benchmark::kMillisecond);
BENCHMARK(DigestState)->Unit(benchmark::kMillisecond);

}   // namespace
}   // namespace bedload
