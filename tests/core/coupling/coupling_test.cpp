#include "core/coupling/coupling.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/coupling/feedforward.h"
#include "core/coupling/link.h"
#include "core/touch/proxy.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;

constexpr std::array kPaperDamping{0.012, 0.012, 0.012};

TEST(Condition3, HoldsWithThePapersGainsWhichStandOnItsEdge) {
  // b_d = 0.012 = 2 * 0.001 + 10 * 0.001, to round-off; b_v = 0.012 > 0.005.
  const Condition3 c = condition3(SpringDamper{}, 0.001, kPaperDamping);
  EXPECT_TRUE(c.holds);
  EXPECT_NEAR(c.device_margin, 0, 1e-17);
  EXPECT_NEAR(c.proxy_margin, 0.007, 1e-17);
}

TEST(Condition3, BreaksJustBeyondTheEdge) {
  SpringDamper p;
  EXPECT_FALSE(condition3(p, 0.00100001, kPaperDamping).holds);
  p.k_vc = 10 * (1 + 1e-9);
  EXPECT_FALSE(condition3(p, 0.001, kPaperDamping).holds);
  p = {};
  p.b_v = 0.00499;
  const Condition3 c = condition3(p, 0.001, kPaperDamping);
  EXPECT_FALSE(c.holds);
  EXPECT_NEAR(c.proxy_margin, -1e-5, 1e-15);
}

TEST(Condition3, CountsTheLeastDampedJoint) {
  const Condition3 c = condition3(SpringDamper{}, 0.001, std::array{0.5, 0.011, 0.02});
  EXPECT_FALSE(c.holds);
  EXPECT_NEAR(c.device_margin, -0.001, 1e-15);
}

// Energy given to device and proxy over motions that end where they begin, less the work of their
// dampers [J]. The device's torque acts d ticks late.
double given(const SpringDamper& p, double b_d, int d, const std::vector<double>& dx1,
             const std::vector<double>& dx2) {
  constexpr double T = 0.001;
  const std::size_t n = dx1.size();
  std::vector<double> x1{0}, x2{0}, wanted;
  double energy = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const double v1 = k > 0 ? dx1[k - 1] / T : 0, v2 = k > 0 ? dx2[k - 1] / T : 0;
    wanted.push_back(-p.k_vc * (x1[k] - x2[k]) - p.b_vc * (v1 - v2));
    const double late =
        k >= static_cast<std::size_t>(d) ? wanted[k - static_cast<std::size_t>(d)] : 0;
    const double tau2 = -p.k_vc * (x2[k] + dx2[k] / 2 - x1[k]) - p.b_vc * (dx2[k] / T - v1);
    energy += late * dx1[k] - b_d / T * dx1[k] * dx1[k];
    energy += tau2 * dx2[k] - p.b_v / T * dx2[k] * dx2[k];
    x1.push_back(x1[k] + dx1[k]);
    x2.push_back(x2[k] + dx2[k]);
  }
  return energy;
}

// Largest energy given over motions of every frequency up to half the tick rate, in phase and
// against one another.
double most_given(const SpringDamper& p, double b_d, int d) {
  double most = -1;
  for (const double part : {0.01, 0.05, 0.1, 0.2, 0.3, 0.5}) {
    for (const double ratio : {0.0, 0.3, 1.0, -0.3, -1.0}) {
      std::vector<double> dx1, dx2;
      for (int k = 0; k < 4000; ++k) {
        dx1.push_back(1e-4 * std::cos(2 * 3.14159265358979 * part * k));
        dx2.push_back(ratio * dx1.back());
      }
      most = std::max(most, given(p, b_d, d, dx1, dx2));
    }
  }
  return most;
}

// The energy books alone decide: no model of arm, proxy or hand.
TEST(Condition3, BoundsWhatADelayedDeviceCanBeGiven) {
  Random random(71);
  for (const int d : {0, 1, 3, 8}) {
    SpringDamper p;
    const double delay = 1e-3 * d, b_d = 2 * p.b_vc + p.k_vc * (0.001 + 1.5 * delay);
    p.b_v = p.k_vc * (0.001 + delay) / 2;
    EXPECT_TRUE(condition3(p, 0.001, std::array{b_d}, delay).holds);
    EXPECT_FALSE(condition3(p, 0.001, std::array{0.999 * b_d}, delay).holds);
    EXPECT_LE(most_given(p, b_d, d), 1e-9) << d;
    for (int round = 0; round < 50; ++round) {
      std::vector<double> dx1, dx2;
      for (int k = 0; k < 500; ++k) {
        dx1.push_back(random.between(-1e-4, 1e-4));
        dx2.push_back(random.between(-1e-4, 1e-4));
      }
      EXPECT_LE(given(p, b_d, d, dx1, dx2), 1e-12) << d;
    }
    if (d == 0) continue;
    p.b_v = p.k_vc * 0.001 / 2;  // the bound of (3) without a delay
    EXPECT_GT(most_given(p, 2 * p.b_vc + p.k_vc * 0.001, d), 1e-6) << d;
  }
}

// The same through a link: each side knows the other as it was `age` ticks ago.
double given_through_link(const SpringDamper& p, double b_d, const std::vector<int>& age1,
                          const std::vector<int>& age2, const std::vector<double>& dx1,
                          const std::vector<double>& dx2) {
  constexpr double T = 0.001;
  const std::size_t n = dx1.size();
  std::vector<double> x1{0}, x2{0}, v1{0}, v2{0};
  double energy = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const auto old = [k](const std::vector<int>& age) {
      return k - std::min(k, static_cast<std::size_t>(age[k]));
    };
    const std::size_t of1 = old(age1), of2 = old(age2);
    const double tau1 = -p.k_vc * (x1[k] - x2[of2]) - p.b_vc * (v1[k] - v2[of2]);
    const double tau2 = -p.k_vc * (x2[k] + dx2[k] / 2 - x1[of1]) - p.b_vc * (dx2[k] / T - v1[of1]);
    energy += tau1 * dx1[k] - b_d / T * dx1[k] * dx1[k];
    energy += tau2 * dx2[k] - p.b_v / T * dx2[k] * dx2[k];
    x1.push_back(x1[k] + dx1[k]);
    x2.push_back(x2[k] + dx2[k]);
    v1.push_back(dx1[k] / T);
    v2.push_back(dx2[k] / T);
  }
  return energy;
}

struct Tagged {
  double number = 0;
  static auto parts(auto& p) { return std::array{std::span(&p.number, std::size_t{1})}; }
  void come_to_rest() {}
};

std::vector<int> ages(const LinkSettings& s, std::uint64_t direction, int ticks) {
  OneWay<Tagged> channel(direction, {});
  std::vector<int> ages;
  for (int k = 0; k < ticks; ++k) {
    ages.push_back(k - static_cast<int>(channel.pass({static_cast<double>(k)}, s).number));
  }
  return ages;
}

// The energy books alone decide, on the edge of the condition and, where only the delay counts,
// beyond it.
TEST(Condition3, BoundsWhatDeviceAndProxyCanBeGivenThroughALink) {
  Random random(72);
  for (const auto& [delay, jitter] : {std::pair(1, 0), {5, 0}, {40, 0}, {0, 4}, {10, 10}}) {
    const LinkSettings s{.link_delay = delay, .link_jitter = jitter};
    SpringDamper p;
    p.b_vc = 0.004;
    const double old = 1e-3 * (delay + jitter), again = 0.5 * jitter * p.b_vc;
    const double b_d = 2 * p.b_vc + again + p.k_vc * (0.001 + old);
    p.b_v = again + p.k_vc * (0.0005 + old);
    EXPECT_TRUE(condition3(p, 0.001, std::array{b_d}, 0, s).holds);
    EXPECT_FALSE(condition3(p, 0.001, std::array{0.999 * b_d}, 0, s).holds);
    SpringDamper less = p;
    less.b_v *= 0.999;
    EXPECT_FALSE(condition3(less, 0.001, std::array{b_d}, 0, s).holds);
    for (int round = 0; round < 60; ++round) {
      const int ticks = 2000;
      const auto age1 = ages({delay, jitter, 0, 1 + round}, 1, ticks);
      const auto age2 = ages({delay, jitter, 0, 1 + round}, 2, ticks);
      const double part = random.log_between(1e-3, 0.5), phase = random.between(-3.2, 3.2);
      const double ratio = random.log_between(0.3, 3), noise = random.one_of({0.0, 0.3, 3.0});
      std::vector<double> dx1, dx2;
      for (int k = 0; k < ticks; ++k) {
        const double angle = 2 * 3.14159265358979 * part * k;
        dx1.push_back(1e-4 * (std::cos(angle) + noise * random.between(-1, 1)));
        dx2.push_back(1e-4 * ratio * (std::cos(angle + phase) + noise * random.between(-1, 1)));
      }
      EXPECT_LE(given_through_link(p, b_d, age1, age2, dx1, dx2), 1e-9) << delay << ' ' << jitter;
    }
    if (delay < 5 || jitter > 0) continue;
    // Slow motions against one another: a tenth less damping is too little by far.
    std::vector<double> dx1, dx2;
    for (int k = 0; k < 40000; ++k) {
      dx1.push_back(1e-4 * std::cos(2 * 3.14159265358979 * 1e-3 * k));
      dx2.push_back(-dx1.back());
    }
    less.b_v = 0.9 * p.k_vc * old;
    less.b_vc = 0;
    EXPECT_GT(given_through_link(less, less.b_v, ages(s, 1, 40000), ages(s, 2, 40000), dx1, dx2),
              1e-6)
        << delay;
  }
}

TEST(Condition3, KnowsNoBoundWherePacketsAreLost) {
  SpringDamper p;
  p.b_v = 10;
  const Condition3 c = condition3(p, 0.001, std::array{10.0}, 0, {.link_loss = 0.01});
  EXPECT_GT(c.device_margin, 0);
  EXPECT_FALSE(c.known);
  EXPECT_FALSE(c.holds);
}

struct Random2 {
  explicit Random2(int n, unsigned seed) : random(seed) {
    one.M = random.positive_definite(n, 1e-4, 1e-3);
    two.M = random.positive_definite(n, 1e-5, 1e-4);
    one.C = random.matrix(n, 1e-3);
    two.C = random.matrix(n, 1e-4);
    one.v = random.vector(n, 3);
    two.v = random.vector(n, 3);
    f1 = random.vector(n, 0.5);
    f2 = random.vector(n, 0.5);
  }
  Random random;
  Dynamics<kAnyDof> one, two;
  Eigen::VectorXd f1, f2;
};

class CouplingOfJoints : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Arms, CouplingOfJoints, testing::Values(1, 2, 3, 7, 32));

// The law ignores eta and all forces.
TEST_P(CouplingOfJoints, StandardIsSpringAndDamperAlone) {
  const int n = GetParam();
  Random2 r(n, 70);
  Proxy<kAnyDof> proxy(test::random_arm(n, 70), Scene{});
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd x1 = r.random.vector(n, 1), x2 = r.random.vector(n, 1);
    const Eigen::VectorXd v1 = r.random.vector(n, 1), vbar2 = r.random.vector(n, 1);
    proxy.place(x2, r.two.v, 0.1);
    LawSettings p;
    p.k_vc = 7;
    p.b_vc = 0.3;
    p.eta = 0.3;
    Coupling<kAnyDof> coupling;
    const Vec<kAnyDof> x = x1, v = v1, f1 = r.f1, vbar = vbar2;
    // Half of the time gains grow with the damping of the joints.
    p.per_joint = i % 2 == 1;
    const Vec<kAnyDof> b = 0.02 * (r.random.vector(n, 1).array() + 1.1);
    const Vec<kAnyDof> limit = Eigen::VectorXd::Constant(n, 1);
    const Arm<kAnyDof>::Frames frames{};
    const LawInput<kAnyDof> in{x, v, r.one, f1, vbar, 0.001, frames, b, b, limit, 1, 0.001, 0, 0};
    const Eigen::VectorXd tau = coupling.step(CouplingKind::standard, p, in, proxy);
    const Eigen::VectorXd mean = proxy.vbar();
    Eigen::VectorXd on_device(n), on_proxy(n);
    for (int j = 0; j < n; ++j) {
      const double more = p.per_joint ? b[j] / b.minCoeff() : 1;
      const double k_vc = 7 * more, b_vc = 0.3 * more, b_v = p.b_v * more;
      on_device[j] = -b_vc * (v1[j] - vbar2[j]) - k_vc * (x1[j] - x2[j]);
      on_proxy[j] =
          b_vc * (v1[j] - mean[j]) - k_vc * (x2[j] + 0.001 / 2 * mean[j] - x1[j]) - b_v * mean[j];
    }
    EXPECT_LT((tau - on_device).norm(), 1e-13 * (1 + on_device.norm()));
    EXPECT_LT((proxy.tau() - on_proxy).norm(), 1e-12 * (1 + on_proxy.norm()));
  }
}

TEST(Laws, AreKnownByTheirKeysAndTakenByTurns) {
  EXPECT_THAT(kLawKeys, testing::ElementsAre("standard", "proposed", "predictive", "tank", "direct",
                                             "eba", "popc", "wave", "tdpn", "sfa"));
  CouplingKind kind = CouplingKind::standard;
  for (std::uint8_t i = 0; i < kLaws; ++i) {
    EXPECT_STREQ(info(kind).key, kLawKeys[i]);
    kind = next(kind);
  }
  EXPECT_EQ(kind, CouplingKind::standard);
}

TEST_P(CouplingOfJoints, ProposedAddsFourteenAndFifteen) {
  const int n = GetParam();
  const Random2 r(n, 71);
  for (const double eta : {0.3, 0.6, 1.0, 5.0}) {
    const Decomposition<kAnyDof> d(r.one, r.two);
    const Eigen::MatrixXd phi = d.phi(), C_LE = d.C_LE(d.phi()), C_EL = -C_LE.transpose();
    const auto ff = feedforward<kAnyDof>(eta, d, r.f1);
    const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(n, n);
    const Eigen::MatrixXd phi_T = (r.two.M * (r.one.M + r.two.M).inverse()).eval();  // M symmetric
    const Eigen::VectorXd sum = r.f1 + r.f2;
    const Eigen::VectorXd tau1 = C_EL * d.v_L + (I - phi_T) * C_LE * d.v_E +
                                 ((1 - eta) / eta * I - phi_T / eta) * sum + r.f2;
    const Eigen::VectorXd tau2 = -C_EL * d.v_L + phi_T * C_LE * d.v_E + phi_T / eta * sum - r.f2;
    EXPECT_LT((ff.tau1 + ff.on_device.of(r.f2, r.two.M) - tau1).norm(), 1e-12 * (1 + tau1.norm()));
    EXPECT_LT((ff.tau2 + ff.on_proxy.of(r.f2, r.two.M) - r.f2 - tau2).norm(),
              1e-12 * (1 + tau2.norm()));
  }
}

TEST_P(CouplingOfJoints, ProposedScalesWhatReachesTheLockedSystem) {
  // (12): all outer torque on the locked system is (f1 + f2) / eta, and nothing else pushes it:
  // tau1 + tau2 + f1 + f2 = (f1 + f2)/eta + C_LE v_E.
  const int n = GetParam();
  const Random2 r(n, 72);
  for (const double eta : {0.5, 1.0, 3.0}) {
    const Decomposition<kAnyDof> d(r.one, r.two);
    const Eigen::MatrixXd phi = d.phi(), C_LE = d.C_LE(d.phi()), C_EL = -C_LE.transpose();
    const auto ff = feedforward<kAnyDof>(eta, d, r.f1);
    const Eigen::VectorXd both =
        ff.tau1 + ff.on_device.of(r.f2, r.two.M) + ff.tau2 + ff.on_proxy.of(r.f2, r.two.M) - r.f2;
    const Eigen::VectorXd wanted = (r.f1 + r.f2) / eta - (r.f1 + r.f2) + C_LE * d.v_E;
    EXPECT_LT((both - wanted).norm(), 1e-12 * (1 + wanted.norm()));
  }
}

TEST_P(CouplingOfJoints, ProposedLeavesNoOuterTorqueOnTheShapeSystem) {
  // phi^T (tau1 + tau2) - tau2 is the control torque on the shape system (10). With the outer f_E =
  // phi^T (f1 + f2) - f2 it becomes C_EL v_L: f1 and f2 cancel.
  const int n = GetParam();
  const Random2 r(n, 73);
  for (const double eta : {0.5, 1.0, 3.0}) {
    const Decomposition<kAnyDof> d(r.one, r.two);
    const Eigen::MatrixXd phi = d.phi(), C_LE = d.C_LE(d.phi()), C_EL = -C_LE.transpose();
    const auto ff = feedforward<kAnyDof>(eta, d, r.f1);
    const Eigen::VectorXd tau1 = ff.tau1 + ff.on_device.of(r.f2, r.two.M);
    const Eigen::VectorXd tau2 = ff.tau2 + ff.on_proxy.of(r.f2, r.two.M) - r.f2;
    const Eigen::VectorXd f_E = phi.transpose() * (r.f1 + r.f2) - r.f2;
    const Eigen::VectorXd shape = phi.transpose() * (tau1 + tau2) - tau2 + f_E;
    EXPECT_LT((shape - C_EL * d.v_L).norm(), 1e-12 * (1 + f_E.norm()));
  }
}

TEST_P(CouplingOfJoints, AtRestAndWithEtaOneContactsReachTheDeviceInFull) {
  // Equal poses, f1 = 0: the device gets f2 less the torque that moves the locked inertia's share.
  const int n = GetParam();
  Random2 r(n, 74);
  r.one.v.setZero();
  r.two.v.setZero();
  const Decomposition<kAnyDof> d(r.one, r.two);
  const auto ff = feedforward<kAnyDof>(1, d, Vec<kAnyDof>::Zero(n));
  EXPECT_LT(ff.tau1.norm() + ff.tau2.norm(), 1e-15);
  const Eigen::VectorXd device = ff.on_device.of(r.f2, r.two.M);
  const Eigen::VectorXd proxy = ff.on_proxy.of(r.f2, r.two.M);
  EXPECT_LT((device + proxy - r.f2).norm(), 1e-13);
  // Both then accelerate alike.
  const Eigen::VectorXd a1 = r.one.M.inverse() * device, a2 = r.two.M.inverse() * proxy;
  EXPECT_LT((a1 - a2).norm(), 1e-10 * a1.norm());
}

}  // namespace
}  // namespace limpid
