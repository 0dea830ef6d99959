#include "app/base/in_parallel.h"

#include <algorithm>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace limpid {

unsigned threads_for(unsigned asked) {
  return asked > 0 ? asked : std::max(1u, std::thread::hardware_concurrency());
}

void in_parallel(std::size_t count, unsigned threads, const Piece& piece) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> over{false};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto take_them = [&] {
    try {
      for (std::size_t i = next++; i < count && !over; i = next++) {
        if (!piece(i, over)) over = true;
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
      over = true;
    }
  };
  {
    std::vector<std::jthread> all;
    for (std::size_t i = 0; i < std::min<std::size_t>(threads, count); ++i) {
      all.emplace_back(take_them);
    }
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace limpid
