#include "studies/run_in_parallel.hpp"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace bedload {

void run_in_parallel(std::size_t count, int cores, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  const auto work_on = [&] {
    for (std::size_t n; (n = next++) < count;) work(n);
  };
  const std::size_t all = std::max(1u, std::thread::hardware_concurrency());
  const std::size_t threads = std::min(cores > 0 ? static_cast<std::size_t>(cores) : all, count);
  std::vector<std::jthread> others;
  for (std::size_t n = 1; n < threads; ++n) others.emplace_back(work_on);
  work_on();
}

}   // namespace bedload
