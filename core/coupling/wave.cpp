#include "core/coupling/wave.h"

#include <algorithm>
#include <cmath>

#include "core/coupling/device_port.h"
#include "core/coupling/law_at_tip.h"
#include "core/coupling/laws.h"
#include "core/coupling/played_waves.h"
#include "core/coupling/spring_coupling.h"

namespace limpid {
namespace {

template <int N>
class Wave final : public Law<N> {
 public:
  void start(const LawStart<N>& at) override {
    const Eigen::Index n = at.x1.size();
    const Vec<N> zero = Vec<N>::Zero(n);
    fresh_ = true;
    v1_ = w_ = zero;
    debt_ = 0;
    number_ = 0;
    port_.start(at.x1);
    from_device_ = from_proxy_ = {-1, zero, 0};
    at_proxy_.start(n);
    at_device_.start(n);
  }
  DeviceEstimate<N> locate(const LawSettings&, const LawReading<N>& in) override {
    port_.wait(in.elapsed);
    return {in.x1, in.v1};
  }
  Vec<N> step(const LawSettings& p, const LawInput<N>& in, Proxy<N>& proxy) override {
    const double b = p.line(), r = std::sqrt(2 * b);
    const double beside = p.wave_matched ? b : 0;
    send(p, in, beside, r);
    authority_ = in.authority;
    if (std::exchange(fresh_, false)) x_d_ = proxy.x();
    const double due = number_ - (in.link != nullptr ? in.link->wave_delay() : 0);

    FromDevice<N> device = told(in);
    device.number = from_device_.number = number_;
    device.waves = from_device_.waves;
    device.sent = from_device_.energy;
    const FromDevice<N>& far = in.link != nullptr ? in.link->to_proxy(device) : device;
    FromProxy<N> here = told(in, proxy);
    const Vec<N> u = at_proxy_.play({far.number, far.waves, far.sent}, due, in.T);
    move(p, u, b, r, in.T, proxy);
    here.number = from_proxy_.number = number_;
    here.waves = from_proxy_.waves;
    here.sent = from_proxy_.energy;
    const FromProxy<N>& near = in.link != nullptr ? in.link->to_device(here) : here;
    w_ = at_device_.play({near.number, near.waves, near.sent}, due, in.T);
    number_ += 1;
    return r * w_ - (b + beside) * v1_;
  }
  void applied(const Vec<N>& torque) override { port_.applied(torque); }

 private:
  // The wave that leaves the device after the tick just ended.
  void send(const LawSettings& p, const LawInput<N>& in, double beside, double r) {
    if (!port_.read(in)) return;
    const double T = port_.elapsed();
    const Vec<N>&D = port_.D(), &acted = port_.sent(p.delay);
    double energy = T / 2 * w_.squaredNorm() - (acted + authority_ * beside * v1_).dot(D) - debt_;
    if (energy < 0) {  // the device's own damping pays, as far as it is known
      energy = std::min(0.0, energy + in.b_d.dot(D.cwiseAbs2()) / T);
    }
    debt_ = std::max(0.0, -energy);
    Vec<N> u = r * D / T - w_;
    const double most = std::sqrt(std::max(0.0, 2 * energy / T));
    if (u.norm() > most) u *= most / u.norm();
    from_device_.add(u, T);
    v1_ = D / T;
  }
  // Spring and line at the proxy, at the midpoint of the tick.
  void move(const LawSettings& p, const Vec<N>& u, double b, double r, double T, Proxy<N>& proxy) {
    const double s = (p.k_vc * T / 2 + b) / b, damping = s * b / (1 + s);
    const Vec<N> constant = (p.k_vc * (x_d_ - proxy.x()) + s * r * u) / (1 + s);
    proxy.advance(T, {constant, Vec<N>::Constant(constant.size(), p.b_v + damping)});
    const Vec<N> F2 = constant - damping * proxy.vbar();
    x_d_ += T * (r * u - F2) / b;
    from_proxy_.add(u - r / b * F2, T);
  }

  bool fresh_ = true;
  Vec<N> v1_;             // velocity held [rad/s]
  Vec<N> w_;              // wave at the device over the last tick [sqrt(W)]
  Vec<N> x_d_;            // where the waves want the proxy [rad]
  double authority_ = 1;  // share of the last torque that reached the motors
  double debt_ = 0;       // [J]
  double number_ = 0;     // ticks since the start
  DevicePort<N> port_;
  WaveSums<N> from_device_, from_proxy_;
  PlayedWaves<N> at_proxy_, at_device_;
};

}  // namespace

TipWall WaveLaw::wall(const LawSettings& p, const LawAtTip& at) {
  return {line_at_tip(at.tip, p.k_vc, p.line(), (at.link.oldest() + 0.5) * at.loop.T),
          "the wall is felt through the spring k_vc and the line: 1/(1/k_vc + (link + T/2)/b)"};
}

FeltAtTip WaveLaw::felt(const LawSettings& p, const LawAtTip& at, double) {
  // The line adds a mass where it is not matched, and its own damper.
  const double line = p.line() / at.tip.lever2, b_v = at.felt.b_v;
  const double mass = at.link.oldest() * at.loop.T * (line - b_v * b_v / line);
  return {at.tip.led + mass, at.tip.damping + b_v + (p.wave_matched ? line : 0)};
}

template <int N>
std::unique_ptr<Law<N>> WaveLaw::make() {
  return std::make_unique<Wave<N>>();
}

template std::unique_ptr<Law<3>> WaveLaw::make();
template std::unique_ptr<Law<7>> WaveLaw::make();
template std::unique_ptr<Law<kAnyDof>> WaveLaw::make();

}  // namespace limpid
