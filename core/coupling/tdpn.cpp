#include "core/coupling/tdpn.h"

#include <algorithm>
#include <cmath>

#include "core/coupling/device_port.h"
#include "core/coupling/law_at_tip.h"
#include "core/coupling/laws.h"
#include "core/coupling/ledger.h"
#include "core/coupling/spring_coupling.h"

namespace limpid {
namespace {

template <int N>
class Tdpn final : public Law<N> {
 public:
  void start(const LawStart<N>& at) override {
    fresh_ = true;
    came_ = at.x1;
    in1_ = out1_ = in2_ = out2_ = 0;
    braked_ = 0;
    port_.start(at.x1);
  }
  double least_left() const override { return Ledger<N>::kForgiven; }
  DeviceEstimate<N> locate(const LawSettings&, const LawReading<N>& in) override {
    port_.wait(in.elapsed);
    return {in.x1, in.v1};
  }
  Vec<N> step(const LawSettings& p, const LawInput<N>& in, Proxy<N>& proxy) override {
    const bool ended = port_.read(in);
    if (std::exchange(fresh_, false)) {
      x_d_ = proxy.x();
      came_ = in.x1;
    } else if (ended) {
      const double taken = port_.damped(in.b_d) - port_.sent(p.delay).dot(port_.D());
      (taken > 0 ? in1_ : out1_) += std::abs(taken);
    }
    FromDevice<N> device = told(in);
    device.sent = in1_;
    const FromDevice<N>& far = in.link != nullptr ? in.link->to_proxy(device) : device;
    FromProxy<N> here = told(in, proxy);
    here.f2 = move(p, far, in.T, proxy);
    here.sent = in2_;
    const FromProxy<N>& near = in.link != nullptr ? in.link->to_device(here) : here;
    return pull(p, in, near);
  }
  void applied(const Vec<N>& torque) override { port_.applied(torque); }
  LawReport report() const override { return {.damping_governor = 1 - braked_}; }

 private:
  // Moves the proxy by its spring; returns the spring's force [N m].
  Vec<N> move(const LawSettings& p, const FromDevice<N>& far, double T, Proxy<N>& proxy) {
    const double damping = p.k_vc * T / 2 + p.b_vc;
    const Vec<N> x2 = proxy.x();
    const auto spring = [&](const Vec<N>& v) -> Vec<N> {
      return p.k_vc * (x_d_ - x2) + damping * v;
    };
    const double left = std::max(0.0, far.sent - out2_);
    const Vec<N> v_d = (far.x1 - came_) / T;
    const Vec<N> expected = spring(v_d) - damping * proxy.vbar();
    Vec<N> fix = p.tdpn_drift / T * (came_ - x_d_);
    came_ = far.x1;
    if (const double costs = T * expected.dot(fix); costs > 0) {
      const double spare = std::max(0.0, left - std::max(0.0, T * expected.dot(v_d))) / 2;
      fix *= std::min(1.0, spare / costs);
    }
    Vec<N> v = v_d + fix;
    if (const double costs = T * expected.dot(v); costs > left) {
      v -= (costs - left) / (T * expected.squaredNorm()) * expected;
    }
    const Vec<N> constant = spring(v);
    proxy.advance(T, {constant, Vec<N>::Constant(constant.size(), p.b_v + damping)});
    const Vec<N> F2 = constant - damping * proxy.vbar();
    x_d_ += T * v;
    const double given = T * F2.dot(v);
    (given > 0 ? out2_ : in2_) += std::abs(given);
    return F2;
  }
  // Torque on the device, with the damper for what came out too much.
  Vec<N> pull(const LawSettings& p, const LawInput<N>& in, const FromProxy<N>& near) {
    const Vec<N> torque = -near.f2;
    double S = near.sent - out1_ - std::max(0.0, torque.dot(port_.D()));
    for (int j = 0; j < p.delay; ++j) S -= std::max(0.0, port_.sent(j).dot(port_.D()));
    const auto brake = port_.brake(S, p.tdpn_damping, p.delay, in);
    braked_ = brake.part;
    return torque - brake.torque;
  }

  bool fresh_ = true;
  Vec<N> came_;                // the device as the proxy's side knew it last [rad]
  Vec<N> x_d_;                 // where that side wants the proxy [rad]
  double in1_ = 0, out1_ = 0;  // at the device, in all so far [J]
  double in2_ = 0, out2_ = 0;  // at the proxy's spring
  double braked_ = 0;          // alpha over its most
  DevicePort<N> port_;
};

}  // namespace

TipWall TdpnLaw::wall(const LawSettings& p, const LawAtTip& at) {
  TipWall wall = at.through_spring(p.k_vc);
  if (at.link.linked()) wall.bound += "; a longer link delay makes the wall softer";
  return wall;
}

FeltAtTip TdpnLaw::felt(const LawSettings&, const LawAtTip& at, double f) {
  return at.behind_spring(f);
}

template <int N>
std::unique_ptr<Law<N>> TdpnLaw::make() {
  return std::make_unique<Tdpn<N>>();
}

template std::unique_ptr<Law<3>> TdpnLaw::make();
template std::unique_ptr<Law<7>> TdpnLaw::make();
template std::unique_ptr<Law<kAnyDof>> TdpnLaw::make();

}  // namespace limpid
