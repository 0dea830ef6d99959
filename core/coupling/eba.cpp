#include "core/coupling/eba.h"

#include <algorithm>
#include <cmath>

#include "core/coupling/device_walls.h"
#include "core/coupling/laws.h"

namespace limpid {
namespace {

template <int N>
class Eba final : public Law<N> {
 public:
  void start(const LawStart<N>& at) override {
    x1_ = at.x1;
    fresh_ = true;
    E_.fill(0);
    sent_.fill(Vec<N>::Zero(at.x1.size()));
    share_ = 1;
  }
  DeviceEstimate<N> locate(const LawSettings&, const LawReading<N>& in) override {
    elapsed_ = in.elapsed;
    return {in.x1, in.v1};
  }
  Vec<N> step(const LawSettings& p, const LawInput<N>& in, Proxy<N>& proxy) override {
    const Vec<N> b = believed(p, in);
    const Vec<N> wanted = walls_.step(in, proxy).torque;
    const int most = std::max(p.delay, in.delay_most);
    book(in, b);
    const bool on_its_way = std::any_of(sent_.begin(), sent_.begin() + most + 1,
                                        [](const Vec<N>& t) { return !t.isZero(0); });
    if (wanted.isZero(0) && !on_its_way) E_.fill(0);
    const double cost = price(wanted, b, in.tick);
    share_ = 1;
    double reserved = 0;
    for (int d = 0; d <= most; ++d) {
      if (d >= p.delay) share_ = std::min(share_, affordable(E_[at(d)] - reserved, cost));
      reserved += price(sent_[at(d)], b, in.tick);
    }
    return share_ * wanted;
  }
  void applied(const Vec<N>& torque) override {
    std::ranges::rotate(sent_, sent_.end() - 1);
    sent_[0] = torque;
  }
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
  // Books the tick just ended, for every delay.
  void book(const LawInput<N>& in, const Vec<N>& b) {
    const Vec<N> D = in.x1 - x1_;
    x1_ = in.x1;
    if (std::exchange(fresh_, false) || !(elapsed_ > 0)) return;
    // A reading that changes by a step may be no motion.
    const Vec<N> sure = (D.cwiseAbs().array() - in.encoder_step).max(0);
    const double damped = b.dot(sure.cwiseAbs2()) / elapsed_;
    for (std::size_t d = 0; d < E_.size(); ++d) E_[d] += damped - sent_[d].dot(D);
  }

  DeviceWalls<N> walls_;
  Vec<N> x1_;
  bool fresh_ = true;
  double elapsed_ = 0;                       // since the previous reading [s]
  std::array<double, kMostDelay + 1> E_{};   // by the torques' delay in ticks [J]
  std::array<Vec<N>, kMostDelay + 1> sent_;  // torques that left, the last one first [N m]
  double share_ = 1;                         // s
};

}  // namespace

template <int N>
std::unique_ptr<Law<N>> EbaLaw::make() {
  return std::make_unique<Eba<N>>();
}

template std::unique_ptr<Law<3>> EbaLaw::make();
template std::unique_ptr<Law<7>> EbaLaw::make();
template std::unique_ptr<Law<kAnyDof>> EbaLaw::make();

}  // namespace limpid
