#include "core/coupling/popc.h"

#include <algorithm>

#include "core/coupling/device_walls.h"
#include "core/coupling/laws.h"
#include "core/coupling/ledger.h"

namespace limpid {
namespace {

template <int N>
class Popc final : public Law<N> {
 public:
  void start(const LawStart<N>& at) override {
    x1_ = at.x1;
    fresh_ = true;
    sent_.fill(Vec<N>::Zero(at.x1.size()));
    braked_ = 0;
  }
  double least_left() const override { return Ledger<N>::kForgiven; }
  DeviceEstimate<N> locate(const LawSettings&, const LawReading<N>& in) override {
    elapsed_ = in.elapsed;
    return {in.x1, in.v1};
  }
  Vec<N> step(const LawSettings& p, const LawInput<N>& in, Proxy<N>& proxy) override {
    const HeldContacts<N> walls = walls_.step(in, proxy);
    const auto d = static_cast<std::size_t>(p.delay);
    const Vec<N> D = in.x1 - x1_;
    x1_ = in.x1;
    const double U = p.popc_reference ? walls.stored : 0;
    if (std::exchange(fresh_, false)) {
      W_ = U;  // what is stored at the start was not given, or the damper would act at once
    } else if (elapsed_ > 0) {
      const Vec<N> sure = (D.cwiseAbs().array() - in.encoder_step).max(0);
      W_ += in.b_d_sure.dot(sure.cwiseAbs2()) / elapsed_ - sent_[d].dot(D);
    }
    // Nothing is hoarded between contacts.
    if (walls.torque.isZero(0) && sent_[0].isZero(0)) W_ = std::min(W_, 0.0);
    braked_ = 0;
    const Vec<N> moved = (D.array().abs() > 1.5 * in.encoder_step).select(D, 0);
    const Vec<N> momentum = in.device.M * moved;
    const double action = momentum.dot(moved);  // T^2 v.M1 v
    double S = W_ - U;
    if (!walls.torque.isZero(0)) {
      for (std::size_t j = 0; j < d; ++j) S += (walls.torque - sent_[j]).dot(moved);
      const double ahead = static_cast<double>(p.delay + 1);
      S -= ahead * ahead * walls.spring_work;
    }
    if (!(S < 0) || !(action > 0)) return walls.torque;
    const double T = in.tick, most = p.popc_damping / (T * (1 + p.delay));
    const double alpha = std::min(-S * T / action, most);
    braked_ = alpha / most;
    return walls.torque - alpha / T * momentum;
  }
  void applied(const Vec<N>& torque) override {
    std::ranges::rotate(sent_, sent_.end() - 1);
    sent_[0] = torque;
  }
  LawReport report() const override {
    return {.damping_governor = 1 - braked_, .unsettled = walls_.unsettled()};
  }

 private:
  DeviceWalls<N> walls_;
  Vec<N> x1_;
  bool fresh_ = true;
  double elapsed_ = 0;                       // since the previous reading [s]
  double W_ = 0;                             // energy that came in [J]
  std::array<Vec<N>, kMostDelay + 1> sent_;  // torques that left, the last one first [N m]
  double braked_ = 0;                        // alpha over its most
};

}  // namespace

template <int N>
std::unique_ptr<Law<N>> PopcLaw::make() {
  return std::make_unique<Popc<N>>();
}

template std::unique_ptr<Law<3>> PopcLaw::make();
template std::unique_ptr<Law<7>> PopcLaw::make();
template std::unique_ptr<Law<kAnyDof>> PopcLaw::make();

}  // namespace limpid
