// Many pieces of work on several threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>

namespace limpid {

// As many threads as there are processors, where none are asked for.
unsigned threads_for(unsigned asked);

// Work on piece i; `over` says that the rest is not wanted any more. False: nor is it for this one.
using Piece = std::function<bool(std::size_t i, const std::atomic<bool>& over)>;

// Pieces 0 to count - 1, which the threads take one after the other. The first that returns false
// ends it; what the first one threw is thrown here, once all threads have ended.
void in_parallel(std::size_t count, unsigned threads, const Piece& piece);

}  // namespace limpid
