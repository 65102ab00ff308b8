// Independent pieces of work, side by side in threads.
#pragma once

#include <cstddef>
#include <functional>

namespace bedload {

/// Calls work(0), work(1), ... work(count - 1), each once and begun in this order, from `cores` threads (0 = as many as the
/// machine has), and returns when all are done. Work must not throw.
void run_in_parallel(std::size_t count, int cores, const std::function<void(std::size_t)>& work);

}   // namespace bedload
