// A trembling hand that taps a wall, holds it and presses slowly, and what comes of it.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "core/dynamics/arm.h"
#include "core/math/eigen.h"
#include "core/math/high_pass.h"
#include "devices/simulated/rig.h"

namespace limpid::test {

// Effective values of fast motion and force along the wall's normal.
class Buzz {
 public:
  explicit Buzz(double T) : speeds_(kFast, 1 / T), forces_(kFast, 1 / T) {}
  void add(double speed, double force, bool counts) {
    const double v = speeds_(speed), F = forces_(force);
    if (!counts) return;
    speed2_ += v * v;
    force2_ += F * F;
    ++count_;
  }
  double speed() const { return std::sqrt(speed2_ / count_); }  // of the tip [m/s]
  double force() const { return std::sqrt(force2_ / count_); }  // of the motors there [N]

 private:
  static constexpr double kFast = 20;  // [Hz]
  HighPass speeds_, forces_;
  double speed2_ = 0, force2_ = 0, count_ = 0;
};

// Slope of a line through points.
class Slope {
 public:
  void add(double x, double y) { ++n_, x_ += x, y_ += y, xx_ += x * x, xy_ += x * y; }
  double value() const { return (n_ * xy_ - x_ * y_) / (n_ * xx_ - x_ * x_); }

 private:
  double n_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0;
};

struct Pressed {
  double held_speed = 0, held_force = 0;      // see Buzz, while the hand holds still
  double moving_speed = 0, moving_force = 0;  // while it presses slowly
  double felt = 0;   // slope of force on depth in the slow press, over the wall's stiffness [-]
  double given = 0;  // most energy of the motors beyond what damping and friction took [J]
  bool diverged = false;
};

struct Press {
  double wall = 1000;  // [N/m]
  double force = 1.5;  // of the hand while it holds [N]

  static constexpr double kAbove = 0.012, kSpeed = 0.15;        // [m], [m/s]
  static constexpr double kWait = 0.1, kHold = 0.5, kSlow = 2;  // [s]
  static constexpr double kHeld = 0.25, kSettled = 0.1;  // last part held, first of the press [s]
  static constexpr double kTremor = 1.0 / 30;            // of the force [-]

  // Presses from `start` with the grip, mass, law and device of `p`, on a wall across `out` that is
  // kAbove below.
  Pressed on(const ArmDescription& description, const RigStart& start, const Vec3& out,
             const Parameters& p) const {
    Scene scene;
    scene.add({"", pose_at(start.target - kAbove * out), Plane{out}, {wall}});
    Rig rig(description, scene);
    rig.start(p, start);
    const double T = p.tick, pressed = begins(p), end = pressed + kSlow;
    Buzz held(T), moving(T);
    Slope slope;
    Pressed result;
    double rubbed = 0;
    const Arm<kAnyDof> arm(description);
    Sample before;
    std::vector<double> row(static_cast<std::size_t>(rig.layout().stride()));
    for (int k = 0; k * T < end; ++k) {
      rig.step(p, {{start.target - way(k * T, p) * out, 1}}, row);
      if (rig.diverged()) return {.diverged = true};
      const Sample now = sample(arm, rig.layout(), row, out);
      if (k > 0) {
        const double t = k * T, speed = (now.tip - before.tip).dot(out) / T;
        const double depth = -(now.tip + before.tip - 2 * start.target).dot(out) / 2 - kAbove;
        held.add(speed, before.force, t > pressed - kHeld && t < pressed);
        moving.add(speed, before.force, t > pressed + kSettled);
        if (t > pressed + kSettled && depth > 0) slope.add(depth, before.force);
        for (std::size_t i = 0; i < description.joints.size(); ++i) {
          const double friction =
              std::isnan(p.friction) ? description.joints[i].friction : p.friction;
          const auto j = static_cast<Eigen::Index>(i);
          rubbed += friction * std::abs(now.x[j] - before.x[j]);
        }
        result.given = std::max(result.given, now.port - rubbed);
      }
      before = now;
    }
    return {held.speed(),         held.force(), moving.speed(), moving.force(),
            slope.value() / wall, result.given, false};
  }

 private:
  struct Sample {
    Eigen::VectorXd x{};      // [rad]
    Vec3 tip = Vec3::Zero();  // [m]
    double force = 0;         // of the motors at the tip, out of the wall [N]
    double port = 0;          // [J]
  };
  static Sample sample(const Arm<kAnyDof>& arm, const RowLayout& layout,
                       std::span<const double> row, const Vec3& out) {
    const auto column = [&](Column c) -> Eigen::VectorXd {
      return Eigen::Map<const Eigen::VectorXd>(layout.in(row, c).data(), layout.width(c));
    };
    Sample s;
    s.x = column(Column::device_position);
    Arm<kAnyDof>::Frames frames;
    arm.frames(s.x, frames);
    s.tip = arm.tip(frames);
    Jacobian<kAnyDof> J;
    arm.point_jacobian(frames, arm.dof() - 1, s.tip, J);
    s.force = out.dot(Vec3(least_squares(J.transpose(), column(Column::motor_torque))));
    s.port = layout.in(row, Column::energy_port)[0];
    return s;
  }

  double down(const Parameters& p) const {
    return kAbove + force / p.hand_stiffness + force / wall;
  }
  double begins(const Parameters& p) const { return kWait + down(p) / kSpeed + kHold; }
  // How far the hand's target is below its start [m].
  double way(double t, const Parameters& p) const {
    constexpr double kTurn = 2 * std::numbers::pi;
    const double slowly = 0.6 + 0.4 * std::cos(kTurn * (t - begins(p)));
    const double way = t > begins(p) ? kAbove + (down(p) - kAbove) * slowly
                                     : std::clamp(kSpeed * (t - kWait), 0.0, down(p));
    const double trembles = std::sin(kTurn * 9.1 * t) + 0.3 * std::sin(kTurn * 6.3 * t + 1);
    return way - kTremor * force / p.hand_stiffness * trembles;
  }
};

}  // namespace limpid::test
