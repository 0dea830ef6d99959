// The dynamics of chains against mechanics formulated differently: points moved by finite
// differences, energies summed over links, Christoffel's symbols from differences of M.
#include "core/dynamics/arm.h"

#include <gtest/gtest.h>

#include "core/dynamics/inverse_kinematics.h"
#include "core/math/eigen.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;
using test::random_arm;
using test::Slides;
using Any = Arm<kAnyDof>;
using Vector = Vec<kAnyDof>;
using Matrix = Mat<kAnyDof>;

// A link's pose by multiplying the joints' transforms.
Pose link_pose(const ArmDescription& arm, const Vector& x, int link) {
  Pose pose = Pose::Identity();
  for (int i = 0; i <= link; ++i) {
    const Joint& joint = arm.joints[static_cast<std::size_t>(i)];
    pose = pose * joint.origin;
    if (joint.kind == Joint::Kind::prismatic) {
      pose.translate(kSlideUnit * x[i] * joint.axis);
    } else {
      pose.rotate(Eigen::AngleAxisd(x[i], joint.axis));
    }
  }
  return pose;
}

Matrix inertia_at(const Any& arm, const Vector& x) {
  Any::Frames f;
  Matrix M;
  arm.frames(x, f);
  arm.inertia(f, M);
  return M;
}

Matrix coriolis_at(const Any& arm, const Vector& x, const Vector& v) {
  Any::Frames f;
  Matrix M, C;
  arm.frames(x, f);
  arm.inertia_coriolis(f, v, M, C);
  return C;
}

// dM/dx_k, fourth-order central difference.
Matrix inertia_slope(const Any& arm, const Vector& x, int k) {
  constexpr double h = 1e-3;
  const auto at = [&](double s) {
    Vector moved = x;
    moved[k] += s * h;
    return inertia_at(arm, moved);
  };
  return (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * h);
}

class ArmOfJoints : public testing::TestWithParam<std::tuple<int, Slides>> {
 protected:
  int n() const { return std::get<0>(GetParam()); }
  unsigned seed() const { return 7 + static_cast<unsigned>(n()); }
  ArmDescription description_ = random_arm(n(), seed(), std::get<1>(GetParam()));
  Any arm_{description_};
  Random random_{seed() + 100};
  Vector x_ = random_.vector(n(), 3);
  Vector v_ = random_.vector(n(), 4);
};
INSTANTIATE_TEST_SUITE_P(Joints, ArmOfJoints,
                         testing::Combine(testing::Values(1, 2, 3, 7, 32),
                                          testing::Values(Slides::none, Slides::some,
                                                          Slides::all)));

TEST_P(ArmOfJoints, PutsLinksWhereTheTransformsOfTheJointsDo) {
  Any::Frames f;
  arm_.frames(x_, f);
  for (int i = 0; i < n(); ++i) {
    const Pose pose = link_pose(description_, x_, i);
    const auto I = static_cast<std::size_t>(i);
    EXPECT_LT((f.R[I] - pose.linear()).norm(), 1e-13);
    EXPECT_LT((f.p[I] - pose.translation()).norm(), 1e-13);
  }
  const Vec3 tip = link_pose(description_, x_, n() - 1) * description_.tip.translation();
  EXPECT_LT((arm_.tip(f) - tip).norm(), 1e-13);
}

TEST_P(ArmOfJoints, HasASymmetricPositiveDefiniteInertia) {
  for (int round = 0; round < 20; ++round) {
    const Matrix M = inertia_at(arm_, random_.vector(n(), 3));
    EXPECT_EQ(M, M.transpose());
    EXPECT_GT(symmetric_eigen(M).values.minCoeff(), 0);
  }
}

TEST_P(ArmOfJoints, HasTheKineticEnergyOfItsLinks) {
  // Rates of the poses by a central difference along v.
  constexpr double h = 1e-5;
  const Vector ahead = x_ + h * v_;
  const Vector behind = x_ - h * v_;
  double energy = 0;
  for (int i = 0; i < n(); ++i) {
    const Link& link = description_.links[static_cast<std::size_t>(i)];
    const Pose now = link_pose(description_, x_, i);
    const Pose next = link_pose(description_, ahead, i);
    const Pose last = link_pose(description_, behind, i);
    const Vec3 v = (next * link.com - last * link.com) / (2 * h);
    const Mat3 W = (next.linear() - last.linear()) / (2 * h) * now.linear().transpose();
    const Vec3 w((W(2, 1) - W(1, 2)) / 2, (W(0, 2) - W(2, 0)) / 2, (W(1, 0) - W(0, 1)) / 2);
    const Vec3 w_link = now.linear().transpose() * w;
    energy += 0.5 * link.mass * v.squaredNorm() + 0.5 * w_link.dot(link.inertia * w_link);
  }
  const Matrix M = inertia_at(arm_, x_);
  EXPECT_NEAR(0.5 * v_.dot(M * v_), energy, 1e-7 * energy);
}

TEST_P(ArmOfJoints, HasChristoffelsCoriolisMatrixEntryByEntry) {
  Matrix wanted = Matrix::Zero(n(), n());
  std::vector<Matrix> slope;
  for (int k = 0; k < n(); ++k) slope.push_back(inertia_slope(arm_, x_, k));
  const auto dM = [&](int i, int j, int k) { return slope[static_cast<std::size_t>(k)](i, j); };
  for (int i = 0; i < n(); ++i) {
    for (int j = 0; j < n(); ++j) {
      for (int k = 0; k < n(); ++k) {
        wanted(i, j) += 0.5 * (dM(i, j, k) + dM(i, k, j) - dM(j, k, i)) * v_[k];
      }
    }
  }
  const Matrix C = coriolis_at(arm_, x_, v_);
  const double size = inertia_at(arm_, x_).cwiseAbs().maxCoeff() * v_.norm();
  EXPECT_LT((C - wanted).cwiseAbs().maxCoeff(), 1e-9 * size);
}

TEST_P(ArmOfJoints, HasMdotMinusTwiceCSkew) {
  constexpr double h = 1e-4;
  const auto at = [&](double s) { return inertia_at(arm_, x_ + s * h * v_); };
  const Matrix Mdot = (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * h);
  const Matrix A = Mdot - 2 * coriolis_at(arm_, x_, v_);
  const double size = inertia_at(arm_, x_).cwiseAbs().maxCoeff() * v_.norm();
  EXPECT_LT((A + A.transpose()).cwiseAbs().maxCoeff(), 1e-8 * size);
}

TEST_P(ArmOfJoints, HasLagrangesTorqueAtConstantVelocity) {
  // d/dt (M v) - d/dx (v.M v / 2) with v held.
  Vector torque = Vector::Zero(n());
  for (int k = 0; k < n(); ++k) {
    const Matrix slope = inertia_slope(arm_, x_, k);
    torque += slope * v_ * v_[k];
    torque[k] -= 0.5 * v_.dot(slope * v_);
  }
  const Vector Cv = coriolis_at(arm_, x_, v_) * v_;
  EXPECT_LT((Cv - torque).norm(), 1e-9 * (1 + torque.norm()));
}

TEST_P(ArmOfJoints, BiasIsTheCoriolisMatrixTimesVelocityToRoundOff) {
  Any::Frames f;
  Matrix M, M_again, C;
  Vector Cv;
  arm_.frames(x_, f);
  arm_.inertia_coriolis(f, v_, M, C);
  arm_.inertia_bias(f, v_, M_again, Cv);
  EXPECT_LT((Cv - C * v_).norm(), 1e-13 * M.norm() * v_.squaredNorm());
  EXPECT_LT((M - M_again).norm(), 1e-14 * M.norm());
  EXPECT_LT((M - inertia_at(arm_, x_)).norm(), 1e-14 * M.norm());
}

TEST_P(ArmOfJoints, CoriolisMatrixIsLinearInVelocity) {
  const Vector other = random_.vector(n(), 4);
  const Matrix C = coriolis_at(arm_, x_, 2 * v_ - 3 * other);
  const Matrix sum = 2 * coriolis_at(arm_, x_, v_) - 3 * coriolis_at(arm_, x_, other);
  const double size = inertia_at(arm_, x_).norm() * (v_.norm() + other.norm());
  EXPECT_LT((C - sum).norm(), 1e-13 * size);
  // C(x, a) b = C(x, b) a: Christoffel's symbols are symmetric.
  const Vector ab = coriolis_at(arm_, x_, v_) * other;
  const Vector ba = coriolis_at(arm_, x_, other) * v_;
  EXPECT_LT((ab - ba).norm(), 1e-13 * size * other.norm());
}

TEST_P(ArmOfJoints, JacobianMovesAPointAsTheJointsDo) {
  constexpr double h = 1e-4;
  const Vec3 in_link(0.031, -0.017, 0.043);
  const int link = (n() - 1) / 2 + (n() > 2 ? 1 : 0);
  Any::Frames f;
  Jacobian<kAnyDof> J;
  arm_.frames(x_, f);
  arm_.point_jacobian(f, link, Any::point(f, link, in_link), J);
  ASSERT_EQ(J.cols(), n());
  for (int k = 0; k < n(); ++k) {
    Vector ahead = x_, behind = x_;
    ahead[k] += h;
    behind[k] -= h;
    const Vec3 slope = (link_pose(description_, ahead, link) * in_link -
                        link_pose(description_, behind, link) * in_link) /
                       (2 * h);
    EXPECT_LT((J.col(k) - slope).norm(), 1e-8) << "joint " << k;
  }
}

TEST(Arm, OfThreeJointsIsTheSameWithFixedAndWithAnySize) {
  const ArmDescription description = random_arm(3, 5);
  const Arm<3> fixed(description);
  const Any any(description);
  Random random(6);
  for (int round = 0; round < 50; ++round) {
    const Eigen::VectorXd x = random.vector(3, 3), v = random.vector(3, 5);
    Arm<3>::Frames f;
    Any::Frames g;
    Mat<3> M, C;
    Matrix M_any, C_any;
    Vec<3> Cv;
    fixed.frames(x, f);
    any.frames(x, g);
    fixed.inertia_coriolis(f, v, M, C);
    any.inertia_coriolis(g, v, M_any, C_any);
    fixed.inertia_bias(f, v, M, Cv);
    EXPECT_LT((M - M_any).norm(), 1e-15 + 1e-14 * M.norm());
    EXPECT_LT((C - C_any).norm(), 1e-15 + 1e-13 * C.norm());
    EXPECT_LT((Cv - C_any * v).norm(), 1e-14 + 1e-13 * C.norm() * v.norm());
    EXPECT_LT((fixed.tip(f) - any.tip(g)).norm(), 1e-15);
  }
}

TEST(Arm, OfOneJointIsAPendulum) {
  const ArmDescription description = random_arm(1, 9);
  const Link& link = description.links[0];
  // The axis passes through the link's origin and is fixed in the link.
  const Vec3 a = description.joints[0].axis;
  const double lever2 = link.com.squaredNorm() - std::pow(link.com.dot(a), 2);
  const double inertia = a.dot(link.inertia * a) + link.mass * lever2;
  const Any arm(description);
  EXPECT_NEAR(inertia_at(arm, Vector::Constant(1, 0.7))(0, 0), inertia, 1e-16);
  EXPECT_NEAR(coriolis_at(arm, Vector::Constant(1, 0.7), Vector::Constant(1, 3))(0, 0), 0, 1e-16);
}

TEST(Arm, OfTwoLinksInAPlaneIsTheTextbooks) {
  // Craig, Introduction to Robotics, example 6.7: point masses at the ends of massless links.
  constexpr double l1 = 0.3, l2 = 0.2, m1 = 0.4, m2 = 0.5;
  ArmDescription description;
  description.joints.resize(2);
  description.links.resize(2);
  description.joints[1].origin.translation() = Vec3(l1, 0, 0);
  description.links[0].mass = m1;
  description.links[0].com = Vec3(l1, 0, 0);
  description.links[1].mass = m2;
  description.links[1].com = Vec3(l2, 0, 0);
  const Any arm(description);
  Vector x(2), v(2);
  x << 0.4, 1.1;
  v << 1.7, -2.3;
  const double c2 = std::cos(x[1]), s2 = std::sin(x[1]);
  const Matrix M = inertia_at(arm, x);
  EXPECT_NEAR(M(0, 0), l2 * l2 * m2 + 2 * l1 * l2 * m2 * c2 + l1 * l1 * (m1 + m2), 1e-15);
  EXPECT_NEAR(M(0, 1), l2 * l2 * m2 + l1 * l2 * m2 * c2, 1e-15);
  EXPECT_NEAR(M(1, 1), l2 * l2 * m2, 1e-15);
  const Vector Cv = coriolis_at(arm, x, v) * v;
  const double k = m2 * l1 * l2 * s2;
  EXPECT_NEAR(Cv[0], -k * v[1] * v[1] - 2 * k * v[0] * v[1], 1e-15);
  EXPECT_NEAR(Cv[1], k * v[0] * v[0], 1e-15);
}

TEST(Arm, ThatTurnsASlideIsTheTextbooks) {
  // A mass m at the distance r on a slide that turns: m (r^2 w^2 + rdot^2) / 2, Coriolis' torque
  // 2 m r rdot w and the centrifugal force m r w^2. A unit of the slide is 10 cm.
  constexpr double m = 0.4, start = 0.25;
  ArmDescription description;
  description.joints.resize(2);
  description.links.resize(2);
  description.joints[1].kind = Joint::Kind::prismatic;
  description.joints[1].axis = Vec3::UnitX();
  description.joints[1].origin.translation() = Vec3(start, 0, 0);
  description.links[1].mass = m;
  const Any arm(description);
  Vector x(2), v(2);
  x << 0.4, 1.1;
  v << 1.7, -2.3;
  const double r = start + 0.1 * x[1];
  const Matrix M = inertia_at(arm, x);
  EXPECT_NEAR(M(0, 0), m * r * r, 1e-16);
  EXPECT_NEAR(M(0, 1), 0, 1e-16);
  EXPECT_NEAR(M(1, 1), m * 0.01, 1e-17);
  const Vector Cv = coriolis_at(arm, x, v) * v;
  EXPECT_NEAR(Cv[0], 2 * m * r * (0.1 * v[1]) * v[0], 1e-15);
  EXPECT_NEAR(Cv[1], -0.1 * m * r * v[0] * v[0], 1e-15);
  EXPECT_NEAR(reach(description), 0.25, 1e-15);  // an unlimited travel is not counted
  description.joints[1].lower = -0.5;
  description.joints[1].upper = 2;
  EXPECT_NEAR(reach(description), 0.45, 1e-15);
}

// The slides reach the farthest corner of the box that they span, not the sum of its edges.
TEST(Arm, OfSlidesAcrossEachOtherReachesAsFarAsTheirBox) {
  ArmDescription description;
  for (int i = 0; i < 3; ++i) {
    Joint joint;
    joint.kind = Joint::Kind::prismatic;
    joint.axis = Vec3::Unit(i);
    joint.lower = -1;
    joint.upper = 2 + i;
    joint.origin.translation() = Vec3(0.1, 0, 0);  // the first one's is the arm's place
    description.joints.push_back(joint);
  }
  EXPECT_NEAR(reach(description), Vec3(0.1 + 0.1 + 0.2, 0.3, 0.4).norm(), 1e-15);
  // The turn applies to the following slides as well.
  description.joints[1].origin.linear() = Eigen::AngleAxisd(0.3, Vec3::UnitX()).toRotationMatrix();
  EXPECT_NEAR(reach(description),
              Vec3(0.4, 0.3 * std::cos(0.3) + 0.1 * std::sin(0.3),
                   0.3 * std::sin(0.3) + 0.4 * std::cos(0.3))
                  .norm(),
              1e-15);
}

TEST(Arm, TurnsItsAnglesOnToRoundOff) {
  Random random(141);
  const Any arm(random_arm(5, 140));
  for (const double size : {1e-9, 1e-4, 0.0099, 0.01, 0.0101, 0.02, 0.0299, 0.0301, 0.5, 3.0}) {
    for (int round = 0; round < 200; ++round) {
      const Vector x = random.vector(5, 3);
      Vector dx = random.vector(5, size);
      dx[0] = size;
      const auto turned = arm.turned(arm.angles(x), dx);
      for (int i = 0; i < 5; ++i) {
        // Bound: a rounding of each of the sines, products and the sum; the sum x + dx rounds, too.
        ASSERT_NEAR(turned.sin[i], std::sin(x[i] + dx[i]), 1e-15) << size;
        ASSERT_NEAR(turned.cos[i], std::cos(x[i] + dx[i]), 1e-15) << size;
      }
    }
  }
}

TEST(Arm, TurnsExactlyByTheSineOfASmallStep) {
  // From zero only the series counts; its error is a last digit of the small angle.
  const Any arm(random_arm(1, 142));
  for (double d = -0.03; d <= 0.03; d += 1.7e-4) {
    const Vector dx = Vector::Constant(1, d);
    const auto turned = arm.turned(arm.angles(Vector::Zero(1)), dx);
    ASSERT_NEAR(turned.sin[0], std::sin(d), 4e-16 * std::abs(d));
    ASSERT_NEAR(turned.cos[0], std::cos(d), 2.3e-16);
  }
}

}  // namespace
}  // namespace limpid
