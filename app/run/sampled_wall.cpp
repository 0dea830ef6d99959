#include "app/run/sampled_wall.h"

#include <cmath>
#include <limits>

#include "core/math/eigen.h"
#include "core/math/elementary.h"

namespace limpid {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Motion of a held tip over a tick in which a force is held: x and v after it from x, v and the
// force, m v' = -k x - b v + force. By a Taylor series over a part of the tick that is doubled.
MatrixXd motion_in_a_tick(const HeldTip& tip) {
  MatrixXd A = MatrixXd::Zero(3, 3);
  A(0, 1) = 1;
  A.row(1) << -tip.stiffness / tip.mass, -tip.damping / tip.mass, 1 / tip.mass;
  A *= tip.T;
  int doublings = 0;
  for (double size = A.cwiseAbs().rowwise().sum().maxCoeff(); size > 0.5; size /= 2) ++doublings;
  A /= std::ldexp(1, doublings);
  MatrixXd step = MatrixXd::Identity(3, 3), term = step;
  for (int k = 1; k < 16; ++k) {
    term = (term * A / k).eval();
    step += term;
  }
  for (int i = 0; i < doublings; ++i) step = (step * step).eval();
  return step.topRows(2);
}

// The device's part of a state after a tick: x and v, and the forces on their way, the next to act
// last.
struct HeldDevice {
  MatrixXd motion;
  Index delay;

  explicit HeldDevice(const HeldTip& tip) : motion(motion_in_a_tick(tip)), delay(tip.delay) {}
  Index size() const { return 2 + delay; }
  VectorXd after(const VectorXd& state, double force) const {
    VectorXd next(size());
    const double acts = delay > 0 ? state[size() - 1] : force;
    next.head<2>() = motion * Eigen::Vector3d(state[0], state[1], acts);
    if (delay > 0) {
      next[2] = force;
      for (Index i = 3; i < size(); ++i) next[i] = state[i - 1];
    }
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

double growth_on_device(const HeldTip& tip, double K) {
  const HeldDevice device(tip);
  return growth(device.size(), [&](const VectorXd& at) { return device.after(at, -K * at[0]); });
}

// State of the proxy: x2, v2, its mean velocity over the tick before, and the device's motion in
// that tick.
double growth_behind_spring(const HeldTip& tip, const SpringDamper& g, double M2, double K) {
  const HeldDevice device(tip);
  const Index n = device.size();
  const double T = tip.T;
  return growth(n + 4, [&](const VectorXd& at) {
    const double x1 = at[0], x2 = at[n], v2 = at[n + 1], vbar2 = at[n + 2], v1 = at[n + 3] / T;
    const double force = -g.k_vc * (x1 - x2) - g.b_vc * (v1 - vbar2);
    const double vbar = (2 / T * M2 * v2 + g.b_vc * v1 - g.k_vc * (x2 - x1) - K * x2) /
                        (2 / T * M2 + g.b_v + g.b_vc + (g.k_vc + K) * T / 2);
    VectorXd next(n + 4);
    next.head(n) = device.after(at.head(n), force);
    next.tail<4>() << x2 + T * vbar, 2 * vbar - v2, vbar, next[0] - x1;
    return next;
  });
}

double stable_up_to(const std::function<double(double)>& growth) {
  constexpr int kEach = 8;  // walls tried in a decade
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
    while (high - low > 1e-6 * high) {
      const double middle = (low + high) / 2;
      (stable(middle) ? low : high) = middle;
    }
    return low;
  }
}

}  // namespace limpid
