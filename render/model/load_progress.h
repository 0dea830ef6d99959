// How far a load has come, and whether it is still wanted.
#pragma once

#include <atomic>
#include <stdexcept>

namespace limpid {

// Either may be null.
struct LoadProgress {
  std::atomic<double>* part = nullptr;        // 0 to 1
  const std::atomic<bool>* cancel = nullptr;  // asked several times a second
};

struct LoadCancelled : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Throws LoadCancelled.
inline void check_wanted(const LoadProgress& progress) {
  if (progress.cancel && progress.cancel->load()) throw LoadCancelled("loading was cancelled");
}

}  // namespace limpid
