#include "core/coupling/link.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "core/coupling/coupling.h"
#include "core/touch/proxy.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;

struct Numbered {
  double number = -1, resting = 0;
  static auto parts(auto& p) {
    return std::array{std::span(&p.number, std::size_t{1}), std::span(&p.resting, std::size_t{1})};
  }
  void come_to_rest() { resting = 1; }
};

Numbered numbered(int number) { return {static_cast<double>(number)}; }

LinkSettings link(int delay, int jitter, double loss, int seed = 1) {
  return {.link_delay = delay, .link_jitter = jitter, .link_loss = loss, .link_seed = seed};
}

// A reference: keeps all packets ever sent and searches them all in every tick.
class Queue {
 public:
  int newest(int now, const LinkSettings& s, std::uint64_t direction) {
    const Fate fate = fate_of(s, direction, static_cast<std::uint64_t>(now));
    sent_.push_back({fate.lost, now + s.link_delay + fate.late});
    int newest = -1;
    for (int i = 0; i <= now; ++i) {
      const auto& [lost, arrives] = sent_[static_cast<std::size_t>(i)];
      if (!lost && arrives <= now) newest = i;
    }
    return newest;
  }

 private:
  std::vector<std::pair<bool, int>> sent_;
};

TEST(Link, GivesTheNewestSentOfAllThatHaveArrived) {
  Random random(1);
  for (int round = 0; round < 60; ++round) {
    const auto direction = static_cast<std::uint64_t>(1 + round % 2);
    OneWay<Numbered> channel(direction, {});
    Queue queue;
    LinkSettings s;
    int lost = 0;
    for (int k = 0; k < 900; ++k) {
      if (k % 150 == 0) {  // also changes of the settings
        s = link(static_cast<int>(random.between(0, 200.99)),
                 static_cast<int>(random.between(0, 50.99)), random.one_of({0.0, 0.3, 0.9}),
                 1 + round);
      }
      const Numbered known = channel.pass(numbered(k), s);
      const int wanted = queue.newest(k, s, direction);
      if (wanted < 0) {  // the initial packet, at rest
        EXPECT_EQ(known.number, 0);
        EXPECT_TRUE(known.resting);
        ++lost;
      } else {
        ASSERT_EQ(known.number, wanted) << "tick " << k << " of round " << round;
        ASSERT_FALSE(known.resting);
      }
    }
    EXPECT_LT(lost, 900);
  }
}

// The condition for passivity relies on this bound.
TEST(Link, TellsNothingThatIsOlderThanDelayAndJitter) {
  for (const auto& [delay, jitter] : {std::pair(0, 5), {20, 0}, {7, 50}, {200, 50}}) {
    OneWay<Numbered> channel(1, {});
    const LinkSettings s = link(delay, jitter, 0);
    int oldest = 0;
    for (int k = 0; k < 5000; ++k) {
      const int age = k - static_cast<int>(channel.pass(numbered(k), s).number);
      EXPECT_LE(age, s.oldest());
      if (k < 250) continue;  // the initial packet is older
      oldest = std::max(oldest, age);
      EXPECT_GE(age, delay);
    }
    EXPECT_GT(oldest, delay + jitter / 5 - 1);
  }
}

TEST(Link, StartsAnewAsItStartedAtFirst) {
  const LinkSettings s = link(3, 9, 0.4);
  OneWay<Numbered> channel(2, {});
  std::vector<double> first;
  for (int k = 0; k < 400; ++k) first.push_back(channel.pass(numbered(k), s).number);
  channel.start();
  for (int k = 0; k < 400; ++k)
    ASSERT_EQ(channel.pass(numbered(k), s).number, first[std::size_t(k)]);
}

TEST(Link, ThatWasOffKnowsWhatIsSoWhenItComesOn) {
  const LinkSettings s = link(30, 0, 0);
  OneWay<Numbered> channel(1, {});
  for (int k = 0; k < 100; ++k) channel.pass(numbered(k), s);
  channel.forget();
  for (int k = 500; k < 530; ++k) {
    const Numbered known = channel.pass(numbered(k), s);
    EXPECT_EQ(known.number, 500);
    EXPECT_TRUE(known.resting);
  }
  EXPECT_EQ(channel.pass(numbered(530), s).number, 500);
  EXPECT_FALSE(channel.pass(numbered(531), s).resting);
}

// Number of pages that this thread has touched for the first time.
long first_touches() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_minflt;
}

// Sends so many packets in each direction, all different.
void exchange(ProxyLink<kAnyDof>& link, int joints, int ticks) {
  Random random(4);
  auto device = FromDevice<kAnyDof>::zero(joints);
  auto proxy = FromProxy<kAnyDof>::zero(joints);
  for (int k = 0; k < ticks; ++k) {
    device.x1 = random.vector(joints, 1);
    proxy.x2 = device.x1;
    link.to_proxy(device);
    link.to_device(proxy);
  }
}

// A tick that touches a page for the first time waits for it, a few microseconds.
TEST(Link, TouchesNoPageForTheFirstTimeInATick) {
  for (const int joints : {6, kMaxDof}) {
    ProxyLink<kAnyDof> used(joints), fresh(joints);
    for (ProxyLink<kAnyDof>* each : {&used, &fresh}) {
      each->start();
      each->of(link(200, 50, 0.1));
    }
    exchange(used, joints, 300);  // touches its code and its stack
    const long before = first_touches();
    exchange(fresh, joints, 300);
    // Two directions of 256 packets; a page has 512 numbers.
    const long pages = 2 * 256 * (5 * joints + 2 * joints * joints + 2) / 512;
    EXPECT_LT(first_touches() - before, pages / 20) << joints << " joints, " << pages << " pages";
  }
}

TEST(Link, SetsAsideWhatTheArmNeedsAndNoMore) {
  for (const int joints : {1, 6, kMaxDof}) {
    const OneWay<FromDevice<kAnyDof>> channel(1, FromDevice<kAnyDof>::zero(joints));
    // f, v, v, x, waves; M, C; the energy and the number.
    const int numbers = 5 * joints + 2 * joints * joints + 2;
    EXPECT_EQ(channel.storage().size(), 256u * static_cast<unsigned>(numbers));
  }
}

// A packet that went through is the same in all of its parts.
TEST(Link, LosesNoPartOfAPacket) {
  Random random(8);
  for (const int n : {1, 6, kMaxDof}) {
    OneWay<FromProxy<kAnyDof>> back(2, FromProxy<kAnyDof>::zero(n));
    OneWay<FromDevice<kAnyDof>> there(1, FromDevice<kAnyDof>::zero(n));
    std::vector<FromDevice<kAnyDof>> of_device;
    std::vector<FromProxy<kAnyDof>> of_proxy;
    for (std::size_t k = 0; k < 9; ++k) {
      const Dynamics<kAnyDof> d{random.matrix(n, 1), random.matrix(n, 1), random.vector(n, 1)};
      of_device.push_back({random.vector(n, 1), random.vector(n, 1), d, random.vector(n, 1),
                           random.between(0, 1), double(k), random.vector(n, 1)});
      of_proxy.push_back({random.vector(n, 1), random.vector(n, 1), d, random.vector(n, 1),
                          random.between(0, 1), double(k), random.vector(n, 1)});
      const auto& a = there.pass(of_device.back(), link(3, 0, 0));
      const auto& b = back.pass(of_proxy.back(), link(3, 0, 0));
      if (k < 3) continue;
      const auto& x = of_device[k - 3];
      const auto& y = of_proxy[k - 3];
      EXPECT_TRUE(a.x1 == x.x1 && a.v1 == x.v1 && a.f1_hat == x.f1_hat && a.sent == x.sent);
      EXPECT_TRUE(a.device.M == x.device.M && a.device.C == x.device.C && a.device.v == x.device.v);
      EXPECT_TRUE(b.x2 == y.x2 && b.vbar2 == y.vbar2 && b.f2 == y.f2 && b.sent == y.sent);
      EXPECT_TRUE(b.proxy.M == y.proxy.M && b.proxy.C == y.proxy.C && b.proxy.v == y.proxy.v);
    }
  }
}

// Compares counts with their expectations, within four and a half standard deviations.
TEST(Link, LosesAndDelaysPacketsEvenlyAndEachDirectionByItself) {
  constexpr int kPackets = 100000;
  const double off = 4.5 * std::sqrt(kPackets);
  for (const int seed : {1, 2, 1000000}) {
    const LinkSettings s = link(0, 9, 0.3, seed);
    std::array<std::array<int, 10>, 10> both{};
    int lost = 0, lost_together = 0, lost_twice = 0;
    bool before = false;
    for (std::uint64_t k = 0; k < kPackets; ++k) {
      const Fate a = fate_of(s, 1, k), b = fate_of(s, 2, k);
      ++both[static_cast<std::size_t>(a.late)][static_cast<std::size_t>(b.late)];
      lost += a.lost ? 1 : 0;
      lost_together += a.lost && b.lost ? 1 : 0;
      lost_twice += a.lost && before ? 1 : 0;
      before = a.lost;
    }
    EXPECT_NEAR(lost, 0.3 * kPackets, off * std::sqrt(0.3 * 0.7));
    EXPECT_NEAR(lost_together, 0.09 * kPackets, off * std::sqrt(0.09 * 0.91));
    EXPECT_NEAR(lost_twice, 0.09 * kPackets, off * std::sqrt(0.09 * 0.91));
    for (const auto& row : both) {
      for (const int count : row) EXPECT_NEAR(count, 0.01 * kPackets, off * std::sqrt(0.01 * 0.99));
    }
  }
  int same = 0;
  for (std::uint64_t k = 0; k < kPackets; ++k) {
    same += fate_of(link(0, 9, 0, 1), 1, k).late == fate_of(link(0, 9, 0, 2), 1, k).late ? 1 : 0;
  }
  EXPECT_NEAR(same, 0.1 * kPackets, off * std::sqrt(0.1 * 0.9));
}

struct AllSettings : LawSettings, LinkSettings {};

// A device that is led, and a proxy that follows it under a law.
class Followed {
 public:
  Followed(int n, unsigned seed)
      : n_(n), seed_(seed), proxy_(test::random_arm(n, seed), Scene{}), link_(n) {
    proxy_.place(Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n), 0.1);
    link_.start();
    coupling_.start({zero_(), zero_(), zero_()});
  }

  // Returns the torques of all ticks, one below the other.
  Eigen::VectorXd run(CouplingKind kind, const AllSettings& p, bool through) {
    Random random(seed_);
    Eigen::VectorXd all(0);
    Vec<kAnyDof> x = Eigen::VectorXd::Zero(n_), before = x, vbar2 = x;
    const Vec<kAnyDof> b = Eigen::VectorXd::Constant(n_, 0.01),
                       limit = Eigen::VectorXd::Constant(n_, 1);
    const Arm<kAnyDof>::Frames frames{};
    for (int k = 0; k < 40; ++k) {
      proxy_.catch_up();
      x += random.vector(n_, 1e-3);
      const Vec<kAnyDof> v = (x - before) / 0.001, f1 = random.vector(n_, 0.5);
      const Dynamics<kAnyDof> device{random.positive_definite(n_, 1e-4, 1e-3),
                                     random.matrix(n_, 1e-3), v};
      before = x;
      ProxyLink<kAnyDof>* const link = link_.of(p);
      LawInput<kAnyDof> in{x, v, device, f1, vbar2, 0.001, frames, b, b, limit, 1, 0.001, 0, 0};
      in.link = through ? &link_ : link;
      coupling_.locate(kind, p, {x, v, k > 0 ? 0.001 : 0, 0});
      const Eigen::VectorXd tau = coupling_.step(kind, p, in, proxy_);
      coupling_.applied(kind, tau);
      vbar2 = proxy_.vbar();
      const Eigen::Index at = all.size();
      all.conservativeResize(at + 2 * n_);
      all.segment(at, n_) = tau;
      all.tail(n_) = proxy_.tau();
    }
    return all;
  }

 private:
  const Vec<kAnyDof>& zero_() {
    zero = Eigen::VectorXd::Zero(n_);
    return zero;
  }

  int n_;
  unsigned seed_;
  Vec<kAnyDof> zero;
  Proxy<kAnyDof> proxy_;
  ProxyLink<kAnyDof> link_;
  Coupling<kAnyDof> coupling_;
};

constexpr CouplingKind kLinked[] = {CouplingKind::standard, CouplingKind::proposed,
                                    CouplingKind::tank};

TEST(Link, WithoutDelayAndLossGivesTheSameBitsAsNone) {
  for (const CouplingKind kind : kLinked) {
    for (const int n : {1, 3, 7}) {
      AllSettings p;
      p.eta = 0.7;
      const Eigen::VectorXd direct = Followed(n, 5).run(kind, p, false);
      EXPECT_EQ(direct, Followed(n, 5).run(kind, p, true)) << info(kind).key << ' ' << n;
      p.link_delay = 1;
      EXPECT_NE(direct, Followed(n, 5).run(kind, p, false)) << info(kind).key << ' ' << n;
    }
  }
}

TEST(Link, DoesNothingUnderThePredictiveLaw) {
  AllSettings p;
  const Eigen::VectorXd direct = Followed(3, 5).run(CouplingKind::predictive, p, false);
  p.link_delay = 50;
  EXPECT_EQ(direct, Followed(3, 5).run(CouplingKind::predictive, p, false));
}

// (1) and (2) by hand, each side with the other's state before the delay.
TEST(Link, MakesEachSideGoByWhatWasSoADelayAgo) {
  constexpr int kDelay = 4, n = 2;
  const double T = 0.001;
  LawSettings p;
  p.b_vc = 0.02;
  Proxy<kAnyDof> proxy(test::random_arm(n, 9), Scene{});
  proxy.place(Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n), 0.1);
  ProxyLink<kAnyDof> link_of(n);
  link_of.start();
  const auto law = StandardLaw::make<kAnyDof>();
  Random random(3);
  std::vector<Vec<kAnyDof>> x1{Eigen::VectorXd::Zero(n)}, x2, vbar2{Eigen::VectorXd::Zero(n)};
  const Vec<kAnyDof> b = Eigen::VectorXd::Zero(n), limit = Eigen::VectorXd::Constant(n, 1);
  const Arm<kAnyDof>::Frames frames{};
  const Dynamics<kAnyDof> device{random.positive_definite(n, 1e-4, 1e-3), random.matrix(n, 1e-3),
                                 Eigen::VectorXd::Zero(n)};
  for (std::size_t k = 0; k < 50; ++k) {
    proxy.catch_up();
    if (k > 0) x1.push_back(x1.back() + random.vector(n, 1e-3));
    x2.push_back(proxy.x());
    const Vec<kAnyDof> v1 = k > 0 ? Vec<kAnyDof>((x1[k] - x1[k - 1]) / T) : b;
    LawInput<kAnyDof> in{x1[k], v1, device, b, vbar2[k], T, frames, b, b, limit, 1, T, 0, 0};
    in.link = link_of.of(link(kDelay, 0, 0));
    const Eigen::VectorXd tau1 = law->step(p, in, proxy);
    vbar2.push_back(proxy.vbar());
    const std::size_t old = k > kDelay ? k - kDelay : 0;  // until then the state at the start
    const Eigen::VectorXd v1_old =
        old > 0 ? Eigen::VectorXd((x1[old] - x1[old - 1]) / T) : Eigen::VectorXd(b);
    const Eigen::VectorXd wanted1 = -p.b_vc * (v1 - vbar2[old]) - p.k_vc * (x1[k] - x2[old]);
    const Eigen::VectorXd mean = vbar2.back();
    const Eigen::VectorXd wanted2 =
        -p.b_vc * (mean - v1_old) - p.b_v * mean - p.k_vc * (x2[k] + T / 2 * mean - x1[old]);
    EXPECT_LT((tau1 - wanted1).norm(), 1e-13) << k;
    EXPECT_LT((proxy.tau() - wanted2).norm(), 1e-11) << k;
  }
}

// The dampers of line and match are held for a tick. A hand that turns round in each of them is
// given 2 b D^2/T in one. The device's own damping takes b_d D^2/T of it; no wave is under way.
TEST(Wave, GivesToAHandThatTurnsRoundInEachTickWhatDampersHeldForATickGive) {
  const double T = 0.001, b_d = 0.012, A = 1e-3;
  for (const double part : {1.0 / 3, 0.5, 1.0}) {
    LawSettings p;
    p.wave_b = part * b_d;
    Proxy<kAnyDof> proxy(test::random_arm(1, 9), Scene{});
    const Vec<kAnyDof> zero = Eigen::VectorXd::Zero(1), b = Eigen::VectorXd::Constant(1, b_d),
                       limit = Eigen::VectorXd::Constant(1, 10);
    proxy.place(zero, zero, 0.1);
    const auto law = WaveLaw::make<kAnyDof>();
    Vec<kAnyDof> x = zero, tau = zero;
    const Arm<kAnyDof>::Frames frames{};
    const Dynamics<kAnyDof> device{Eigen::MatrixXd::Constant(1, 1, 1e-3),
                                   Eigen::MatrixXd::Zero(1, 1), zero};
    law->start({x, zero, zero});
    double given = 0, expected = 0;
    for (int k = 0; k < 200; ++k) {
      const Vec<kAnyDof> next = Eigen::VectorXd::Constant(1, k % 2 == 0 ? A : -A);
      const Vec<kAnyDof> D = next - x;
      given += tau.dot(D) - b_d * D.squaredNorm() / T;
      if (k > 1) expected += (2 * p.wave_b - b_d) * D.squaredNorm() / T;
      x = next;
      const Vec<kAnyDof> v = D / T;
      law->locate(p, {x, v, T, 0});
      proxy.catch_up();
      const LawInput<kAnyDof> in{x, v, device, zero, proxy.vbar(), T, frames, b, b, limit,
                                 1, T, 0,      0};
      tau = law->step(p, in, proxy);
      law->applied(tau);
    }
    EXPECT_NEAR(given, expected, 0.02 * b_d * 4 * A * A / T * 200) << part;
  }
}

}  // namespace
}  // namespace limpid
