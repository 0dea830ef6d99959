#include "core/coupling/tank.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/coupling/device_tank.h"
#include "core/coupling/law_at_tip.h"
#include "core/coupling/laws.h"
#include "core/coupling/ledger.h"
#include "core/coupling/spring_coupling.h"

namespace limpid {
namespace {

// Largest refill damper, in m/T [-]. Held for a tick of T and driven by the last tick's velocity,
// it would shake the device from 1 on.
constexpr double kMostRefill = 0.2;

// Damping b for which (c - b v) v T is at most `energy` for every v [N m s/rad]; c2 = |c|^2. The
// maximum is c^2 T / (4 b).
double damping_for(double c2, double T, double energy) { return c2 * T / (4 * energy); }

template <int N>
class Tank final : public Law<N> {
 public:
  void start(const LawStart<N>& at) override;
  DeviceEstimate<N> locate(const LawSettings&, const LawReading<N>& in) override {
    elapsed_ = in.elapsed;
    return {in.x1, in.v1};
  }
  Vec<N> step(const LawSettings& p, const LawInput<N>& in, Proxy<N>& proxy) override;
  void applied(const Vec<N>& torque) override { device_.sent(torque); }
  LawReport report() const override;
  double least_left() const override { return -std::numeric_limits<double>::infinity(); }

 private:
  using Settings = TankLaw::Settings;
  void settle(const Settings& p, const SpringDamper& c, int delay, const LawInput<N>& in,
              const Proxy<N>& proxy);
  void move(const Settings& p, const SpringDamper& c, const LawInput<N>& in,
            const FromDevice<N>& device, Proxy<N>& proxy);
  Vec<N> pull(const Settings& p, const SpringDamper& c, const LawInput<N>& in,
              const FromProxy<N>& proxy);
  double on_its_way() const { return (sent1_ - got2_) + (sent2_ - got1_); }

  DeviceTank<N> device_;
  double proxy_ = 0;             // energy in the tank of the proxy's side [J]
  double work2_ = 0;             // work of tau2 over the last tick [J]
  double sent1_ = 0, got2_ = 0;  // energy from device to proxy, in all so far [J]
  double sent2_ = 0, got1_ = 0;  // energy from proxy to device
  double reserve_ = 0;           // energy in both tanks and between them when the tick began [J]
  double left_ = std::numeric_limits<double>::infinity();  // of an earlier part of the run [J]
  double stored_ = 0;  // in proxy and walls when the tick began [J]
  bool idle_ = false;  // no torque reached the motors in the last tick
  bool fresh_ = true, takes_over_ = false;
  Owed owed_{};         // see LawStart
  double elapsed_ = 0;  // since the previous reading; 0 at the first [s]
  double freely_ = 1;   // the proxy's damping over that with its tank's damper [-]
  double share_ = 1;    // share of the device's torque [-]
};

template <int N>
void Tank<N>::start(const LawStart<N>& at) {
  if (at.reserve) {
    left_ = *at.reserve;
  } else if (!fresh_) {
    left_ = device_.energy() + proxy_ + on_its_way() - (idle_ ? 0 : work2_);
  }
  owed_ = fresh_ ? after_unused(owed_, at.owed) : at.owed;
  fresh_ = true;
  takes_over_ = at.takes_over;
  device_.start(at.x1, 0);
  work2_ = sent1_ = got1_ = sent2_ = got2_ = 0;
  freely_ = share_ = 1;
  elapsed_ = 0;
}

// Closes the books of the tick that just ended.
template <int N>
void Tank<N>::settle(const Settings& p, const SpringDamper& c, int delay, const LawInput<N>& in,
                     const Proxy<N>& proxy) {
  device_.expect(delay, in.delay_most);
  const double stored = proxy.kinetic_energy() + proxy.contact_potential();
  const double added = stored - std::exchange(stored_, stored);
  if (fresh_) {
    if (takes_over_) left_ = in.ledger->reserve();
    const double all = std::min(p.tank_energy, left_), half = std::max(0.0, all / 2);
    // Tanks pay for the spring as it returns, so they get what the hand has put into it.
    const double in_spring =
        takes_over_ ? spring_energy<N>(springs(c, in.b_d), in.x1 - proxy.x(), in.limit) : 0;
    device_.start(in.x1, all - half + in_spring);
    proxy_ = half - debt_of(owed_, stored, added);
    fresh_ = false;
  } else if (elapsed_ > 0) {
    device_.settle(in.x1, in.b_d_sure, in.encoder_step, elapsed_, p.tank_most);
    proxy_ = std::min(proxy_ - (idle_ ? added : work2_), p.tank_most);
  }
  work2_ = 0;
  if (in.armed_anew) {
    device_.add(std::max(0.0, p.tank_energy / 2 - device_.energy()));
    proxy_ = std::max(proxy_, p.tank_energy / 2 - stored);
  }
  reserve_ = device_.energy() + proxy_ + on_its_way();
}

// Moves the proxy. A damper holds its drive back instead of weakening it: a proxy at rest on a wall
// is pressed as hard as ever, which takes no energy. While no torque reaches the motors it follows
// the hand whatever the tank has; what proxy and walls store meanwhile is a debt of the tank.
template <int N>
void Tank<N>::move(const Settings& p, const SpringDamper& c, const LawInput<N>& in,
                   const FromDevice<N>& device, Proxy<N>& proxy) {
  const double T = in.T;
  const bool idle = idle_ = in.authority == 0;
  proxy_ += device.sent - got2_;
  got2_ = device.sent;
  const double surplus = p.tank_share * std::max(0.0, proxy_ - p.tank_energy / 2);
  proxy_ -= surplus;
  sent2_ += surplus;
  const Vec<N> weights = gain_weights(c, in.b_d);
  Vec<N> drive = weights.cwiseProduct(c.b_vc * device.v1 - c.k_vc * (proxy.x() - device.x1));
  const double own = c.b_v + c.b_vc + c.k_vc * T / 2;
  double damping = own;
  if (proxy_ > 0 && !idle) {
    damping = std::max(own, damping_for(drive.squaredNorm(), T, proxy_));
  } else if (!idle) {
    drive.setZero();
  }
  proxy.advance(T, {drive, (own * weights).cwiseMax(damping)});
  work2_ = T * proxy.tau().dot(proxy.vbar());
  freely_ = idle || proxy_ > 0 ? own / damping : 0;
}

// Returns the torque on the device's side.
template <int N>
Vec<N> Tank<N>::pull(const Settings& p, const SpringDamper& c, const LawInput<N>& in,
                     const FromProxy<N>& proxy) {
  device_.add(proxy.sent - got1_);
  got1_ = proxy.sent;
  const double low = std::clamp(1 - device_.energy() / (p.tank_energy / 2), 0.0, 1.0);
  const double refill = low * std::min(p.tank_damping, kMostRefill / (in.T * (1 + in.delay_most)));
  const Vec<N> pull = -c.b_vc * (in.v1 - proxy.vbar2) - c.k_vc * (in.x1 - proxy.x2);
  const Vec<N> wanted = gain_weights(c, in.b_d).cwiseProduct(pull);
  const Vec<N> torque = wanted.cwiseMin(in.limit).cwiseMax(-in.limit);
  share_ = device_.share(torque, in.device.M, in.T);
  return share_ * torque - refill * (in.device.M * in.v1);
}

template <int N>
Vec<N> Tank<N>::step(const LawSettings& p, const LawInput<N>& in, Proxy<N>& proxy) {
  settle(p, p, p.delay, in, proxy);
  FromDevice<N> device = told(in);
  FromProxy<N> here = told(in, proxy);
  const double surplus = p.tank_share * std::max(0.0, device_.energy() - p.tank_energy / 2);
  device_.add(-surplus);
  sent1_ += surplus;
  device.sent = sent1_;
  move(p, p, in, in.link != nullptr ? in.link->to_proxy(device) : device, proxy);
  here.f2 = proxy.f();
  here.sent = sent2_;
  return pull(p, p, in, in.link != nullptr ? in.link->to_device(here) : here);
}

template <int N>
LawReport Tank<N>::report() const {
  LawReport report;
  report.reserve = fresh_ ? left_ : reserve_;
  report.contact_governor = freely_;
  report.torque_governor = share_;
  return report;
}

}  // namespace

TipWall TankLaw::wall(const LawSettings& p, const LawAtTip& at) {
  return at.through_spring(p.k_vc);
}

FeltAtTip TankLaw::felt(const LawSettings&, const LawAtTip& at, double f) {
  return at.behind_spring(f);
}

template <int N>
std::unique_ptr<Law<N>> TankLaw::make() {
  return std::make_unique<Tank<N>>();
}

template std::unique_ptr<Law<3>> TankLaw::make();
template std::unique_ptr<Law<7>> TankLaw::make();
template std::unique_ptr<Law<kAnyDof>> TankLaw::make();

}  // namespace limpid
