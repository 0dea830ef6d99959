#include "core/coupling/popc.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/coupling/device_port.h"
#include "core/coupling/device_walls.h"
#include "core/coupling/law_at_tip.h"
#include "core/coupling/laws.h"
#include "core/coupling/ledger.h"

namespace limpid {
namespace {

template <int N>
class Popc final : public Law<N> {
 public:
  void start(const LawStart<N>& at) override {
    fresh_ = true;
    port_.start(at.x1);
    braked_ = 0;
  }
  double least_left() const override { return Ledger<N>::kForgiven; }
  DeviceEstimate<N> locate(const LawSettings&, const LawReading<N>& in) override {
    port_.wait(in.elapsed);
    return {in.x1, in.v1};
  }
  Vec<N> step(const LawSettings& p, const LawInput<N>& in, Proxy<N>& proxy) override {
    const HeldContacts<N> walls = walls_.step(in, proxy);
    const double part = borne(walls.torque, in.limit);
    const Vec<N> held = part * walls.torque;
    const double U = p.popc_reference ? part * (2 - part) * walls.stored : 0;
    const bool ended = port_.read(in);
    if (std::exchange(fresh_, false)) {
      W_ = U;  // what is stored at the start was not given, or the damper would act at once
    } else if (ended) {
      W_ += port_.damped(in.b_d_sure) - port_.sent(p.delay).dot(port_.D());
    }
    // Nothing is hoarded between contacts.
    if (walls.torque.isZero(0) && port_.sent(0).isZero(0)) W_ = std::min(W_, 0.0);
    double S = W_ - U;
    if (!walls.torque.isZero(0)) {
      const Vec<N> moved = port_.moved();
      for (int j = 0; j < p.delay; ++j) S += (held - port_.sent(j)).dot(moved);
      const double ahead = static_cast<double>(p.delay + 1);
      S -= ahead * ahead * walls.spring_work;
    }
    const auto brake = port_.brake(S, p.popc_damping, p.delay, in);
    braked_ = brake.part;
    return held - brake.torque;
  }
  void applied(const Vec<N>& torque) override { port_.applied(torque); }
  LawReport report() const override {
    return {.damping_governor = 1 - braked_, .unsettled = walls_.unsettled()};
  }

 private:
  // Part of the walls' torque that the motors bear. All joints keep to it: clipped one by one they
  // would turn the force, and a way around would give energy. The walls then store as a spring does
  // that is cut off there. A joint without a motor does not count.
  static double borne(const Vec<N>& torque, const Vec<N>& limit) {
    double part = 1;
    for (Eigen::Index i = 0; i < torque.size(); ++i) {
      const double size = std::abs(torque[i]);
      if (limit[i] > 0 && size > limit[i]) part = std::min(part, limit[i] / size);
    }
    return part;
  }

  DeviceWalls<N> walls_;
  bool fresh_ = true;
  double W_ = 0;  // energy that came in [J]
  DevicePort<N> port_;
  double braked_ = 0;  // alpha over its most
};

}  // namespace

TipWall PopcLaw::wall(const LawSettings& p, const LawAtTip& at) {
  return at.on_device(
      braked_wall(at.tip, at.loop, p.popc_damping),
      "the damping of arm and hand, and the law's own damper held for a tick, limit the wall");
}

FeltAtTip PopcLaw::felt(const LawSettings&, const LawAtTip& at, double) { return at.arm_alone(); }

template <int N>
std::unique_ptr<Law<N>> PopcLaw::make() {
  return std::make_unique<Popc<N>>();
}

template std::unique_ptr<Law<3>> PopcLaw::make();
template std::unique_ptr<Law<7>> PopcLaw::make();
template std::unique_ptr<Law<kAnyDof>> PopcLaw::make();

}  // namespace limpid
