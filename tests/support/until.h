// Waits of tests for what another thread or program does. A busy machine may take long.
#pragma once

#include <chrono>
#include <thread>

namespace limpid::test {

// Calls between() until done() is true, for a minute at most. Returns the last done().
template <class Done, class Between>
bool until(Done done, Between between) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (std::chrono::steady_clock::now() < end) {
    if (done()) return true;
    between();
  }
  return done();
}

template <class Done>
bool until(Done done) {
  return until(done, [] { std::this_thread::sleep_for(std::chrono::milliseconds(1)); });
}

}  // namespace limpid::test
