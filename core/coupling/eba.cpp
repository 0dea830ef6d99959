#include "core/coupling/eba.h"

#include <algorithm>
#include <cmath>

#include "core/coupling/device_port.h"
#include "core/coupling/device_walls.h"
#include "core/coupling/law_at_tip.h"
#include "core/coupling/laws.h"

namespace limpid {
namespace {

template <int N>
class Eba final : public Law<N> {
 public:
  void start(const LawStart<N>& at) override {
    E_.fill(0);
    port_.start(at.x1);
    share_ = 1;
  }
  DeviceEstimate<N> locate(const LawSettings&, const LawReading<N>& in) override {
    port_.wait(in.elapsed);
    return {in.x1, in.v1};
  }
  Vec<N> step(const LawSettings& p, const LawInput<N>& in, Proxy<N>& proxy) override {
    const Vec<N> b = believed(p, in);
    const Vec<N> wanted = walls_.step(in, proxy).torque;
    const int most = std::max(p.delay, in.delay_most);
    if (port_.read(in)) {
      const double damped = port_.damped(b);
      for (int d = 0; d <= kMostDelay; ++d) E_[at(d)] += damped - port_.sent(d).dot(port_.D());
    }
    bool on_its_way = false;
    for (int d = 0; d <= most; ++d) on_its_way = on_its_way || !port_.sent(d).isZero(0);
    // Out of walls nothing is saved up. A debt stays until the damping has paid it: a tick that
    // came late held its torque for longer than was paid for.
    if (wanted.isZero(0) && !on_its_way) {
      for (double& energy : E_) energy = std::min(energy, 0.0);
    }
    const double cost = price(wanted, b, in.tick);
    share_ = 1;
    double reserved = 0;
    for (int d = 0; d <= most; ++d) {
      if (d >= p.delay) share_ = std::min(share_, affordable(E_[at(d)] - reserved, cost));
      reserved += price(port_.sent(d), b, in.tick);
    }
    return share_ * wanted;
  }
  void applied(const Vec<N>& torque) override { port_.applied(torque); }
  LawReport report() const override {
    return {.torque_governor = share_, .unsettled = walls_.unsettled()};
  }

 private:
  // Damping that pays [N m s/rad]: as set; of a device whose damping is not sure at most what is
  // known of it.
  static Vec<N> believed(const LawSettings& p, const LawInput<N>& in) {
    if (std::isnan(p.eba_damping)) return in.b_d;
    const Vec<N> set = Vec<N>::Constant(in.b_d.size(), p.eba_damping);
    const bool sure = (in.b_d_sure.array() >= in.b_d.array()).all();
    return sure ? set : Vec<N>(set.cwiseMin(in.b_d));
  }
  static std::size_t at(int delay) { return static_cast<std::size_t>(delay); }
  // Most energy that a torque may give over a tick beyond what the damping b takes [J].
  static double price(const Vec<N>& torque, const Vec<N>& b, double T) {
    double most = 0;
    for (Eigen::Index i = 0; i < torque.size(); ++i) {
      if (torque[i] != 0) most += T * torque[i] * torque[i] / (4 * b[i]);
    }
    return most;
  }
  static double affordable(double energy, double cost) {
    if (cost <= energy || cost == 0) return 1;
    return energy > 0 ? std::sqrt(energy / cost) : 0;
  }
  DeviceWalls<N> walls_;
  std::array<double, kMostDelay + 1> E_{};  // by the torques' delay in ticks [J]
  DevicePort<N> port_;
  double share_ = 1;  // s
};

}  // namespace

TipWall EbaLaw::wall(const LawSettings&, const LawAtTip& at) {
  return {bounded_wall(at.tip, at.loop), "the arm's damping limits the wall: 2 b_d/(T + delay)"};
}

FeltAtTip EbaLaw::felt(const LawSettings&, const LawAtTip& at, double) { return at.arm_alone(); }

template <int N>
std::unique_ptr<Law<N>> EbaLaw::make() {
  return std::make_unique<Eba<N>>();
}

template std::unique_ptr<Law<3>> EbaLaw::make();
template std::unique_ptr<Law<7>> EbaLaw::make();
template std::unique_ptr<Law<kAnyDof>> EbaLaw::make();

}  // namespace limpid
