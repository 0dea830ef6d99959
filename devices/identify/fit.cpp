#include "devices/identify/fit.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/math/eigen.h"

namespace limpid {

namespace {

using Eigen::Index;

constexpr double kLeastSpeed = 0.05;  // least speed that counts as motion [rad/s]

// Returns whether the joint moves in the direction of v throughout the window about `time`, faster
// than stiction or a flickering encoder.
bool moves_on(const MotionRecord& record, const Smoothing& window, double time, Index joint,
              double v, double step) {
  const double piece = std::max(window.sigma, 0.01);
  const double least = std::max(1.5 * step, kLeastSpeed * piece);
  const auto at = [&](double t) {
    const auto row = static_cast<Index>(std::llround(t / record.T));
    return record.x(std::clamp<Index>(row, 0, record.rows() - 1), joint);
  };
  const double edge = 3 * window.sigma;
  for (double t = time - edge; t < time + edge - 1e-9; t += piece) {
    const double moved = at(t + piece) - at(t);
    if (!(v > 0 ? moved >= least : moved <= -least)) return false;
  }
  return true;
}

using Eigen::Matrix4d;

Matrix4d pseudo_inertia(const LinkParameters& p) {
  const double half = 0.5 * (p[4] + p[7] + p[9]);
  Matrix4d J;
  J << half - p[4], -p[5], -p[6], p[1],  //
      -p[5], half - p[7], -p[8], p[2],   //
      -p[6], -p[8], half - p[9], p[3],   //
      p[1], p[2], p[3], p[0];
  return J;
}

LinkParameters parameters_of(const Matrix4d& J) {
  const double trace = J(0, 0) + J(1, 1) + J(2, 2);
  LinkParameters p;
  p << J(3, 3), J(0, 3), J(1, 3), J(2, 3), trace - J(0, 0), -J(0, 1), -J(0, 2), trace - J(1, 1),
      -J(1, 2), trace - J(2, 2);
  return p;
}

Matrix4d triangle(const LinkParameters& d) {
  Matrix4d E = Matrix4d::Zero();
  Eigen::Index k = 0;
  for (Eigen::Index j = 0; j < 4; ++j) {
    E(j, j) = std::exp(d[k++]);
    for (Eigen::Index i = j + 1; i < 4; ++i) E(i, j) = d[k++];
  }
  return E;
}

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kLeastRows = 100;
constexpr double kHuber = 2;  // deviations from which on a miss counts less

// The minimum of a function with one minimum there: a grid, then golden sections about the best.
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

// Bodies near the guess and friction that fit A z = b with unit deviations.
struct Nearest {
  Nearest(const ArmDescription& guess, const MatrixXd& A, const VectorXd& b, const VectorXd& torque)
      : of(condensed(A, b)) {
    for (const Link& link : guess.links) bodies.emplace_back(parameters_of(link));
    // The prior knows a body to a factor of e, and nothing of friction. It favours weight over a
    // spring where both explain as much.
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
  VectorXd miss(const VectorXd& q) const {
    VectorXd out(2 * q.size());
    out << of.R * z(q) - of.y, prior.cwiseProduct(q);
    return out;
  }
  MatrixXd miss_slope(const VectorXd& q) const {
    MatrixXd out(2 * q.size(), q.size());
    out << of.R * slope(q), MatrixXd(prior.asDiagonal());
    return out;
  }
  // Returns the most likely q.
  VectorXd found() const {
    return least_miss([this](const VectorXd& q) { return miss(q); },
                      [this](const VectorXd& q) { return miss_slope(q); },
                      VectorXd::Zero(prior.size()));
  }

  std::vector<PlausibleLink> bodies;
  Condensed of;
  VectorXd prior;
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
  double miss(const LeastSquares& fit, double delay) const {
    return fit.miss(weight_.cwiseProduct(torque(delay)));
  }

  // Weighs rows by the noise of their joint, found from the misses.
  void weigh() {
    const LeastSquares fit(weight_.asDiagonal() * rows_.A);
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
    const Nearest nearest(guess_, weight_.asDiagonal() * rows_.A, weight_.cwiseProduct(b_), torque);
    const VectorXd q = nearest.found();
    const MatrixXd J = nearest.miss_slope(q);
    const MatrixXd back = LeastSquares(J).solution();
    const MatrixXd slope = nearest.slope(q);
    const MatrixXd covariance = slope * (back * back.transpose()) * slope.transpose();
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
      out.arm.joints[J_].spring = joint.spring.value;  // below 0 if it cancels part of the weight
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

  // Standard deviation of the delay, from the curvature of the misses about their minimum [s].
  double delay_deviation() const {
    constexpr double kStep = 2e-4;  // [s]
    const LeastSquares fit(weight_.asDiagonal() * rows_.A);
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

Eigen::VectorXd independent_times(const MotionRecord& record, const Smoothing& window,
                                  double longest_delay) {
  const double margin = 1.5 * window.reach() + longest_delay;
  const double spacing = window.independent();
  const double length = static_cast<double>(record.rows()) * record.T - 2 * margin;
  if (length < spacing) throw std::invalid_argument("the recorded motion is too short");
  const auto count = static_cast<Index>(length / spacing);
  return Eigen::VectorXd::LinSpaced(count, margin,
                                    margin + static_cast<double>(count - 1) * spacing);
}

Equations equations_of(const ArmDescription& guess, const MotionRecord& record, const Vec3& gravity,
                       const Smoothing& window, const Eigen::VectorXd& times) {
  const Motion3 motion = motion_at(record, window, times);
  const Eigen::VectorXd step = encoder_steps(record);
  const Arm<kAnyDof> arm(guess);
  const Index n = record.joints(), of_links = kLinkParameters * n;
  Equations out;
  std::vector<Eigen::RowVectorXd> lines;
  for (Index k = 0; k < times.size(); ++k) {
    const Eigen::MatrixXd Y =
        regressor(arm, motion.x.row(k).transpose(), motion.v.row(k).transpose(),
                  motion.a.row(k).transpose(), gravity);
    for (Index j = 0; j < n; ++j) {
      const double v = motion.v(k, j);
      if (!moves_on(record, window, times[k], j, v, step[j])) continue;
      Eigen::RowVectorXd line = Eigen::RowVectorXd::Zero(of_links + kOwnParameters * n);
      line.head(of_links) = Y.row(j);
      line.segment<kOwnParameters>(of_links + kOwnParameters * j) << v, v > 0 ? 1 : -1, 1,
          motion.x(k, j);
      lines.push_back(std::move(line));
      out.time.push_back(k);
      out.joint.push_back(j);
    }
  }
  out.A.resize(static_cast<Index>(lines.size()), of_links + kOwnParameters * n);
  for (Index i = 0; i < out.A.rows(); ++i) out.A.row(i) = lines[static_cast<std::size_t>(i)];
  return out;
}

Eigen::VectorXd Equations::of(const Eigen::MatrixXd& torque) const {
  Eigen::VectorXd b(A.rows());
  for (Index i = 0; i < b.size(); ++i) {
    const auto row = static_cast<std::size_t>(i);
    b[i] = torque(time[row], joint[row]);
  }
  return b;
}

PlausibleLink::PlausibleLink(const LinkParameters& guess) {
  Matrix4d J = pseudo_inertia(guess);
  // Scales to units in which every body is about one: its mass and its size squared.
  const double mass = std::max(guess[0], 1e-9);
  const double size2 = std::max(J.topLeftCorner<3, 3>().trace() / mass, 1e-8);
  Eigen::Vector4d unit = Eigen::Vector4d::Constant(std::sqrt(mass * size2));
  unit[3] = std::sqrt(mass);
  Matrix4d scaled = unit.cwiseInverse().asDiagonal() * J * unit.cwiseInverse().asDiagonal();
  for (double more = 1e-3;; more *= 2) {
    const Eigen::LLT<Matrix4d> factor(scaled);
    const Matrix4d L = factor.matrixL();
    if (factor.info() == Eigen::Success && L.diagonal().minCoeff() > 0.01) {
      L0_ = unit.asDiagonal() * L;
      return;
    }
    scaled.diagonal().array() += more;
  }
}

LinkParameters PlausibleLink::at(const LinkParameters& d) const {
  const Matrix4d L = L0_ * triangle(d);
  return parameters_of(Matrix4d(L * L.transpose()));
}

Eigen::Matrix<double, kLinkParameters, kLinkParameters> PlausibleLink::slope(
    const LinkParameters& d) const {
  const Matrix4d E = triangle(d);
  Eigen::Matrix<double, kLinkParameters, kLinkParameters> out;
  Eigen::Index k = 0;
  for (Eigen::Index j = 0; j < 4; ++j) {
    for (Eigen::Index i = j; i < 4; ++i) {
      Matrix4d dE = Matrix4d::Zero();
      dE(i, j) = i == j ? E(j, j) : 1;
      const Matrix4d half = L0_ * dE * E.transpose() * L0_.transpose();
      out.col(k++) = parameters_of(Matrix4d(half + half.transpose()));
    }
  }
  return out;
}

Identified identify(const ArmDescription& guess, const MotionRecord& record,
                    const FitSettings& settings) {
  return Fit(guess, record, settings).run();
}

}  // namespace limpid
