#include "devices/identify/grip.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>

#include "core/math/eigen.h"
#include "core/tick/compensation.h"
#include "core/tick/tick.h"
#include "devices/identify/grip_probe.h"

namespace limpid {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

constexpr std::size_t kMostMissing = 20;  // rows in one place that may be missing

// Columns of the equations: the hand's unknowns; those of the device that are fitted along, by what
// they differ from what is known of them; what else of the device may differ.
enum Term : Eigen::Index { stiffness, damping, mass, friction, lag, delay, inertia, drag, kTerms };
constexpr Eigen::Index kOfHand = 3, kFitted = 6;
using Gram = Eigen::Matrix<double, kTerms + 1, kTerms + 1>;  // the last column is what is fitted

constexpr int kGuard = 2;           // least distance from a line of a bin that has no part of it
constexpr int kBeside = 6;          // largest distance of bins whose noise counts as a line's
constexpr double kModelled = 1e-3;  // part of each torque that no model of a device gets right
constexpr double kSpan = 0.012;     // to either side, where a velocity is found [s]
constexpr double kSlow = 1;         // time over which the arm's pose is a mean [s]
constexpr Eigen::Index kSpectra = 5;
constexpr double kRubbed = 0.1;        // part of the friction that no line has in common
constexpr double kFrictionLag = 7e-4;  // of the friction where joints stick for a moment [s]
constexpr double kUnlike = 0.007;  // part of a value by which no hand is a spring, damper and mass
constexpr double kSure = 2.5;      // standard deviations of 95 %, as the noise is estimated too

// Bounds with which a value counts as known: a part of it; or, of a small value, as little as tells
// nobody another wall. 0.15 N s/m are half of the damping of the lightest arm, 20 g a pen.
constexpr double kPart = 0.15;
constexpr double kLeastDamping = 0.15;  // [N s/m]
constexpr double kLeastMass = 0.02;     // [kg]
constexpr double kFarthest = 0.05;      // tip from its mean place; beyond it the arm is another [m]

// A device at the mean pose of a record, and the record's spectra.
class HeldDevice {
 public:
  HeldDevice(const ArmDescription& arm, const Parameters& p, const GripRecord& record)
      : arm_(arm), n_(arm.dof()), T_(record.tick()), model_(arm) {
    const auto first = static_cast<Eigen::Index>(std::llround(GripProbe::kSettle / T_));
    samples_ = static_cast<Eigen::Index>(std::llround(GripProbe::kMeasured / T_));
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const auto rows = static_cast<Eigen::Index>(record.samples());
    const Eigen::Map<const Rows> all(record.x().data(), rows, n_);
    x_ = all.middleRows(first, samples_);
    tau_ = Eigen::Map<const Rows>(record.torque().data(), rows, n_).middleRows(first, samples_);
    const Eigen::VectorXd pose = pose_ = x_.colwise().mean();
    B_ = resolve<kAnyDof>(record.real() ? kFromArm : p.damping,
                          of_joints<kAnyDof>(arm, &Joint::damping));
    friction_ = resolve<kAnyDof>(record.real() ? kFromArm : p.friction,
                                 of_joints<kAnyDof>(arm, &Joint::friction));
    if (record.real() || p.weighs) gravity_ = gravity_of(p.down, arm.gravity);
    springy_ = record.real() || p.springy;
    delay_ = record.real() ? arm.delay.value_or(p.delay * T_) : 0;
    note_motion(pose, record.force().subspan(static_cast<std::size_t>(3 * first)));
    bend(pose);
    rub(p.encoder_step);
    x_.rowwise() -= pose.transpose();
    tau_.rowwise() -= Eigen::RowVectorXd(tau_.colwise().mean());
    lead_through(all, first);
    transform();
  }

  double moved() const { return moved_; }
  double work() const { return work_; }
  const Eigen::VectorXd& pose() const { return pose_; }
  bool rubs() const { return friction_.maxCoeff() > 0; }

  // The equations of all joints in a bin: a column for each unknown, and at last what they add up
  // to.
  Eigen::MatrixXcd equations(int bin) const {
    const double w = 2 * pi * bin / (static_cast<double>(samples_) * T_);
    const Complex s(0, w);
    const auto b = static_cast<std::size_t>(bin);
    const Eigen::VectorXcd q = spectrum_[b].col(0), rub = spectrum_[b].col(2);
    const Eigen::VectorXcd hand = spectrum_[b].col(3), moved = spectrum_[b].col(4);
    // The torque is held for a tick, and late.
    const Complex held = (1.0 - std::exp(-s * T_)) / (s * T_) * std::exp(-s * delay_);
    const Eigen::VectorXcd tau = held * spectrum_[b].col(1);
    Eigen::MatrixXcd all(n_, kTerms + 1);
    all.col(stiffness) = hand;
    all.col(damping) = s * hand;
    all.col(mass) = s * s * hand;
    all.col(friction) = rub;
    all.col(lag) = -s * rub;
    all.col(inertia) = s * s * moved;
    all.col(drag) = s * B_.cwiseProduct(q);
    all.col(delay) = s * tau;
    all.col(kTerms) = tau - rub - all.col(inertia) - all.col(drag) - K_ * q;
    return all;
  }

 private:
  using Frames = Arm<kAnyDof>::Frames;

  // Finds how far the tip went, and the work of the excitation.
  void note_motion(const Eigen::VectorXd& pose, std::span<const double> force) {
    const Vec3 mean = model_.tip_at(pose);
    Vec3 last = model_.tip_at(x_.row(0).transpose());
    for (Eigen::Index i = 1; i < samples_; ++i) {
      const Vec3 tip = model_.tip_at(x_.row(i).transpose());
      moved_ = std::max(moved_, (tip - mean).norm());
      work_ += (tip - last).dot(Vec3(&force[static_cast<std::size_t>(3 * (i - 1))]));
      last = tip;
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
    Eigen::MatrixXd levers(n_, 3);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      levers.col(axis) = steady(pose, Vec3::Zero()) - steady(pose, Vec3::Unit(axis));
    }
    const Vec3 push = least_squares(levers, left);
    K_.resize(n_, n_);
    for (Eigen::Index j = 0; j < n_; ++j) {
      Eigen::VectorXd up = pose, down = pose;
      up[j] += kStep;
      down[j] -= kStep;
      K_.col(j) = (steady(up, push) - steady(down, push)) / (2 * kStep);
    }
  }

  // Inertia and squared Jacobian at a pose.
  struct At {
    Eigen::MatrixXd M, JJ;
  };
  At at(const Eigen::VectorXd& pose) const {
    Frames frames;
    Mat<kAnyDof> M;
    Jacobian<kAnyDof> J;
    model_.frames(pose, frames);
    model_.inertia(frames, M);
    model_.point_jacobian(frames, n_ - 1, model_.tip(frames), J);
    return {M, J.transpose() * J};
  }

  // Finds J^T J q and M q, J and M those of the slow part of the motion: the hand may lead the arm
  // elsewhere meanwhile. `all`: the record with what comes before and after.
  template <class Rows>
  void lead_through(const Rows& all, Eigen::Index first) {
    hand_.resize(samples_, n_);
    moving_.resize(samples_, n_);
    const auto half = static_cast<Eigen::Index>(std::llround(kSlow / 2 / T_));
    const auto mean_about = [&](Eigen::Index sample) {
      const Eigen::Index from = std::max<Eigen::Index>(0, first + sample - half);
      const Eigen::Index to = std::min(all.rows(), first + sample + half);
      return at(all.middleRows(from, to - from).colwise().mean().transpose());
    };
    At before = mean_about(0);
    for (Eigen::Index from = 0; from < samples_; from += half) {
      const Eigen::Index count = std::min(half, samples_ - from);
      const At after = mean_about(from + half);
      const auto q = x_.middleRows(from, count);
      const Eigen::VectorXd part =
          Eigen::VectorXd::LinSpaced(half, 0, 1 - 1 / static_cast<double>(half)).head(count);
      const auto between = [&](const Eigen::MatrixXd& one, const Eigen::MatrixXd& other) {
        return Eigen::MatrixXd(q * one + part.asDiagonal() * (q * (other - one)));
      };
      hand_.middleRows(from, count) = between(before.JJ, after.JJ);
      moving_.middleRows(from, count) = between(before.M, after.M);
      before = after;
    }
  }

  // Finds the joints' friction from the direction in which they move. A cubic is fitted to
  // coarse readings.
  void rub(double encoder_step) {
    rub_ = Eigen::MatrixXd::Zero(samples_, n_);
    if (!rubs()) return;
    const auto half = std::llround(std::max(2.0, (encoder_step > 0 ? kSpan : 0) / T_));
    double s2 = 0, s4 = 0, s6 = 0;
    for (Eigen::Index i = 1; i <= half; ++i) {
      const double square = static_cast<double>(i * i);
      s2 += 2 * square;
      s4 += 2 * square * square;
      s6 += 2 * square * square * square;
    }
    const double all = s2 * s6 - s4 * s4;
    const double noise = encoder_step * std::sqrt(s6 / all / 12) / T_ + 1e-6;
    for (Eigen::Index j = 0; j < n_; ++j) {
      for (Eigen::Index k = half; k + half < samples_; ++k) {
        double v = 0;
        for (Eigen::Index i = 1; i <= half; ++i) {
          const double at = static_cast<double>(i);
          v += (s6 * at - s4 * at * at * at) * (x_(k + i, j) - x_(k - i, j));
        }
        v /= all * T_;
        rub_(k, j) = friction_[j] * v / std::sqrt(v * v + noise * noise);
      }
    }
  }

  // Computes the spectra of positions, torques and friction in all bins that count, each under a
  // window in which a line has no part beyond the next bins.
  void transform() {
    std::vector<Complex> turn(static_cast<std::size_t>(samples_));
    Eigen::MatrixXd all(samples_, kSpectra * n_);
    all << x_, tau_, rub_, hand_, moving_;
    for (Eigen::Index i = 0; i < samples_; ++i) {
      const double angle = 2 * pi * static_cast<double>(i) / static_cast<double>(samples_);
      turn[static_cast<std::size_t>(i)] = std::polar(1.0, -angle);
      all.row(i) *= (1 - std::cos(angle)) / static_cast<double>(samples_);
    }
    const int last = GripProbe::kLines.back() + kBeside;
    spectrum_.assign(static_cast<std::size_t>(last) + 1, {});
    Eigen::MatrixX2d wave(samples_, 2);
    for (int bin = GripProbe::kLines.front() - kBeside; bin <= last; ++bin) {
      for (Eigen::Index i = 0; i < samples_; ++i) {
        const Complex& at = turn[static_cast<std::size_t>(i * bin % samples_)];
        wave(i, 0) = at.real();
        wave(i, 1) = at.imag();
      }
      const Eigen::MatrixXd sums = all.transpose() * wave;
      Eigen::MatrixXcd& into = spectrum_[static_cast<std::size_t>(bin)];
      into.resize(n_, kSpectra);
      for (Eigen::Index c = 0; c < kSpectra; ++c) {
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
  Eigen::MatrixXd x_, tau_, rub_, hand_, moving_;  // a row for each sample
  Eigen::MatrixXd K_;
  Eigen::VectorXd pose_, B_, friction_;
  Vec3 gravity_ = Vec3::Zero();
  bool springy_ = false;
  double delay_ = 0, moved_ = 0, work_ = 0;
  std::vector<Eigen::MatrixXcd> spectrum_;  // by bin: columns in the order of transform()
};

// Least squares over the lines of one axis, or of all.
class GripFit {
 public:
  GripFit(const HeldDevice& device, const DeviceTrust& trust, std::optional<int> axis = {}) {
    for (const int line : GripProbe::kLines) {
      if (axis && GripProbe::axis_of(line) != *axis) continue;
      Line& now = lines_.emplace_back();
      now.at = device.equations(line);
      for (int bin = line - kBeside; bin <= line + kBeside; ++bin) {
        const bool apart = std::ranges::all_of(
            GripProbe::kLines, [&](int other) { return std::abs(bin - other) >= kGuard; });
        if (apart) now.beside.push_back(device.equations(bin));
      }
    }
    firm_[friction] = trust.friction;
    firm_[lag] = kFrictionLag;
    firm_[inertia] = trust.inertia;
    firm_[drag] = trust.damping;
    firm_[delay] = trust.delay;
    constexpr int kRounds = 6;
    fine_ = true;
    for (int round = 0; round < kRounds && fine_; ++round) solve();
  }

  bool fine() const { return fine_; }
  Bounded operator[](Eigen::Index i) const {
    const double unlike = kUnlike * theta_[i];
    const double variance = covariance_(i, i) + doubt_.row(i).squaredNorm() + unlike * unlike;
    return {theta_[i], kSure * std::sqrt(variance)};
  }

 private:
  using Theta = Eigen::Vector<double, kTerms>;
  using Fitted = Eigen::Matrix<double, kFitted, kFitted>;
  struct Line {
    Eigen::MatrixXcd at;
    std::vector<Eigen::MatrixXcd> beside;  // noise
  };

  Eigen::VectorXcd left(const Eigen::MatrixXcd& of) const {
    Eigen::VectorXcd out = of.col(kTerms);
    for (Eigen::Index i = 0; i < kTerms; ++i) out -= theta_[i] * of.col(i);
    return out;
  }
  static Gram gram(const Eigen::MatrixXcd& of, const Eigen::VectorXd& weight) {
    Gram out;
    for (Eigen::Index i = 0; i <= kTerms; ++i) {
      for (Eigen::Index j = 0; j <= kTerms; ++j) {
        out(i, j) = weight.dot(of.col(i).conjugate().cwiseProduct(of.col(j)).real());
      }
    }
    return out;
  }

  void solve() {
    Gram sums = Gram::Zero();
    double misfit = 0, count = -1.5;  // three numbers are fitted
    for (const Line& line : lines_) {
      // Noise of each joint's equation.
      Eigen::VectorXd noise = Eigen::VectorXd::Zero(line.at.rows());
      const auto size = static_cast<double>(line.beside.size());
      for (const auto& bin : line.beside) noise += left(bin).cwiseAbs2() / size;
      const double all = line.at.col(kTerms).squaredNorm() + line.at.col(inertia).squaredNorm();
      noise += kRubbed * kRubbed * line.at.col(friction).cwiseAbs2();
      noise.array() += kModelled * kModelled * all + 1e-300;
      const Eigen::VectorXd weight = noise.cwiseInverse();
      sums += gram(line.at, weight);
      misfit += left(line.at).cwiseAbs2().dot(weight);
      count += static_cast<double>(line.at.rows());
    }
    const double wrong = std::max(1.0, misfit / count);
    sums *= 2 / wrong;
    Fitted H = sums.topLeftCorner<kFitted, kFitted>();
    for (Eigen::Index i = kOfHand; i < kFitted; ++i) H(i, i) += 1 / (firm_[i] * firm_[i]);
    const Eigen::Vector<double, kFitted> scale =
        H.diagonal().cwiseAbs().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Eigen::LLT<Fitted> solver(scale.asDiagonal() * H * scale.asDiagonal());
    fine_ = solver.info() == Eigen::Success;
    if (!fine_) return;
    const Fitted scaled = solver.solve(Fitted::Identity());
    covariance_ = scale.asDiagonal() * scaled * scale.asDiagonal();
    theta_.head<kFitted>() = covariance_ * sums.topRightCorner<kFitted, 1>();
    // A fit would take the device's own inertia and damping for the hand's, and that of the hand
    // for the device's: only their doubt counts.
    for (Eigen::Index i = kFitted; i < kTerms; ++i) {
      doubt_.col(i - kFitted) = firm_[i] * (covariance_ * sums.col(i).head<kFitted>());
    }
    fine_ = theta_.allFinite() && covariance_.allFinite();
  }

  std::vector<Line> lines_;
  Theta theta_ = Theta::Zero(), firm_ = Theta::Zero();
  Fitted covariance_;
  Eigen::Matrix<double, kFitted, kTerms - kFitted> doubt_;  // standard deviations
  bool fine_ = false;
};

// Reason why a record cannot be judged; empty if it can.
std::string unfit(const GripRecord& record) {
  if (!record.begun()) return "the grip was not measured";
  if (record.duration() < GripProbe::kSettle + GripProbe::kMeasured) {
    const std::string why =
        record.ended_by() != ForceState::on
            ? fmt::format(", because the force was switched off: {}", explain(record.ended_by()))
            : "";
    return fmt::format("the measurement ended after {:.1f} of {:.4g} s{}. Measure again",
                       record.duration(), GripProbe::kDuration, why);
  }
  if (record.torn()) return "the loop stopped during the measurement: measure again";
  return {};
}

// Says how to come to know more.
std::string advice(const Grip& grip, bool rubs) {
  constexpr double kStill = 0.005;  // [m]
  constexpr double kOften = 0.2;
  std::string say = "hold the device longer";
  if (grip.moved > kStill) say += ", without moving";
  if (grip.touched > kOften) say += ", away from walls";
  if (rubs) say += "; the device's friction hides a part of the hand's effect";
  return say;
}

bool wide(const Bounded& of, double least) { return of.bound > std::max(kPart * of.value, least); }

std::string doubt(const Grip& grip, bool rubs) {
  if (grip.moved > kFarthest) {
    return fmt::format("the hand moved {:.0f} mm: hold still", 1e3 * grip.moved);
  }
  if (grip.stiffness.value < grip.stiffness.bound) {
    return "no hand holds the device, or the grip is very soft: hold the device more firmly";
  }
  const char* of = wide(grip.stiffness, 0)             ? "stiffness"
                   : wide(grip.damping, kLeastDamping) ? "damping"
                   : wide(grip.mass, kLeastMass)       ? "mass"
                                                       : nullptr;
  if (of == nullptr) return {};
  return fmt::format("the estimate of the hand's {} is uncertain: {}", of, advice(grip, rubs));
}

// Widens the bounds by what the lines of each axis alone say otherwise, beyond their own bounds: no
// hand is alike in all directions. Returns why the grip is not known then; empty: it still is.
std::string spread(const HeldDevice& device, const DeviceTrust& trust, Grip& grip) {
  struct Value {
    Term term;
    Bounded& of;
    double least, more = 0;
  };
  std::array values{Value{stiffness, grip.stiffness, 0},
                    Value{damping, grip.damping, kLeastDamping},
                    Value{mass, grip.mass, kLeastMass}};
  std::string along;
  for (int axis = 0; axis < 3; ++axis) {
    const GripFit alone(device, trust, axis);
    if (!alone.fine()) continue;
    for (Value& value : values) {
      const Bounded found = alone[value.term];
      value.more = std::max(value.more, std::abs(found.value - value.of.value) - found.bound);
    }
    along += fmt::format("{}{:.0f} N/m along {}", along.empty() ? "" : ", ", alone[stiffness].value,
                         "xyz"[axis]);
  }
  bool uneven = false;
  for (Value& value : values) {
    value.of.bound += value.more;
    uneven = uneven || wide(value.of, value.least);
  }
  return uneven ? "the hand differs between directions: " + along : "";
}

}  // namespace

void GripRecord::add(std::span<const double> force, std::span<const double> x,
                     std::span<const double> torque, bool touched) {
  force_.insert(force_.end(), force.begin(), force.end());
  x_.insert(x_.end(), x.begin(), x.end());
  torque_.insert(torque_.end(), torque.begin(), torque.end());
  touched_.push_back(touched ? 1 : 0);
}

void GripRecord::take(std::span<const double> row) {
  const auto excitation = layout_.in(row, Column::excitation);
  const bool on = std::ranges::any_of(excitation, [](double f) { return f != 0; });
  if (!on) {
    if (begun() && !ended_) {
      ended_ = true;
      ended_by_ = static_cast<ForceState>(layout_.in(row, Column::force_state)[0]);
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
    const std::vector<double> force(force_.end() - 3, force_.end());
    std::vector<double> between(n);
    for (std::size_t i = 1; i <= missing; ++i) {
      const double part = static_cast<double>(i) / static_cast<double>(missing + 1);
      for (std::size_t j = 0; j < n; ++j) between[j] = last[j] + part * (x[j] - last[j]);
      add(force, between, held, touched);
    }
  }
  time_ = time;
  real_ = std::isnan(layout_.in(row, Column::hand_torque)[0]);
  add(excitation, x, torque, touched);
}

DeviceTrust DeviceTrust::of(const ArmDescription& arm, bool real, double tick) {
  if (!real) return {1e-6, 1e-6, 0.03, 1e-3 * tick};
  if (arm.delay) return {0.03, 0.1, 0.15, 0.25 * tick};
  return {0.1, 0.3, 0.4, tick};
}

Grip find_grip(const ArmDescription& arm, const Parameters& p, const GripRecord& record) {
  Grip grip;
  grip.unknown = unfit(record);
  if (!grip.known()) return grip;
  const auto touched = std::ranges::count(record.touched(), 1);
  grip.touched = static_cast<double>(touched) / static_cast<double>(record.samples());
  const HeldDevice device(arm, p, record);
  grip.moved = device.moved();
  grip.work = device.work();
  grip.pose = device.pose();
  const DeviceTrust trust = DeviceTrust::of(arm, record.real(), record.tick());
  const GripFit fit(device, trust);
  if (!fit.fine()) {
    grip.unknown = "the hand's own motion hides the arm's response: " + advice(grip, device.rubs());
    return grip;
  }
  grip.measured = true;
  grip.stiffness = fit[stiffness];
  grip.damping = fit[damping];
  grip.mass = fit[mass];
  grip.unknown = doubt(grip, device.rubs());
  const std::string uneven = spread(device, trust, grip);
  if (grip.known()) grip.unknown = uneven;
  return grip;
}

}  // namespace limpid
