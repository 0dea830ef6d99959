#include "devices/identify/grip.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/tick/compensation.h"
#include "core/tick/tick.h"
#include "devices/identify/grip_probe.h"

namespace limpid {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

constexpr std::size_t kMostMissing = 20;  // rows in one place that may be missing

// Unknowns of the fit: the hand's, then factors on the device's friction, and what its inertia,
// damping and delay differ by.
enum Unknown : Eigen::Index { stiffness, damping, mass, friction, inertia, drag, delay, kUnknowns };
using Gram = Eigen::Matrix<double, kUnknowns + 1, kUnknowns + 1>;  // the last column is what is fitted

constexpr int kGuard = 2;  // least distance from a line of a bin that has no part of it
constexpr int kBeside = 8;  // largest distance of bins whose noise counts as a line's
constexpr double kModelled = 1e-3;  // part of each torque that no model of a device gets right
constexpr double kSure = 2.2;       // standard deviations of 95 %, as the noise is estimated too

// What is known well enough: to a part of the value, or to a part of what the device itself has.
constexpr double kPart = 0.15;

}  // namespace

void GripRecord::add(std::span<const double> x, std::span<const double> torque, bool touched) {
  x_.insert(x_.end(), x.begin(), x.end());
  torque_.insert(torque_.end(), torque.begin(), torque.end());
  touched_.push_back(touched ? 1 : 0);
}

void GripRecord::take(std::span<const double> row) {
  const auto excitation = layout_.in(row, Column::excitation);
  const bool on = std::ranges::any_of(excitation, [](double f) { return f != 0; });
  const double energy = layout_.in(row, Column::energy_compensation)[0];
  if (!on) {
    if (begun() && !ended_) {
      ended_ = true;
      const double whole = GripProbe::kDuration - 2 * T_;
      const double state = layout_.in(row, Column::force_state)[0];
      if (duration() < whole) ended_by_ = static_cast<ForceState>(std::max(state, 1.0));
    }
    return;
  }
  if (ended_) *this = GripRecord(layout_, T_);
  const double time = layout_.in(row, Column::time)[0];
  const auto x = layout_.in(row, Column::measured_position);
  const auto torque = layout_.in(row, Column::motor_torque);
  const auto pushed = layout_.in(row, Column::contact_torque);
  const bool touched = std::ranges::any_of(pushed, [](double f) { return f != 0; });
  if (begun()) {
    // The motors held their torque while ticks were missed.
    const auto n = static_cast<std::size_t>(dof());
    const double passed = std::max(0.0, std::round((time - time_) / T_) - 1);
    torn_ = torn_ || passed > kMostMissing;
    const auto missing = static_cast<std::size_t>(std::min(passed, 1.0 * kMostMissing));
    const std::vector<double> last(x_.end() - dof(), x_.end());
    const std::vector<double> held(torque_.end() - dof(), torque_.end());
    std::vector<double> between(n);
    for (std::size_t i = 1; i <= missing; ++i) {
      const double part = static_cast<double>(i) / static_cast<double>(missing + 1);
      for (std::size_t j = 0; j < n; ++j) between[j] = last[j] + part * (x[j] - last[j]);
      add(between, held, touched);
    }
    if (energy > energy_ || time > time_) work_ += energy - energy_;
  }
  energy_ = energy;
  time_ = time;
  real_ = std::isnan(layout_.in(row, Column::hand_torque)[0]);
  add(x, torque, touched);
}

DeviceTrust DeviceTrust::of(const ArmDescription& arm, bool real, double tick) {
  if (!real) return {1e-6, 1e-6, 1e-6, 1e-3 * tick};
  if (arm.delay) return {0.03, 0.1, 0.15, 0.25 * tick};
  return {0.1, 0.3, 0.4, tick};
}

namespace {

// A device at the mean pose of a record, and the record's spectra.
class HeldDevice {
 public:
  HeldDevice(const ArmDescription& arm, const Parameters& p, const GripRecord& record)
      : arm_(arm), n_(arm.dof()), T_(record.tick()), model_(arm) {
    const auto first = static_cast<Eigen::Index>(std::llround(GripProbe::kSettle / T_));
    samples_ = static_cast<Eigen::Index>(std::llround(GripProbe::kMeasured / T_));
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const auto rows = static_cast<Eigen::Index>(record.samples());
    x_ = Eigen::Map<const Rows>(record.x().data(), rows, n_).middleRows(first, samples_);
    tau_ = Eigen::Map<const Rows>(record.torque().data(), rows, n_).middleRows(first, samples_);
    const Eigen::VectorXd pose = x_.colwise().mean();
    Frames frames;
    Mat<kAnyDof> M;
    Jacobian<kAnyDof> J;
    model_.frames(pose, frames);
    model_.inertia(frames, M);
    model_.point_jacobian(frames, n_ - 1, model_.tip(frames), J);
    M_ = M;
    J_ = J;
    B_ = resolve<kAnyDof>(record.real() ? kFromArm : p.damping,
                          of_joints<kAnyDof>(arm, &Joint::damping));
    friction_ = resolve<kAnyDof>(record.real() ? kFromArm : p.friction,
                                 of_joints<kAnyDof>(arm, &Joint::friction));
    if (record.real() || p.weighs) gravity_ = gravity_of(p.down, arm.gravity);
    springy_ = record.real() || p.springy;
    delay_ = record.real() ? arm.delay.value_or(p.delay * T_) : 0;
    note_motion(pose);
    bend(pose);
    rub(p.encoder_step);
    x_.rowwise() -= pose.transpose();
    tau_.rowwise() -= Eigen::RowVectorXd(tau_.colwise().mean());
    transform();
  }

  double moved() const { return moved_; }
  bool rubs() const { return friction_.maxCoeff() > 0; }
  // Mass and damping of the device itself at the tip, the mean over all directions [kg, N s/m].
  const Eigen::MatrixXd& J() const { return J_; }
  const Eigen::MatrixXd& M() const { return M_; }

  // The equations of all joints in a bin: a column for each unknown, and at last what they add up
  // to.
  Eigen::MatrixXcd equations(int bin) const {
    const double w = 2 * pi * bin / (static_cast<double>(samples_) * T_);
    const Complex s(0, w);
    const auto b = static_cast<std::size_t>(bin);
    const Eigen::VectorXcd q = spectrum_[b].col(0), rub = spectrum_[b].col(2);
    // The torque is held for a tick, and late.
    const Complex held = (1.0 - std::exp(-s * T_)) / (s * T_) * std::exp(-s * delay_);
    const Eigen::VectorXcd tau = held * spectrum_[b].col(1);
    const Eigen::VectorXcd hand = J_.transpose() * (J_ * q);
    Eigen::MatrixXcd all(n_, kUnknowns + 1);
    all.col(stiffness) = hand;
    all.col(damping) = s * hand;
    all.col(mass) = s * s * hand;
    all.col(friction) = rub;
    all.col(inertia) = s * s * (M_ * q);
    all.col(drag) = s * B_.cwiseProduct(q);
    all.col(delay) = s * tau;
    all.col(kUnknowns) = tau - all.col(inertia) - all.col(drag) - K_ * q;
    return all;
  }

 private:
  using Frames = Arm<kAnyDof>::Frames;

  // Finds how far the tip went.
  void note_motion(const Eigen::VectorXd& pose) {
    constexpr Eigen::Index kStride = 10;
    const Vec3 mean = model_.tip_at(pose);
    for (Eigen::Index i = 0; i < samples_; i += kStride) {
      moved_ = std::max(moved_, (model_.tip_at(x_.row(i).transpose()) - mean).norm());
    }
  }

  // Torque with which the motors would hold the arm there against its own forces and a steady
  // force at the tip [N m].
  Eigen::VectorXd steady(const Eigen::VectorXd& pose, const Vec3& force) const {
    Frames frames;
    Jacobian<kAnyDof> J;
    model_.frames(pose, frames);
    model_.point_jacobian(frames, n_ - 1, model_.tip(frames), J);
    Eigen::VectorXd torque = -J.transpose() * force;
    if (!gravity_.isZero(0)) torque += model_.weight(frames, gravity_);
    if (!springy_) return torque;
    for (int j = 0; j < n_; ++j) {
      const Joint& joint = arm_.joints[static_cast<std::size_t>(j)];
      torque[j] += joint.spring * pose[j] + joint.offset;
    }
    return torque;
  }

  // Finds the stiffness that weight, springs and a steady push of the hand give the joints.
  void bend(const Eigen::VectorXd& pose) {
    constexpr double kStep = 1e-4;  // [rad]
    const Eigen::VectorXd mean = tau_.colwise().mean();
    const Eigen::VectorXd left = steady(pose, Vec3::Zero()) - mean;
    const Vec3 push = Eigen::MatrixXd(J_.transpose()).completeOrthogonalDecomposition().solve(left);
    K_.resize(n_, n_);
    for (Eigen::Index j = 0; j < n_; ++j) {
      Eigen::VectorXd up = pose, down = pose;
      up[j] += kStep;
      down[j] -= kStep;
      K_.col(j) = (steady(up, push) - steady(down, push)) / (2 * kStep);
    }
  }

  // Finds the joints' friction from the direction in which they move. Over some samples a line is
  // fitted to coarse readings.
  void rub(double encoder_step) {
    rub_ = Eigen::MatrixXd::Zero(samples_, n_);
    if (!rubs()) return;
    const auto half = std::max<Eigen::Index>(
        1, std::llround((encoder_step > 0 ? 0.01 : 0.001) / T_));
    double squares = 0;
    for (Eigen::Index i = 1; i <= half; ++i) squares += 2.0 * static_cast<double>(i * i);
    for (Eigen::Index j = 0; j < n_; ++j) {
      for (Eigen::Index k = half; k + half < samples_; ++k) {
        double slope = 0;
        for (Eigen::Index i = 1; i <= half; ++i) {
          slope += static_cast<double>(i) * (x_(k + i, j) - x_(k - i, j));
        }
        const double v = slope / squares / T_;
        const double noise = encoder_step / std::sqrt(12 * squares) / T_ + 1e-6;
        rub_(k, j) = friction_[j] * v / std::sqrt(v * v + noise * noise);
      }
    }
  }

  // Computes the spectra of positions, torques and friction in all bins that count, each under a
  // window in which a line has no part beyond the next bins.
  void transform() {
    std::vector<Complex> turn(static_cast<std::size_t>(samples_));
    Eigen::MatrixXd all(samples_, 3 * n_);
    all << x_, tau_, rub_;
    for (Eigen::Index i = 0; i < samples_; ++i) {
      const double angle = 2 * pi * static_cast<double>(i) / static_cast<double>(samples_);
      turn[static_cast<std::size_t>(i)] = std::polar(1.0, -angle);
      all.row(i) *= (1 - std::cos(angle)) / static_cast<double>(samples_);
    }
    const int last = GripProbe::kLines.back() + kBeside;
    spectrum_.assign(static_cast<std::size_t>(last + 1), {});
    Eigen::MatrixX2d wave(samples_, 2);
    for (int bin = GripProbe::kLines.front() - kBeside; bin <= last; ++bin) {
      for (Eigen::Index i = 0; i < samples_; ++i) {
        const Complex& at = turn[static_cast<std::size_t>(i * bin % samples_)];
        wave(i, 0) = at.real();
        wave(i, 1) = at.imag();
      }
      const Eigen::MatrixXd sums = all.transpose() * wave;
      Eigen::MatrixXcd& into = spectrum_[static_cast<std::size_t>(bin)];
      into.resize(n_, 3);
      for (Eigen::Index c = 0; c < 3; ++c) {
        into.col(c).real() = sums.col(0).segment(c * n_, n_);
        into.col(c).imag() = sums.col(1).segment(c * n_, n_);
      }
    }
  }

  const ArmDescription& arm_;
  int n_;
  double T_;
  Arm<kAnyDof> model_;
  Eigen::Index samples_ = 0;
  Eigen::MatrixXd x_, tau_, rub_;  // a row for each sample
  Eigen::MatrixXd M_, K_, J_;
  Eigen::VectorXd B_, friction_;
  Vec3 gravity_ = Vec3::Zero();
  bool springy_ = false;
  double delay_ = 0, moved_ = 0;
  std::vector<Eigen::MatrixXcd> spectrum_;  // by bin: positions, torques, friction
};

// Least squares over the lines.
class GripFit {
 public:
  GripFit(const HeldDevice& device, const DeviceTrust& trust) {
    for (const int line : GripProbe::kLines) {
      Line& now = lines_.emplace_back();
      now.at = device.equations(line);
      for (int bin = line - kBeside; bin <= line + kBeside; ++bin) {
        const bool apart = std::ranges::all_of(
            GripProbe::kLines, [&](int other) { return std::abs(bin - other) >= kGuard; });
        if (apart) now.beside.push_back(device.equations(bin));
      }
    }
    known_[friction] = 1;
    firm_[friction] = trust.friction;
    firm_[inertia] = trust.inertia;
    firm_[drag] = trust.damping;
    firm_[delay] = trust.delay;
    constexpr int kRounds = 6;
    fine_ = true;
    for (int round = 0; round < kRounds && fine_; ++round) solve();
  }

  bool fine() const { return fine_; }
  Bounded operator[](Eigen::Index i) const {
    return {theta_[i], kSure * std::sqrt(std::max(covariance_(i, i), 0.0))};
  }

 private:
  using Theta = Eigen::Matrix<double, kUnknowns, 1>;
  struct Line {
    Eigen::MatrixXcd at;
    std::vector<Eigen::MatrixXcd> beside;  // noise
  };

  Eigen::VectorXcd left(const Eigen::MatrixXcd& of) const {
    return of.col(kUnknowns) - of.leftCols(kUnknowns) * theta_.cast<Complex>();
  }
  static Gram gram(const Eigen::MatrixXcd& of, const Eigen::VectorXd& weight) {
    return (of.adjoint() * weight.cast<Complex>().asDiagonal() * of).real();
  }

  void solve() {
    Gram sums = Gram::Zero();
    double misfit = 0, count = -1.5;  // three numbers are fitted
    for (const Line& line : lines_) {
      // Noise of each joint's equation.
      Eigen::VectorXd noise = Eigen::VectorXd::Zero(line.at.rows());
      const auto size = static_cast<double>(line.beside.size());
      for (const auto& bin : line.beside) noise += left(bin).cwiseAbs2() / size;
      const double all = line.at.col(kUnknowns).squaredNorm() +
                         line.at.col(inertia).squaredNorm();
      noise.array() += kModelled * kModelled * all + 1e-300;
      const Eigen::VectorXd weight = noise.cwiseInverse();
      sums += gram(line.at, weight);
      for (const auto& bin : line.beside) sums -= gram(bin, weight) / size;
      misfit += left(line.at).cwiseAbs2().dot(weight);
      count += static_cast<double>(line.at.rows());
    }
    const double wrong = std::max(1.0, misfit / count);
    Eigen::Matrix<double, kUnknowns, kUnknowns> H =
        2 / wrong * sums.topLeftCorner<kUnknowns, kUnknowns>();
    Theta r = 2 / wrong * sums.topRightCorner<kUnknowns, 1>();
    for (Eigen::Index i = friction; i < kUnknowns; ++i) {
      const double firm = 1 / (firm_[i] * firm_[i]);
      H(i, i) += firm;
      r[i] += firm * known_[i];
    }
    const Theta scale = H.diagonal().cwiseAbs().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Eigen::LLT<Eigen::Matrix<double, kUnknowns, kUnknowns>> solver(
        scale.asDiagonal() * H * scale.asDiagonal());
    fine_ = solver.info() == Eigen::Success;
    if (!fine_) return;
    theta_ = scale.cwiseProduct(solver.solve(scale.cwiseProduct(r)));
    const Eigen::Matrix<double, kUnknowns, kUnknowns> scaled =
        solver.solve(Eigen::Matrix<double, kUnknowns, kUnknowns>::Identity());
    covariance_ = scale.asDiagonal() * scaled * scale.asDiagonal();
    fine_ = theta_.allFinite() && covariance_.allFinite();
  }

  std::vector<Line> lines_;
  Theta theta_ = Theta::Zero(), known_ = Theta::Zero(), firm_ = Theta::Zero();
  Eigen::Matrix<double, kUnknowns, kUnknowns> covariance_;
  bool fine_ = false;
};

}  // namespace

Grip find_grip(const ArmDescription& arm, const Parameters& p, const GripRecord& record) {
  Grip grip;
  grip.work = record.work();
  if (!record.begun()) {
    grip.unknown = "the grip was not measured";
    return grip;
  }
  if (record.duration() < GripProbe::kSettle + GripProbe::kMeasured) {
    grip.unknown = "force went off";
    return grip;
  }
  const HeldDevice device(arm, p, record);
  grip.moved = device.moved();
  const GripFit fit(device, DeviceTrust::of(arm, record.real(), record.tick()));
  if (!fit.fine()) {
    grip.unknown = "no fit";
    return grip;
  }
  grip.measured = true;
  grip.stiffness = fit[stiffness];
  grip.damping = fit[damping];
  grip.mass = fit[mass];
  return grip;
}

}  // namespace limpid
