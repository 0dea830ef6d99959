#include "app/experiments/body_theory.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <vector>

namespace limpid {
namespace {

constexpr double g = kStandardGravity;

// A solid's principal moments by summing over a grid of its bounding box.
Vec3 summed_moments(double mass, const Vec3& half,
                    const std::function<bool(const Vec3& at)>& inside) {
  constexpr int n = 120;
  Vec3 moments = Vec3::Zero();
  long count = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < n; ++k) {
        const Vec3 at = half.cwiseProduct((2 * Vec3(i, j, k) + Vec3::Ones()) / n - Vec3::Ones());
        if (!inside(at)) continue;
        const Vec3 squares = at.cwiseProduct(at);
        moments += Vec3::Constant(squares.sum()) - squares;
        ++count;
      }
    }
  }
  return mass / static_cast<double>(count) * moments;
}

void expect_near(const Vec3& a, const Vec3& b, double part) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], part * b[i]) << i;
}

TEST(Moments, AreTheSumsOverTheSolid) {
  const double m = 0.7, r = 0.02, l = 0.05;
  expect_near(ball_moments(m, r),
              summed_moments(m, Vec3::Constant(r), [&](const Vec3& x) { return x.norm() < r; }),
              0.01);
  expect_near(box_moments(m, {0.02, 0.04, 0.1}),
              summed_moments(m, {0.01, 0.02, 0.05}, [](const Vec3&) { return true; }), 0.01);
  expect_near(
      cylinder_moments(m, r, l),
      summed_moments(m, {r, r, l / 2}, [&](const Vec3& x) { return x.head<2>().norm() < r; }),
      0.01);
  expect_near(capsule_moments(m, r, l),
              summed_moments(m, {r, r, l / 2 + r},
                             [&](const Vec3& x) {
                               const double beyond = std::max(0.0, std::abs(x.z()) - l / 2);
                               return Vec3(x.x(), x.y(), beyond).norm() < r;
                             }),
              0.01);
}

// A step of the classical Runge-Kutta method.
using State = Eigen::VectorXd;
using Change = std::function<State(const State&)>;
void go_on(State& x, const Change& f, double h) {
  const State a = f(x), b = f(x + h / 2 * a), c = f(x + h / 2 * b), d = f(x + h * c);
  x += h / 6 * (a + 2 * b + 2 * c + d);
}

// A round body on a slope, held by a stiff spring and damper where it touches: it sticks.
TEST(Rolling, IsTheMotionOfABodyWhosePointOfContactSticks) {
  const double m = 0.05, r = 0.02, slope = 0.4;
  for (const double I : {0.4 * m * r * r, 0.5 * m * r * r, 0.47 * m * r * r}) {
    const auto change = [&](const State& x) {  // way, speed, angle, turning
      const double push = -1e5 * (x[0] - r * x[2]) - 50 * (x[1] - r * x[3]);
      return State{{x[1], g * std::sin(slope) + push / m, x[3], -r * push / I}};
    };
    State x = State::Zero(4);
    for (int k = 0; k < 50000; ++k) go_on(x, change, 1e-5);
    EXPECT_NEAR(x[1] / 0.5, rolling(slope, m, r, I), 1e-3);
  }
}

TEST(Sliding, HasWeightAndFrictionAlongTheSlope) {
  const double slope = 0.5, friction = 0.3;
  const Vec3 normal(std::sin(slope), 0, std::cos(slope)), weight(0, 0, -g);
  const double pressed = -weight.dot(normal);
  const Vec3 along = weight + pressed * normal;  // what is left of the weight on the slope
  EXPECT_NEAR(sliding(slope, friction), along.norm() - friction * pressed, 1e-12);
  EXPECT_NEAR(sliding(std::atan(friction), friction), 0, 1e-12);
}

// The lower edge carries a block whose centre is above it, and no other.
TEST(Tipping, IsWhereTheCentreIsAboveTheLowerEdge) {
  const double slope = tipping(0.02, 0.04);
  const Vec3 centre = Eigen::AngleAxisd(slope, Vec3::UnitY()) * Vec3(-0.01, 0, 0.02);
  EXPECT_NEAR(centre.x(), 0, 1e-12);
}

TEST(PendulumPeriod, IsThatOfItsEquationOfMotion) {
  const double m = 0.05, l = 0.05, I = 2e-4;
  const auto change = [&](const State& x) {
    return State{{x[1], -m * g * l / I * std::sin(x[0])}};
  };
  for (const double amplitude : {0.1, 1.5, 2.5, 3.0}) {
    State x{{-amplitude, 0.0}};
    double t = 0, before = 0;
    const double h = 1e-4;
    while (x[0] < 0) {  // a quarter
      before = x[0];
      go_on(x, change, h);
      t += h;
    }
    t -= h * x[0] / (x[0] - before);
    EXPECT_NEAR(4 * t, pendulum_period(m, l, I, amplitude), 1e-6) << amplitude;
  }
}

// A heavy top about its fixed point: place of its axis, and angular momentum in the world.
TEST(Precession, IsSteadyInTheTopsEquationsOfMotion) {
  const double m = 0.2, l = 0.05, along = 1.6e-4, across = 6e-4, spin = 150;
  const auto change = [&](const State& x) {
    const Vec3 axis = x.head<3>(), L = x.tail<3>();
    const Vec3 w = L / across + (1 / along - 1 / across) * axis.dot(L) * axis;
    State d(6);
    d << w.cross(axis), l * axis.cross(Vec3(0, 0, -m * g));
    return d;
  };
  const double rate = precession(m, l, along, spin);
  State x(6);
  x << 1, 0, 0, along * spin, 0, across * rate;
  const double seconds = 0.5, h = 1e-5;
  for (int k = 0; k < 50000; ++k) go_on(x, change, h);
  EXPECT_NEAR(std::atan2(x[1], x[0]) / seconds, rate, 1e-6 * rate);
  EXPECT_NEAR(x[2], 0, 1e-6);
}

TEST(Ways, AreThoseOfTheEquationsOfMotion) {
  State braked{{0.0, 0.5}}, drawn{{0.0, 0.0}};
  const auto brakes = [](const State& x) { return State{{x[1], -2 / 0.5 * x[1]}}; };
  const auto draws = [](const State& x) {
    return State{{x[1], (10 * (0.02 - x[0]) - 30 * x[1]) / 0.5}};
  };
  for (int k = 0; k < 7000; ++k) {
    go_on(braked, brakes, 1e-4);
    go_on(drawn, draws, 1e-4);
  }
  EXPECT_NEAR(braked[0], braked_way(0.5, 2, 0.5, 0.7), 1e-10);
  EXPECT_NEAR(drawn[0], drawn_way(0.5, 30, 10, 0.02, 0.7), 1e-10);
}

// Torque-free motion in the world instead of in the body's frame: angular momentum stands still,
// the attitude is turned by what it says.
TEST(FreeSpin, TurnsOverWhenTheAttitudeSaysSo) {
  const Vec3 I(2.6, 1, 3.4), spin(12, 0.12, 0.12);
  const Vec3 L = I.cwiseProduct(spin);
  Mat3 R = Mat3::Identity();
  const auto own = [&] { return Vec3((R.transpose() * L).cwiseQuotient(I)); };
  std::vector<double> crossings;
  const double h = 1e-5;
  double before = spin.x();
  for (int k = 0; k < 500000; ++k) {
    // Turned by the angular velocity in the middle of the step.
    const Mat3 start = R;
    const Vec3 half = own() * h / 2;
    R = start * Eigen::AngleAxisd(half.norm(), half.normalized());
    const Vec3 whole = own() * h;
    R = start * Eigen::AngleAxisd(whole.norm(), whole.normalized());
    if (before * own().x() < 0) crossings.push_back(h * (k + 1));
    before = own().x();
  }
  ASSERT_GE(crossings.size(), 3u);
  FreeSpin euler(I, spin, 1e-5);
  EXPECT_NEAR(euler.turned_over(1, 5), crossings[0], 1e-4);
  EXPECT_NEAR(euler.turned_over(2, 5), crossings[2], 1e-4);
  EXPECT_TRUE(std::isnan(FreeSpin(I, {12, 0, 0}, 1e-3).turned_over(1, 1)));
}

// Balls of stiff springs between them and at the wall, which lose nothing.
TEST(BallsAndWall, LeaveAsStiffSpringsThrowThem) {
  for (const double right : {0.03, 0.05, 0.1, 0.4}) {
    const double left = 0.05, K = 1e6, wall = 0.1;
    const auto change = [&](const State& x) {  // places and speeds
      const double between = K * std::max(0.0, x[0] - x[1]),
                   at_wall = K * std::max(0.0, x[1] - wall);
      return State{{x[2], x[3], -between / left, (between - at_wall) / right}};
    };
    State x{{-0.02, 0.0, 1.0, 0.0}};
    for (int k = 0; k < 200000; ++k) go_on(x, change, 5e-6);
    BallsAndWall balls{{left, right}, {1, 0}, 1};
    balls.meet_to_the_end();
    EXPECT_NEAR(balls.speed[0], x[2], 2e-3) << right;
    EXPECT_NEAR(balls.speed[1], x[3], 2e-3) << right;
    EXPECT_NEAR(balls.energy(), left / 2, 1e-12);
  }
}

TEST(BallsAndWall, PartWithTheShareOfTheSpeedAtWhichTheyCame) {
  BallsAndWall balls{{0.05, 0.2}, {1, -0.3}, 0.6};
  const double before = balls.momentum();
  balls.meet();
  EXPECT_NEAR(balls.speed[1] - balls.speed[0], 0.6 * 1.3, 1e-14);
  EXPECT_NEAR(balls.momentum(), before, 1e-15);
}

}  // namespace
}  // namespace limpid
