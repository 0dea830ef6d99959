#include "core/coupling/sfa.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "core/coupling/device_walls.h"
#include "core/coupling/law_at_tip.h"
#include "core/coupling/laws.h"
#include "core/coupling/ledger.h"

namespace limpid {
namespace {

template <int N>
class Sfa final : public Law<N> {
 public:
  void start(const LawStart<N>& at) override {
    x1_ = at.x1;
    asked_ = given_ = Vec<N>::Zero(at.x1.size());
    leave();
    whole_ = false;  // a wall that is pressed already begins soft
  }
  double least_left() const override { return Ledger<N>::kForgiven; }
  Vec<N> step(const LawSettings& p, const LawInput<N>& in, Proxy<N>& proxy) override {
    const HeldContacts<N> walls = walls_.step(in, proxy);
    const Vec<N> moved = in.x1 - x1_;
    x1_ = in.x1;
    share_ = 1;
    const double f = walls.torque.norm();
    if (!(f > 0)) {
      leave();
      return asked_ = walls.torque;
    }
    const Vec<N> along = walls.torque / f;
    const double kappa = soft(p, in, walls);
    follow(f, -along.dot(moved), 1.01 * in.encoder_step * along.template lpNorm<1>() + kStill);
    if (const double at = turned_at(); at > 0) {
      whole_ = false;
      // Motors at their limit would only wind it up.
      if (reached()) {
        offset_ = std::max(0.0, offset_ + p.sfa_step * kappa * (at - (kappa * at + offset_)));
      }
    }
    share_ = whole_ && p.sfa_extended ? 1 : kappa + offset_ / f;
    return asked_ = share_ * walls.torque;
  }
  void applied(const Vec<N>& torque) override { given_ = torque; }
  LawReport report() const override {
    return {.torque_governor = std::min(1.0, share_), .unsettled = walls_.unsettled()};
  }

 private:
  static constexpr double kStill = 1e-6;  // motion that counts as none, with exact encoders [rad]
  static constexpr int kRest = 20;        // ticks at rest until the next increment

  enum class Way : std::uint8_t { into, rests, turns, out };

  void leave() {
    offset_ = depth_ = extreme_ = rest_at_ = deepest_ = 0;
    resting_ = 0;
    way_ = Way::into;
    whole_ = true;
  }
  static double soft(const LawSettings& p, const LawInput<N>& in, const HeldContacts<N>& walls) {
    const double late = in.tick / 2 + p.delay * in.tick;
    double compliance = 0;
    for (Eigen::Index i = 0; i < walls.torque.size(); ++i) {
      const double torque = walls.torque[i];
      if (torque != 0) compliance += torque * torque / in.b_d[i];
    }
    return std::min(1.0, p.sfa_soft * 2 * walls.stored / (late * compliance));
  }
  // Follows the way into the walls, which grew by `into`; motions up to `slack` count as none
  // [rad].
  void follow(double f, double into, double slack) {
    depth_ += into;
    if (way_ == Way::turns || way_ == Way::rests) way_ = Way::out;
    resting_ = std::abs(depth_ - rest_at_) <= slack ? resting_ + 1 : 0;
    if (resting_ == 0) rest_at_ = depth_;
    if (way_ == Way::into) {
      if (depth_ >= extreme_) {
        extreme_ = depth_;
        deepest_ = f;
      } else if (depth_ < extreme_ - slack) {
        way_ = Way::turns;
        extreme_ = depth_;
      }
    } else if (depth_ <= extreme_) {
      extreme_ = depth_;
    } else if (depth_ > extreme_ + slack) {
      way_ = Way::into;
      extreme_ = depth_;
      deepest_ = f;
    }
    if (way_ != Way::turns && resting_ >= kRest) {
      way_ = Way::rests;
      extreme_ = depth_;
      deepest_ = f;
      resting_ = 0;
    }
  }
  // Size of the walls' torque at which an increment is due, else 0 [N m].
  double turned_at() const { return way_ == Way::turns || way_ == Way::rests ? deepest_ : 0; }
  bool reached() const { return (given_ - asked_).norm() <= 1e-6 * asked_.norm(); }

  DeviceWalls<N> walls_;
  Vec<N> x1_;             // last reading [rad]
  Vec<N> asked_, given_;  // last torque, as asked for and as it left [N m]
  double offset_ = 0;     // o [N m]
  double depth_ = 0;      // way into the walls since they were met [rad]
  double extreme_ = 0;    // furthest of it since the last turn [rad]
  double deepest_ = 0;    // the walls' torque there [N m]
  double rest_at_ = 0;    // depth about which it rests [rad]
  int resting_ = 0;       // ticks
  Way way_ = Way::into;
  bool whole_ = true;  // no increment yet: walls may push in full
  double share_ = 1;   // of the walls' torque
};

}  // namespace

TipWall SfaLaw::wall(const LawSettings& p, const LawAtTip& at) {
  const double soft = p.sfa_soft * every_hands_wall(at.tip, at.loop.T, at.loop.delay);
  return {soft, fmt::format("the law's spring is soft: in this grip, at rest, each increment "
                            "leaves a share of {:.2g} of the missing force",
                            1 - p.sfa_step * soft / (soft + at.hand_stiffness))};
}

FeltAtTip SfaLaw::felt(const LawSettings&, const LawAtTip& at, double) { return at.arm_alone(); }

template <int N>
std::unique_ptr<Law<N>> SfaLaw::make() {
  return std::make_unique<Sfa<N>>();
}

template std::unique_ptr<Law<3>> SfaLaw::make();
template std::unique_ptr<Law<7>> SfaLaw::make();
template std::unique_ptr<Law<kAnyDof>> SfaLaw::make();

}  // namespace limpid
