#include "app/experiments/link_theory.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "app/experiments/tap_bench.h"

namespace limpid {

LinkTheory::LinkTheory(const ExperimentArm& on, double grip)
    : grip_(grip),
      p_(on.settings),
      tip_(tip_at_table(on)),
      at_(arm_at(on.description, rest_at(on.description, Vec3(0.2, 0, TapBench::kSurface)).x1)),
      b_d_(device_damping(on.description, p_)) {}

// Longer delays open windows of stability again, each a pose away from its end: they do not count.
double LinkTheory::standard(int delay) const {
  double wall = kStiffest;
  for (int shorter = 0; shorter <= delay && wall > kSoftest; ++shorter) {
    if (!stable(wall, shorter)) wall = stiffest_up_to(wall, shorter);
  }
  return wall;
}

double LinkTheory::stiffest_up_to(double unstable, int delay) const {
  if (!stable(kSoftest, delay)) return kSoftest;
  double low = kSoftest, high = unstable;
  for (int i = 0; i < 8; ++i) {
    const double middle = std::sqrt(low * high);
    (stable(middle, delay) ? low : high) = middle;
  }
  return low;
}

double LinkTheory::proposed(int delay) const {
  if (!stable(kSoftest, delay)) return kSoftest;
  const double wall = proposed_wall(tip_, {.T = p_.tick,
                                           .k_vc = p_.k_vc,
                                           .b_v = p_.b_v,
                                           .hand_damping = TapBench::kGripDamping,
                                           .delay = 2 * delay * p_.tick});
  return std::clamp(wall, kSoftest, kStiffest);
}

// Stability of the standard coupling in that grip, with a massless proxy: s times the impedance at
// the joints of arm, grip, spring and wall. Stable if the angle of its determinant grows along the
// imaginary axis by two right angles a joint, as for a mass on a spring and a damper.
bool LinkTheory::stable(double wall, int delay) const {
  using Complex = Eigen::Matrix3cd;
  constexpr double kStep = 0.5, kTo = 4000;  // [rad/s]
  const Eigen::Matrix3d M = at_.M, JJ = at_.J.transpose() * at_.J,
                        normal = at_.J.row(2).transpose() * at_.J.row(2);
  const double trip = 2 * delay * p_.tick;
  double turned = 0;
  std::complex<double> before = 0;
  for (double w = kStep; w <= kTo; w += kStep) {
    const std::complex<double> s(0, w), spring = p_.k_vc + s * p_.b_vc;
    const Complex I = Complex::Identity();
    const Complex proxy = s * (p_.b_v + p_.k_vc * p_.tick / 2) * I + wall * normal;
    const Complex apart = (spring * I + proxy).inverse();
    const Complex all = s * s * M + s * Eigen::Matrix3d(b_d_.asDiagonal()) +
                        (grip_ + s * TapBench::kGripDamping) * JJ + spring * I -
                        spring * spring * std::exp(-s * (trip + p_.tick)) * apart;
    const std::complex<double> now = all.determinant();
    turned += before == 0.0 ? std::arg(now) : std::arg(now / before);
    before = now;
  }
  return std::abs(turned - 3 * std::numbers::pi) < 1;
}

}  // namespace limpid
