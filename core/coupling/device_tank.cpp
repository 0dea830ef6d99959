#include "core/coupling/device_tank.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/coupling/cells.h"
#include "core/math/solve.h"

namespace limpid {

template <int N>
void DeviceTank<N>::start(const Vec<N>& x1, double energy) {
  in_ = energy;
  out_ = 0;
  spent_.fill(0);
  x1_ = z_ = x1;
  dx_ = change_ = Vec<N>::Zero(x1.size());
  torques_.fill(dx_);
}

template <int N>
void DeviceTank<N>::expect(int least, int most) {
  if (least == least_ && most == most_) return;
  spent_.fill(out_);
  least_ = least;
  most_ = most;
}

template <int N>
void DeviceTank<N>::settle(const Vec<N>& x1, const Vec<N>& damping, double q, double T,
                           double most) {
  const Vec<N> dx = x1 - x1_;
  change_ = dx - dx_;
  dx_ = dx;
  x1_ = x1;
  in_ += sure_loss<N>(damping, dx, q, T);
  const Vec<N> z = within_cells<N>(x1, -dx / 2, q), dz = z - z_;
  z_ = z;
  out_ = -std::numeric_limits<double>::infinity();
  for (int d = least_; d <= most_; ++d) {
    const auto place = static_cast<std::size_t>(d);
    spent_[place] += torques_[(newest_ + place) % torques_.size()].dot(dz);
    out_ = std::max(out_, spent_[place]);
  }
  in_ = std::min(in_, out_ + most);
}

template <int N>
void DeviceTank<N>::sent(const Vec<N>& torque) {
  newest_ = (newest_ + torques_.size() - 1) % torques_.size();
  torques_[newest_] = torque;
}

template <int N>
double DeviceTank<N>::share(const Vec<N>& torque, const Mat<N>& M, double T) const {
  const auto spends = [&](const Vec<N>& tau) {
    return std::max({0.0, tau.dot(dx_), tau.dot(dx_ + change_)});
  };
  double has = energy();
  for (int d = 0; d < most_; ++d) {
    has -= spends(torques_[(newest_ + static_cast<std::size_t>(d)) % torques_.size()]);
  }
  if (!(has > 0)) return 0;
  const double along = spends(torque), n = 1 + most_;
  const double alone = n * n * T * T / 2 * torque.dot(solve_symmetric<N>(M, torque));
  if (along + alone <= has) return 1;
  // Solves s along + s^2 alone = has.
  return 2 * has / (along + std::sqrt(along * along + 4 * alone * has));
}

template class DeviceTank<3>;
template class DeviceTank<7>;
template class DeviceTank<kAnyDof>;

}  // namespace limpid
