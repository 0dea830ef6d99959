#include "app/run/sampled_wall.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "core/math/eigen.h"
#include "core/math/elementary.h"

namespace limpid {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Motion of a held arm over a tick in which a torque is held: x and v after it from x, v and the
// torque, M v' = -K x - D v + torque. By a Taylor series over a part of the tick that is doubled.
MatrixXd motion_in_a_tick(const HeldArm& arm) {
  const Index n = arm.inertia.rows();
  const MatrixXd mobility = inverse(arm.inertia);
  MatrixXd A = MatrixXd::Zero(3 * n, 3 * n);
  A.block(0, n, n, n).setIdentity();
  A.block(n, 0, n, n) = -mobility * arm.stiffness;
  A.block(n, n, n, n) = -mobility * arm.damping;
  A.block(n, 2 * n, n, n) = mobility;
  A *= arm.T;
  int doublings = 0;
  for (double size = A.cwiseAbs().rowwise().sum().maxCoeff(); size > 0.5; size /= 2) ++doublings;
  A /= std::ldexp(1, doublings);
  MatrixXd step = MatrixXd::Identity(3 * n, 3 * n), term = step;
  for (int k = 1; k < 16; ++k) {
    term = (term * A / k).eval();
    step += term;
  }
  for (int i = 0; i < doublings; ++i) step = (step * step).eval();
  return step.topRows(2 * n);
}

// The device's part of a state: x, v, and the torques on their way, the next to act last.
struct HeldDevice {
  MatrixXd motion;
  Index n, delay;

  explicit HeldDevice(const HeldArm& arm)
      : motion(motion_in_a_tick(arm)), n(arm.inertia.rows()), delay(arm.delay) {}
  Index size() const { return (2 + delay) * n; }
  // State after a tick at whose reading `torque` is sent.
  VectorXd after(const VectorXd& state, const VectorXd& torque) const {
    VectorXd way(size() + n);
    way << state.head(2 * n), torque, state.tail(delay * n);
    VectorXd moved(3 * n), next(size());
    moved << way.head(2 * n), way.tail(n);
    next << motion * moved, way.segment(2 * n, delay * n);
    return next;
  }
};

// Largest growth in a tick of a linear loop, whose step is `after`.
double growth(Index size, const std::function<VectorXd(const VectorXd&)>& after) {
  MatrixXd loop(size, size);
  for (Index i = 0; i < size; ++i) loop.col(i) = after(VectorXd::Unit(size, i));
  return eigenvalues(loop).cwiseAbs().maxCoeff();
}

}  // namespace

double growth_on_device(const HeldArm& arm, const MatrixXd& wall) {
  const HeldDevice device(arm);
  return growth(device.size(),
                [&](const VectorXd& at) { return device.after(at, -wall * at.head(device.n)); });
}

// State of the proxy: x2, v2, its mean velocity over the tick before, and the device's motion in
// that tick.
double growth_behind_spring(const HeldArm& arm, const SpringDamper& g, const MatrixXd& M2,
                            const MatrixXd& wall) {
  const HeldDevice device(arm);
  const Index n = device.n, begin = device.size();
  const double T = arm.T, dampers = g.b_v + g.b_vc + g.k_vc * T / 2;
  const MatrixXd weights = arm.weights.asDiagonal();
  const MatrixXd impedance = 2 / T * M2 + dampers * weights + T / 2 * wall;
  const MatrixXd answer = inverse(impedance);
  return growth(begin + 4 * n, [&](const VectorXd& at) {
    const VectorXd x1 = at.head(n), x2 = at.segment(begin, n), v2 = at.segment(begin + n, n),
                   vbar2 = at.segment(begin + 2 * n, n), v1 = at.tail(n) / T;
    const VectorXd torque = weights * (-g.k_vc * (x1 - x2) - g.b_vc * (v1 - vbar2));
    const VectorXd on_proxy = weights * (g.b_vc * v1 - g.k_vc * (x2 - x1));
    const VectorXd vbar = answer * (2 / T * M2 * v2 + on_proxy - wall * x2);
    const VectorXd moved = device.after(at.head(begin), torque);
    VectorXd next(begin + 4 * n);
    next << moved, x2 + T * vbar, 2 * vbar - v2, vbar, moved.head(n) - x1;
    return next;
  });
}

// State of the observer: its estimate, the velocity and the torques of the two ticks before.
double growth_fed_forward(const HeldArm& arm, const SpringDamper& g, const FedForward& forward,
                          const MatrixXd& M2, const MatrixXd& wall) {
  const HeldDevice device(arm);
  const Index n = device.n, begin = device.size();
  const double T = arm.T, dampers = g.b_v + g.b_vc + g.k_vc * T / 2, eta = forward.eta;
  const MatrixXd one = MatrixXd::Identity(n, n), onto_proxy = forward.phi / eta * wall;
  const MatrixXd weights = arm.weights.asDiagonal();
  const MatrixXd impedance = 2 / T * M2 + dampers * weights + T / 2 * onto_proxy;
  const MatrixXd answer = inverse(impedance);
  // The observer's gain over a tick, 1 - E of core/coupling/force_observer.h.
  constexpr double kPole = 1 - 1 / std::numbers::sqrt2;
  const double a = T * forward.alpha;
  const MatrixXd pole = forward.inertia + kPole * a * one, once = a * inverse(pole);
  const MatrixXd gain = once - kPole * (1 - kPole) * once * once;
  return growth(begin + 8 * n, [&](const VectorXd& at) {
    const auto part = [&](Index i) -> VectorXd { return at.segment(begin + i * n, n); };
    const VectorXd x1 = at.head(n), x2 = part(0), v2 = part(1), vbar2 = part(2), v1 = part(3) / T;
    const VectorXd v_before = part(5);
    const VectorXd hand = forward.inertia * (v1 - v_before) / T +
                          0.5 * (forward.damping.cwiseProduct(v1 + v_before) - part(6) - part(7));
    const VectorXd f1_hat = part(4) + gain * (hand - part(4));
    const VectorXd on_proxy = weights * (g.b_vc * v1 - g.k_vc * (x2 - x1));
    const VectorXd vbar =
        answer * (2 / T * M2 * v2 + on_proxy + forward.phi / eta * f1_hat - onto_proxy * x2);
    const VectorXd f2 = -wall * (x2 + T / 2 * vbar);
    const VectorXd torque = weights * (-g.k_vc * (x1 - x2) - g.b_vc * (v1 - vbar2)) +
                            (1 - eta - forward.phi) / eta * f1_hat + (1 - forward.phi) / eta * f2;
    const VectorXd moved = device.after(at.head(begin), torque);
    VectorXd next(begin + 8 * n);
    next << moved, x2 + T * vbar, 2 * vbar - v2, vbar, moved.head(n) - x1, f1_hat, v1, torque,
        part(6);
    return next;
  });
}

double stable_up_to(const std::function<double(double)>& growth) {
  constexpr int kEach = 4;  // walls tried in a decade
  const auto stable = [&](double K) { return growth(K) < kStillStable; };
  if (!stable(0)) return 0;
  double low = 0;
  for (int i = 0;; ++i) {
    double high = power(10, static_cast<double>(i) / kEach);
    if (high > kStiffestReckoned * 1.001) return std::numeric_limits<double>::infinity();
    if (stable(high)) {
      low = high;
      continue;
    }
    while (high - low > 1e-5 * high) {
      const double middle = (low + high) / 2;
      (stable(middle) ? low : high) = middle;
    }
    return low;
  }
}

}  // namespace limpid
