// Coulomb friction of the virtual arm's joints over a substep.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "core/math/solve.h"

namespace limpid {

// Change dv of the joints' velocities v over a substep, with friction torques l:
//     A dv = b + l.
// A joint whose mean velocity v + dv/2 is not zero has l_i = -f_i along it; one that friction holds
// has a mean velocity of zero and |l_i| <= f_i. So friction takes energy alone. This has exactly
// one solution, as A is positive definite. It is found by pivoting on blocks of joints (Judice and
// Pires 1994), which starts from the directions of v.
template <int N>
class JointFriction {
 public:
  // A: its lower triangle. f: friction of each joint, 0 for one without.
  JointFriction(const Mat<N>& A, const Vec<N>& b, const Vec<N>& v, const Vec<N>& f)
      : A_(A.template selfadjointView<Eigen::Lower>()), b_(b), v_(v), f_(f) {}

  Vec<N> change() {
    for (Eigen::Index i = 0; i < v_.size(); ++i) {
      const bool held = f_[i] > 0 && v_[i] == 0;
      way(i) = held ? kHeld : v_[i] < 0 ? kBack : kOn;
    }
    int least = static_cast<int>(v_.size()) + 1, tries = kBlocks;
    for (int step = 0; step < kMostSteps; ++step) {
      solve(kTurns);
      const int wrong = count_wrong();
      if (wrong == 0) return at_rest();
      if (wrong < least) {
        least = wrong;
        tries = kBlocks;
      } else {
        --tries;
      }
      pivot(tries <= 0);
    }
    for (Eigen::Index i = 0; i < v_.size(); ++i) {
      if (f_[i] > 0) way(i) = kHeld;
    }
    solve(kRests);
    return dv_;
  }

 private:
  // Ways of a joint. Steps with blocks that may leave as many joints wrong; then single ones
  // follow, which always end.
  static constexpr int kBack = -1, kHeld = 0, kOn = 1;
  static constexpr int kBlocks = 3, kMostSteps = 200;
  // Changes of a held joint's velocity, by the velocity: its mean is zero, or it ends at rest.
  static constexpr double kTurns = -2, kRests = -1;
  static constexpr double kRounding = 1e-9;

  int& way(Eigen::Index joint) { return way_[static_cast<std::size_t>(joint)]; }
  int way(Eigen::Index joint) const { return way_[static_cast<std::size_t>(joint)]; }
  double mean(Eigen::Index joint) const { return v_[joint] + dv_[joint] / 2; }

  // Finds the changes and the torques with the joints' ways as they are.
  void solve(double held) {
    Mat<N> A = A_;
    dv_ = b_;
    bool moves = false;
    for (Eigen::Index i = 0; i < v_.size(); ++i) {
      if (way(i) == kHeld) continue;
      moves = true;
      dv_[i] -= way(i) * f_[i];
      for (Eigen::Index j = 0; j < v_.size(); ++j) {
        if (way(j) == kHeld) dv_[i] -= A_(i, j) * held * v_[j];
      }
    }
    for (Eigen::Index i = 0; i < v_.size(); ++i) {
      if (way(i) != kHeld) continue;
      dv_[i] = held * v_[i];
      A.row(i).setZero();
      A.col(i).setZero();
      A(i, i) = 1;
    }
    if (moves) dv_ = solve_symmetric<N>(A, dv_);
    for (Eigen::Index i = 0; i < v_.size(); ++i) {
      l_[i] = way(i) * -f_[i];
      if (way(i) != kHeld) continue;
      dv_[i] = held * v_[i];
      l_[i] = -b_[i];
      for (Eigen::Index j = 0; j < v_.size(); ++j) l_[i] += A_(i, j) * dv_[j];
    }
  }

  // The way that a joint should have instead.
  int right(Eigen::Index i) const {
    if (way(i) != kHeld) return f_[i] > 0 && way(i) * mean(i) < 0 ? kHeld : way(i);
    if (std::abs(l_[i]) <= f_[i] * (1 + kRounding)) return kHeld;
    return l_[i] > 0 ? kBack : kOn;
  }
  int count_wrong() const {
    int wrong = 0;
    for (Eigen::Index i = 0; i < v_.size(); ++i) wrong += right(i) != way(i) ? 1 : 0;
    return wrong;
  }
  void pivot(bool last_alone) {
    for (Eigen::Index i = v_.size(); i-- > 0;) {
      const int to = right(i);
      if (to == way(i)) continue;
      way(i) = to;
      if (last_alone) return;
    }
  }

  // Lets held joints end at rest where that takes energy, too: else they turn back, and rest a
  // substep later.
  Vec<N> at_rest() {
    bool still = true;
    for (Eigen::Index i = 0; i < v_.size(); ++i) still &= way(i) != kHeld || v_[i] == 0;
    if (still) return dv_;
    const Vec<N> turned = dv_;
    solve(kRests);
    double work = 0;
    for (Eigen::Index i = 0; i < v_.size(); ++i) work += l_[i] * mean(i);
    return work <= 0 ? dv_ : turned;
  }

  Mat<N> A_;
  const Vec<N>&b_, &v_, &f_;
  Vec<N> dv_ = b_, l_ = b_;
  std::array<int, kMaxDof> way_{};
};

}  // namespace limpid
