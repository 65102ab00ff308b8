// What the machine can do at best, one core: the two lines of a roofline. Multiplications and additions apart, as the kernels
// are compiled (no fused operations), at both widths of vector; and bytes per second from each level of memory.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <vector>

namespace {

template <class Number, int bytes>
using Vector [[gnu::vector_size(bytes)]] = Number;

constexpr int rounds = 1000;

/// Ten chains of x = x a + b: enough to hide the latency of both.
template <class Number, int bytes>
[[gnu::always_inline]] inline void chains(Vector<Number, bytes> (&result)[10]) {
  const Vector<Number, bytes> a = Vector<Number, bytes>{} + Number(0.999), b = Vector<Number, bytes>{} + Number(0.001);
  Vector<Number, bytes> x[10] = {};
  for (int n = 0; n < rounds; ++n)
#pragma GCC unroll 10
    for (int chain = 0; chain < 10; ++chain) {
      x[chain] = x[chain] * a + b;
      asm volatile("" : "+v"(x[chain]));   // stays in its register, and is not folded
    }
  for (int chain = 0; chain < 10; ++chain) result[chain] = x[chain];
}

template <class Number>
[[gnu::noinline]] void chains_avx2(Vector<Number, 32> (&x)[10]) {
  chains<Number, 32>(x);
}

template <class Number>
[[gnu::noinline, gnu::target("avx512f,avx512vl,prefer-vector-width=512")]] void chains_avx512(
    Vector<Number, 64> (&x)[10]) {
  chains<Number, 64>(x);
}

void count_operations(benchmark::State& run, std::size_t lanes) {
  run.counters["operations/s"] =
      benchmark::Counter(double(2 * 10 * rounds * lanes), benchmark::Counter::kIsIterationInvariantRate);
}

template <class Number>
void multiply_add_avx2(benchmark::State& run) {
  Vector<Number, 32> x[10] = {};
  for (auto _ : run) chains_avx2<Number>(x), benchmark::DoNotOptimize(x);
  count_operations(run, 32 / sizeof(Number));
}

template <class Number>
void multiply_add_avx512(benchmark::State& run) {
  if (!__builtin_cpu_supports("avx512f") || !__builtin_cpu_supports("avx512vl")) {
    run.SkipWithError("this processor has no AVX-512");
    return;
  }
  Vector<Number, 64> x[10] = {};
  for (auto _ : run) chains_avx512<Number>(x), benchmark::DoNotOptimize(x);
  count_operations(run, 64 / sizeof(Number));
}

/// a = b + s c (McCalpin's STREAM triad) over three arrays of together as many KiB as the argument says. Bytes are those that the
/// loop names: what is read before it is overwritten comes on top where it misses the caches.
void triad(benchmark::State& run) {
  const auto n = std::size_t(run.range(0)) * 1024 / (3 * sizeof(double));
  std::vector<double> a(n, 0), b(n, 1), c(n, 2);
  for (auto _ : run) {
    for (std::size_t i = 0; i < n; ++i) a[i] = b[i] + 0.5 * c[i];
    benchmark::ClobberMemory();
  }
  run.counters["bytes/s"] =
      benchmark::Counter(double(3 * sizeof(double) * n), benchmark::Counter::kIsIterationInvariantRate);
}

/// a = s - a over one array of as many KiB: what is read is what is written.
void update(benchmark::State& run) {
  const auto n = std::size_t(run.range(0)) * 1024 / sizeof(double);
  std::vector<double> a(n, 1);
  for (auto _ : run) {
    for (double& x : a) x = 0.5 - x;
    benchmark::ClobberMemory();
  }
  run.counters["bytes/s"] =
      benchmark::Counter(double(2 * sizeof(double) * n), benchmark::Counter::kIsIterationInvariantRate);
}

BENCHMARK_TEMPLATE(multiply_add_avx2, float);
BENCHMARK_TEMPLATE(multiply_add_avx2, double);
BENCHMARK_TEMPLATE(multiply_add_avx512, float);
BENCHMARK_TEMPLATE(multiply_add_avx512, double);
void levels(benchmark::internal::Benchmark* b) { b->ArgName("KiB")->Arg(24)->Arg(768)->Arg(4 * 1024)->Arg(300 * 1024); }
BENCHMARK(triad)->Apply(levels);
BENCHMARK(update)->Apply(levels);

}   // namespace
