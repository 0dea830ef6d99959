#include "core/coupling/tank.h"

#include <algorithm>
#include <cmath>

#include "core/coupling/ledger.h"
#include "core/math/solve.h"

namespace limpid {
namespace {

// Largest refill damper, in m/T [-]. Held for a tick of T and driven by the last tick's velocity,
// it would shake the device from 1 on.
constexpr double kMostRefill = 0.2;

// Damping b for which (c - b v) v T is at most `energy` for every v [N m s/rad]; c2 = |c|^2. The
// maximum is c^2 T / (4 b).
double damping_for(double c2, double T, double energy) { return c2 * T / (4 * energy); }

}  // namespace

template <int N>
void DeviceTank<N>::start(const Vec<N>& x1, double energy) {
  in_ = energy;
  out_ = 0;
  spent_.fill(0);
  x1_ = x1;
  dx_ = change_ = Vec<N>::Zero(x1.size());
  still_.fill(0);
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
  // An unchanged reading says nothing.
  for (Eigen::Index i = 0; i < dx.size(); ++i) {
    int& n = still_[static_cast<std::size_t>(i)];
    ++n;
    if (q > 0 && dx[i] == 0) continue;
    in_ += damping[i] * dx[i] * dx[i] / (n * T);
    n = 0;
  }
  out_ = -std::numeric_limits<double>::infinity();
  for (int d = least_; d <= most_; ++d) {
    const auto place = static_cast<std::size_t>(d);
    spent_[place] += torques_[(newest_ + place) % torques_.size()].dot(dx);
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

template <int N>
void TankLaw::Of<N>::start(const LawStart<N>& at) {
  if (at.reserve) {
    left_ = *at.reserve;
  } else if (!fresh_) {
    left_ = device_.energy() + proxy_ + on_its_way() - work2_;
  }
  fresh_ = true;
  owed_ = at.owed;
  takes_over_ = at.takes_over;
  device_.start(at.x1, 0);
  work2_ = sent1_ = got1_ = sent2_ = got2_ = 0;
  freely_ = share_ = 1;
  elapsed_ = 0;
}

// Closes the books of the tick that just ended.
template <int N>
void TankLaw::Of<N>::settle(const Settings& p, const SpringDamper& c, int delay,
                            const LawInput<N>& in, const Proxy<N>& proxy) {
  device_.expect(delay, in.delay_most);
  if (fresh_) {
    if (takes_over_) left_ = in.ledger->reserve();
    const double all = std::min(p.tank_energy, left_), half = std::max(0.0, all / 2);
    // Tanks pay for the spring as it returns, so they get what the hand has put into it.
    const double in_spring =
        takes_over_ ? spring_energy<N>(c.k_vc, in.x1 - proxy.x(), in.limit) : 0;
    device_.start(in.x1, all - half + in_spring);
    proxy_ = half - (owed_ ? proxy.kinetic_energy() + proxy.contact_potential() : 0);
    fresh_ = false;
  } else if (elapsed_ > 0) {
    device_.settle(in.x1, in.b_d_sure, in.encoder_step, elapsed_, p.tank_most);
    proxy_ = std::min(proxy_ - work2_, p.tank_most);
  }
  work2_ = 0;
  if (in.armed_anew) {
    device_.add(std::max(0.0, p.tank_energy / 2 - device_.energy()));
    proxy_ = std::max(proxy_, p.tank_energy / 2);
  }
  reserve_ = device_.energy() + proxy_ + on_its_way();
}

// Moves the proxy. A damper holds its drive back instead of weakening it: a proxy at rest on a wall
// is pressed as hard as ever, which takes no energy. While no torque reaches the motors the hand
// alone moves it, and the tank does not pay.
template <int N>
void TankLaw::Of<N>::move(const Settings& p, const SpringDamper& c, const LawInput<N>& in,
                          const FromDevice<N>& device, Proxy<N>& proxy) {
  const double T = in.T;
  const bool idle = in.authority == 0;
  proxy_ += device.sent - got2_;
  got2_ = device.sent;
  const double surplus = p.tank_share * std::max(0.0, proxy_ - p.tank_energy / 2);
  proxy_ -= surplus;
  sent2_ += surplus;
  Vec<N> drive = c.b_vc * device.v1 - c.k_vc * (proxy.x() - device.x1);
  const double own = c.b_v + c.b_vc + c.k_vc * T / 2;
  double damping = own;
  if (proxy_ > 0 && !idle) {
    damping = std::max(own, damping_for(drive.squaredNorm(), T, proxy_));
  } else if (!idle) {
    drive.setZero();
  }
  proxy.advance(T, {drive, damping});
  work2_ = idle ? 0 : T * proxy.tau().dot(proxy.vbar());
  freely_ = idle || proxy_ > 0 ? own / damping : 0;
}

// Returns the torque on the device's side.
template <int N>
Vec<N> TankLaw::Of<N>::pull(const Settings& p, const SpringDamper& c, const LawInput<N>& in,
                            const FromProxy<N>& proxy) {
  device_.add(proxy.sent - got1_);
  got1_ = proxy.sent;
  const double low = std::clamp(1 - device_.energy() / (p.tank_energy / 2), 0.0, 1.0);
  const double refill = low * std::min(p.tank_damping, kMostRefill / (in.T * (1 + in.delay_most)));
  const Vec<N> wanted = -c.b_vc * (in.v1 - proxy.vbar2) - c.k_vc * (in.x1 - proxy.x2);
  const Vec<N> torque = wanted.cwiseMin(in.limit).cwiseMax(-in.limit);
  share_ = device_.share(torque, in.device.M, in.T);
  return share_ * torque - refill * (in.device.M * in.v1);
}

template <int N>
Vec<N> TankLaw::Of<N>::step(const Settings& p, const SpringDamper& c, int delay,
                            const LawInput<N>& in, Proxy<N>& proxy) {
  settle(p, c, delay, in, proxy);
  FromDevice<N> device = told(in);
  FromProxy<N> here = told(in, proxy);
  const double surplus = p.tank_share * std::max(0.0, device_.energy() - p.tank_energy / 2);
  device_.add(-surplus);
  sent1_ += surplus;
  device.sent = sent1_;
  move(p, c, in, in.link != nullptr ? in.link->to_proxy(device) : device, proxy);
  here.f2 = proxy.f();
  here.sent = sent2_;
  return pull(p, c, in, in.link != nullptr ? in.link->to_device(here) : here);
}

template <int N>
LawReport TankLaw::Of<N>::report() const {
  LawReport report;
  report.reserve = fresh_ ? left_ : reserve_;
  report.contact_governor = freely_;
  report.torque_governor = share_;
  return report;
}

template class TankLaw::Of<3>;
template class TankLaw::Of<7>;
template class TankLaw::Of<kAnyDof>;

}  // namespace limpid
