#include "devices/identify/fit.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <cmath>
#include <stdexcept>
#include <unsupported/Eigen/LevenbergMarquardt>

#include "devices/identify/equations.h"
#include "devices/identify/plausible.h"

namespace limpid {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kLeastRows = 100;
constexpr double kHuber = 2;  // deviations from which on a miss counts less

// The least squares of A z = b for many b.
class Projection {
 public:
  explicit Projection(const MatrixXd& A) : scale_(A.colwise().norm().transpose()) {
    for (double& s : scale_) s = s > 0 ? 1 / s : 0;
    qr_.setThreshold(1e-9);
    qr_.compute(A * scale_.asDiagonal());
  }
  VectorXd solve(const VectorXd& b) const { return scale_.asDiagonal() * VectorXd(qr_.solve(b)); }
  double miss(const VectorXd& b) const {  // |b - A z|^2
    const VectorXd turned = qr_.householderQ().adjoint() * b;
    return turned.tail(turned.size() - qr_.rank()).squaredNorm();
  }

 private:
  VectorXd scale_;
  Eigen::ColPivHouseholderQR<MatrixXd> qr_;
};

// The least of a function that has one in there: a grid, then golden sections about the best.
template <class F>
double least_of(const F& f, double low, double high) {
  constexpr int kGrid = 24;
  const double step = (high - low) / kGrid;
  double best = low, value = f(low);
  for (int i = 1; i <= kGrid; ++i) {
    const double at = low + step * i, here = f(at);
    if (here < value) best = at, value = here;
  }
  low = std::max(low, best - step), high = std::min(high, best + step);
  constexpr double kGolden = 0.6180339887498949;
  while (high - low > 1e-6) {
    const double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
    if (f(left) < f(right))
      high = right;
    else
      low = left;
  }
  return 0.5 * (low + high);
}

// Bodies near the guess and friction that fit R z = y, deviations all 1: what is asked of the
// library's Levenberg and Marquardt.
struct Nearest : Eigen::DenseFunctor<double> {
  Nearest(const ArmDescription& guess, const MatrixXd& A, const VectorXd& b, const VectorXd& torque)
      : DenseFunctor<double>(static_cast<int>(A.cols()), static_cast<int>(2 * A.cols())) {
    for (const Link& link : guess.links) bodies.emplace_back(parameters_of(link));
    const Eigen::HouseholderQR<MatrixXd> qr(A);
    R = qr.matrixQR().topRows(A.cols()).triangularView<Eigen::Upper>();
    y = (qr.householderQ().adjoint() * b).head(A.cols());
    // At the start a body is known to a factor of e; of friction nothing; a spring is rather not
    // there, where weight explains as much.
    prior = VectorXd::Ones(A.cols());
    for (Index j = 0; j < bodies_size(); ++j) {
      const double spring = 1 / (0.3 * torque[j]);
      prior.segment<kOwnParameters>(kLinkParameters * bodies_size() + kOwnParameters * j) << 0, 0,
          spring, spring;
    }
  }
  Index bodies_size() const { return static_cast<Index>(bodies.size()); }

  VectorXd z(const VectorXd& q) const {
    VectorXd out = q;
    for (Index i = 0; i < bodies_size(); ++i) {
      const LinkParameters d = q.segment<kLinkParameters>(kLinkParameters * i);
      out.segment<kLinkParameters>(kLinkParameters * i) = bodies[static_cast<std::size_t>(i)].at(d);
    }
    return out;
  }
  MatrixXd slope(const VectorXd& q) const {
    MatrixXd out = MatrixXd::Identity(q.size(), q.size());
    for (Index i = 0; i < bodies_size(); ++i) {
      const Index at = kLinkParameters * i;
      const LinkParameters d = q.segment<kLinkParameters>(at);
      out.block<kLinkParameters, kLinkParameters>(at, at) =
          bodies[static_cast<std::size_t>(i)].slope(d);
    }
    return out;
  }
  int operator()(const VectorXd& q, VectorXd& miss) const {
    miss << R * z(q) - y, prior.cwiseProduct(q);
    return 0;
  }
  int df(const VectorXd& q, MatrixXd& J) const {
    J << R * slope(q), MatrixXd(prior.asDiagonal());
    return 0;
  }

  std::vector<PlausibleLink> bodies;
  MatrixXd R;
  VectorXd y, prior;
};

class Fit {
 public:
  Fit(const ArmDescription& guess, const MotionRecord& record, const FitSettings& settings)
      : guess_(guess),
        record_(record),
        settings_(settings),
        smoothing_(smoothing_for(record)),
        n_(record.joints()) {
    if (guess.dof() != n_) {
      throw std::invalid_argument(
          fmt::format("the arm has {} joints, the recorded motion {}", guess.dof(), n_));
    }
    times_ = independent_times(record, smoothing_, settings.longest_delay);
    rows_ = equations_of(guess, record, settings.gravity, smoothing_, times_);
    count_ = Eigen::VectorX<Index>::Zero(n_);
    for (const Index j : rows_.joint) ++count_[j];
    for (Index j = 0; j < n_; ++j) {
      if (count_[j] >= kLeastRows) continue;
      throw std::invalid_argument(fmt::format(
          "joint '{}' moved too little: {} samples of its motion can be used, needed: {}",
          guess.joints[static_cast<std::size_t>(j)].name, count_[j], kLeastRows));
    }
  }

  Identified run() {
    weight_ = VectorXd::Ones(rows_.A.rows());
    for (int round = 0; round < 4; ++round) weigh();
    return report();
  }

 private:
  VectorXd torque(double delay) const {
    return rows_.of(torque_at(record_, smoothing_, times_, delay));
  }
  double miss(const Projection& fit, double delay) const {
    return fit.miss(weight_.cwiseProduct(torque(delay)));
  }

  // Rows by how far they miss: each joint has its own noise.
  void weigh() {
    const Projection fit(weight_.asDiagonal() * rows_.A);
    delay_ = least_of([&](double d) { return miss(fit, d); }, 0.0, settings_.longest_delay);
    b_ = torque(delay_);
    const VectorXd off = b_ - rows_.A * fit.solve(weight_.cwiseProduct(b_));
    noise_ = VectorXd::Zero(n_);
    for (Index i = 0; i < off.size(); ++i) noise_[joint(i)] += off[i] * off[i];
    noise_ = (noise_.array() / count_.cast<double>().array()).sqrt().max(1e-9);
    for (Index i = 0; i < off.size(); ++i) {
      const double far = std::abs(off[i]) / noise_[joint(i)];
      weight_[i] = std::min(1.0, std::sqrt(kHuber / std::max(far, 1e-9))) / noise_[joint(i)];
    }
  }

  Index joint(Index row) const { return rows_.joint[static_cast<std::size_t>(row)]; }

  Identified report() const {
    VectorXd torque = VectorXd::Zero(n_);  // root mean square
    for (Index i = 0; i < b_.size(); ++i) torque[joint(i)] += b_[i] * b_[i];
    torque = (torque.array() / count_.cast<double>().array()).sqrt().max(1e-9);
    Nearest nearest(guess_, weight_.asDiagonal() * rows_.A, weight_.cwiseProduct(b_), torque);
    VectorXd q = VectorXd::Zero(rows_.A.cols());
    Eigen::LevenbergMarquardt<Nearest> search(nearest);
    search.minimize(q);
    MatrixXd J(nearest.values(), nearest.inputs());
    nearest.df(q, J);
    const MatrixXd spread =
        MatrixXd(J.transpose() * J).completeOrthogonalDecomposition().pseudoInverse();
    const MatrixXd slope = nearest.slope(q);
    const MatrixXd covariance = slope * spread * slope.transpose();
    const VectorXd z = nearest.z(q);

    Identified out{.arm = guess_, .joints = {}, .middle = record_.x.colwise().mean(), .delay = {}};
    const auto found = [&](const Eigen::RowVectorXd& row) {
      return Found{row.dot(z),
                   std::sqrt(std::max(0.0, (row * covariance * row.transpose()).value()))};
    };
    const Arm<kAnyDof> arm(guess_);
    const Vec<kAnyDof> zero = VectorXd::Zero(n_), middle = out.middle;
    const MatrixXd weight = regressor(arm, middle, zero, zero, settings_.gravity);
    for (Index j = 0; j < n_; ++j) {
      const Vec<kAnyDof> unit = VectorXd::Unit(n_, j);
      const auto of_links = [&](const Eigen::RowVectorXd& Y) {
        Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(z.size());
        row.head(Y.size()) = Y;
        return found(row);
      };
      const auto own = [&](Index k) {
        return found(
            Eigen::RowVectorXd::Unit(z.size(), kLinkParameters * n_ + kOwnParameters * j + k));
      };
      JointFinding joint{
          .inertia = of_links(regressor(arm, middle, zero, unit, Vec3::Zero()).row(j)),
          .gravity = of_links(weight.row(j)),
          .viscous = own(0),
          .coulomb = own(1),
          .offset = own(2),
          .spring = own(3),
          .residual = noise_[j],
          .torque = torque[j],
          .samples = count_[j]};
      out.joints.push_back(joint);
      const auto J_ = static_cast<std::size_t>(j);
      set_parameters(out.arm.links[J_], z.segment<kLinkParameters>(kLinkParameters * j));
      out.arm.joints[J_].damping = std::max(0.0, joint.viscous.value);
      out.arm.joints[J_].friction = std::max(0.0, joint.coulomb.value);
      out.arm.joints[J_].spring = joint.spring.value;  // with the weight it may be below 0
      out.arm.joints[J_].offset = joint.offset.value;
    }
    out.arm.gravity = settings_.gravity;
    out.arm.delay = delay_;
    out.delay = {delay_, delay_deviation()};
    out.moments = explained(z);
    return out;
  }

  std::vector<Explained> explained(const VectorXd& z) const {
    const Index of_links = kLinkParameters * n_;
    std::vector<Explained> out;
    for (Index i = 0; i < b_.size(); ++i) {
      const Eigen::RowVectorXd row = rows_.A.row(i);
      const Index own = of_links + kOwnParameters * joint(i);
      out.push_back({.time = times_[rows_.time[static_cast<std::size_t>(i)]],
                     .joint = joint(i),
                     .velocity = row[own],
                     .torque = b_[i],
                     .bodies = row.head(of_links).dot(z.head(of_links)),
                     .springs = row.segment<2>(own + 2).dot(z.segment<2>(own + 2)),
                     .friction = row.segment<2>(own).dot(z.segment<2>(own))});
    }
    return out;
  }

  // From how fast the misses grow beside their least.
  double delay_deviation() const {
    constexpr double kStep = 2e-4;  // [s]
    const Projection fit(weight_.asDiagonal() * rows_.A);
    const double curve =
        (miss(fit, delay_ + kStep) + miss(fit, delay_ - kStep) - 2 * miss(fit, delay_)) /
        (kStep * kStep);
    return curve > 0 ? std::sqrt(2 / curve) : settings_.longest_delay;
  }

  const ArmDescription& guess_;
  const MotionRecord& record_;
  const FitSettings& settings_;
  Smoothing smoothing_;
  Index n_;
  VectorXd times_;
  Equations rows_;
  Eigen::VectorX<Index> count_;
  VectorXd weight_, b_, noise_;
  double delay_ = 0;
};

}  // namespace

Identified identify(const ArmDescription& guess, const MotionRecord& record,
                    const FitSettings& settings) {
  return Fit(guess, record, settings).run();
}

}  // namespace limpid
