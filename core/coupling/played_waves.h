// Waves that come in packets with their sums, played out a fixed time after they were sent.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/math/sizes.h"

namespace limpid {

// Sums since the start, with the number of the tick in which they were sent.
template <int N>
struct WaveSums {
  double number = -1;
  Vec<N> waves;       // of u T [sqrt(W) s]
  double energy = 0;  // of u.u T/2 [J]

  void add(const Vec<N>& u, double T) {
    waves += T * u;
    energy += T / 2 * u.squaredNorm();
  }
};

template <int N>
class PlayedWaves {
 public:
  void start(Eigen::Index joints) {
    count_ = 1;
    known_[0] = {-1, Vec<N>::Zero(joints), 0};
    played_ = {0, Vec<N>::Zero(joints), 0};
  }
  // Takes the newest sums that came; returns the wave of a tick of T [s] in which that of number
  // `due` is to be played: evenly between known sums, and never more energy than came.
  Vec<N> play(const WaveSums<N>& newest, double due, double T) {
    if (newest.number > known_[count_ - 1].number) {
      if (count_ == known_.size()) drop(1);
      known_[count_++] = newest;
    }
    std::size_t past = 0;
    while (past + 1 < count_ && known_[past + 1].number <= due) ++past;
    drop(past);
    WaveSums<N> now = known_[0];
    if (count_ > 1 && due > now.number) {
      const WaveSums<N>& next = known_[1];
      const double part = (due - now.number) / (next.number - now.number);
      now.waves += part * (next.waves - now.waves);
      now.energy += part * (next.energy - now.energy);
    }
    Vec<N> u = (now.waves - played_.waves) / T;
    const double most = std::sqrt(std::max(0.0, 2 * (now.energy - played_.energy) / T));
    if (u.norm() > most) u *= most / u.norm();
    played_.add(u, T);
    return u;
  }

 private:
  // Ticks of delay, jitter and spare together, and some.
  static constexpr std::size_t kMost = 400;

  void drop(std::size_t oldest) {
    if (oldest == 0) return;
    for (std::size_t i = oldest; i < count_; ++i) known_[i - oldest] = known_[i];
    count_ -= oldest;
  }

  std::array<WaveSums<N>, kMost> known_;  // by number, the first one at or before what is due
  std::size_t count_ = 1;
  WaveSums<N> played_;
};

}  // namespace limpid
