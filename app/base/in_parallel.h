// Many pieces of work on several threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>

namespace limpid {

// Returns the number of threads: as asked for, or as many as there are processors.
unsigned threads_for(unsigned asked);

// Work on piece i; `over` says that the rest is not wanted any more. Returning false says the same.
using Piece = std::function<bool(std::size_t i, const std::atomic<bool>& over)>;

// Does pieces 0 to count - 1, which the threads take one after the other. The first that returns
// false ends it. The first exception is thrown again here, once all threads have ended.
void in_parallel(std::size_t count, unsigned threads, const Piece& piece);

}  // namespace limpid
