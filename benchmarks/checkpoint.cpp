// What a checkpoint costs: five contacts and two cells per grain.
#include <benchmark/benchmark.h>

#include <filesystem>

#include "checkpoint/checkpoint.hpp"
#include "solver/state.hpp"
#include "tests/support/random_state.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

/// As many grains as the benchmark's argument says. The last one asked for is kept.
const State& state_of(const benchmark::State& run) {
  static State state;
  const auto grains = std::size_t(run.range(0));
  if (state.grains.size() != grains)
    state = random_state(
        1, {.grains = grains, .contacts = 5 * grains, .rows = 1'000, .cells = {40, 25, int(grains / 500)}});
  return state;
}

void count_bytes(benchmark::State& run, std::size_t bytes) {
  run.counters["MB"] = double(bytes) / 1e6;
  run.SetBytesProcessed(std::int64_t(bytes) * std::int64_t(run.iterations()));
}

void BuildImage(benchmark::State& run) {
  std::size_t bytes = 0;
  for (auto _ : run) bytes = checkpoint_image(state_of(run)).size();
  count_bytes(run, bytes);
}

void ReadImage(benchmark::State& run) {
  const auto image = checkpoint_image(state_of(run));
  for (auto _ : run) benchmark::DoNotOptimize(state_from_image(image, "image"));
  count_bytes(run, image.size());
}

void ReadHeader(benchmark::State& run) {
  const auto image = checkpoint_image(state_of(run));
  for (auto _ : run) benchmark::DoNotOptimize(header_from_image(image, "image"));
  count_bytes(run, image.size());
}

void WriteToDisk(benchmark::State& run) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "ck-1.h5";
  for (auto _ : run) write_checkpoint(path, state_of(run));
  count_bytes(run, std::filesystem::file_size(path));
}

void DigestState(benchmark::State& run) {
  for (auto _ : run) benchmark::DoNotOptimize(state_digest(state_of(run)));
}

void sizes(benchmark::internal::Benchmark* b) {
  b->Arg(2'000)->Arg(20'000)->Arg(200'000)->Unit(benchmark::kMillisecond);
}
BENCHMARK(BuildImage)->Apply(sizes);
BENCHMARK(ReadImage)->Apply(sizes);
BENCHMARK(ReadHeader)->Apply(sizes);
BENCHMARK(WriteToDisk)->Apply(sizes);
BENCHMARK(DigestState)->Apply(sizes);

}   // namespace
}   // namespace bedload
