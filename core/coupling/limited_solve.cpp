#include "core/coupling/limited_solve.h"

#include <cmath>

namespace limpid {
namespace {

constexpr double kEnough = 1e-9;        // last step, relative to the motion and to 1 rad/s
constexpr double kShortest = 1 / 64.0;  // smallest part of a step, tried last and then taken

template <int N>
Vec<N> clip(const Vec<N>& x, const Vec<N>& limit) {
  return x.cwiseMin(limit).cwiseMax(-limit);
}

template <int N>
double size(const Motion<N>& m) {
  return std::sqrt(m.w.squaredNorm() + m.u.squaredNorm());
}

// Clears the slope of motors at their limit, whose torque does not respond.
template <int N>
void hold(Mat<N>& slope, const Vec<N>& torque, const Vec<N>& limit) {
  for (Eigen::Index i = 0; i < torque.size(); ++i) {
    if (std::abs(torque[i]) > limit[i]) slope.row(i).setZero();
  }
}

}  // namespace

template <int N>
Motion<N> LimitedSolve<N>::residual(ContactSolve<N>& contacts, double T, const Motion<N>& m,
                                    Mat<N>* slope, Slope how) {
  f2 = contacts.push(m.u, T, slope, how);
  wanted_ = tE.at(m) + on_f2 * f2;
  p = clip<N>(wanted_, limit);
  given = p + tL.at(m);
  tau1 = clip<N>(given, limit);
  return {D0 * m.w - drive - authority * tau1, impedance * m.u - momentum + p - rest.at(m) - f2};
}

// Factors the slopes of the residual at the motion evaluated last.
template <int N>
typename LimitedSolve<N>::Slopes LimitedSolve<N>::slopes(const Mat<N>& f2_on_u) const {
  Mat<N> p_w = tE.on_w, p_u = tE.on_u + on_f2 * f2_on_u;
  hold<N>(p_w, wanted_, limit);
  hold<N>(p_u, wanted_, limit);
  Mat<N> tau_w = p_w + tL.on_w, tau_u = p_u + tL.on_u;
  hold<N>(tau_w, given, limit);
  hold<N>(tau_u, given, limit);
  return Slopes(widened<N>(D0 - authority * tau_w), widened<N>(-authority * tau_u),
                widened<N>(p_w - rest.on_w), widened<N>(impedance + p_u - rest.on_u - f2_on_u));
}

template <int N>
bool LimitedSolve<N>::solve(ContactSolve<N>& contacts, double T, Motion<N>& m) {
  const Eigen::Index n = limit.size();
  Mat<N> f2_on_u = Mat<N>::Zero(n, n);
  for (steps = 0; steps < kMostSteps; ++steps) {
    const Slope how = steps < kQuickSteps ? Slope::quick : Slope::whole;
    const Motion<N> off = residual(contacts, T, m, &f2_on_u, how);
    const Slopes J = slopes(f2_on_u);
    const Motion<N> step = J.solve(off);
    const double far = size(step);
    if (!std::isfinite(far)) return false;
    const Motion<N> from = m;
    if (far <= kEnough * (1 + size(from))) {
      m = {from.w - step.w, from.u - step.u};
      residual(contacts, T, m);
      return true;
    }
    for (double by = 1; by >= kShortest; by /= 2) {
      m = {from.w - by * step.w, from.u - by * step.u};
      if (size(J.solve(residual(contacts, T, m))) <= (1 - by / 4) * far) break;
    }
  }
  return false;
}

template <int N>
void LimitedSolve<N>::stand_still(ContactSolve<N>& contacts, double T, Motion<N>& m) {
  m.u.setZero(limit.size());
  m.w = limpid::solve<N>(D0, drive);
  residual(contacts, T, m);
  m.w = limpid::solve<N>(D0, Vec<N>(drive + authority * tau1));
}

template struct LimitedSolve<3>;
template struct LimitedSolve<7>;
template struct LimitedSolve<kAnyDof>;

}  // namespace limpid
