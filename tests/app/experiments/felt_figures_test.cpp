// Figures of what is felt and of bodies that move, against recordings, theory, and what captions
// and README say of hand and scene.
#include <complex>
#include <numbers>

#include "app/experiments/felt_impedance.h"
#include "tests/app/experiments/made.h"

namespace limpid {
namespace {

using test::expect_from_to;
using test::expect_on;
using test::expect_over_time;
using test::Kept;
using test::Made;
using testing::HasSubstr;
using testing::IsSupersetOf;

constexpr double kTwoPi = 2 * std::numbers::pi;

// Amplitude of the hand's target at f, along a direction, over the last whole period [m].
double shaken_by(const Kept& kept, double f, const Vec3& along, double period) {
  const std::size_t count = kept.row(period);
  std::complex<double> sum = 0;
  for (std::size_t k = kept.size() - count; k < kept.size(); ++k) {
    const Vec3 at = kept.vec(k, Column::hand_target);
    sum += at.dot(along) * std::polar(1.0, -kTwoPi * f * kept.time(k));
  }
  return 2 * std::abs(sum) / static_cast<double>(count);
}

// Seven frequencies together, 0.25 mm at 1 Hz and less above, along one direction.
TEST(FiguresOf, LightnessShakeTheTipAtSevenFrequencies) {
  const Made made("lightness");
  const Vec3 along = Vec3(1, 0.8, 0.6).normalized();
  EXPECT_THAT(made.trials(), IsSupersetOf({"standard-eta-1", "proposed-eta-0.2", "proposed-eta-5",
                                           "predictive-eta-0.3", "predictive-eta-2"}));
  for (const auto& [name, kind, eta] : {std::tuple("standard-eta-1", CouplingKind::standard, 1.0),
                                        {"proposed-eta-0.2", CouplingKind::proposed, 0.2},
                                        {"predictive-eta-5", CouplingKind::predictive, 5.0}}) {
    const Kept kept = made.kept(name);
    EXPECT_EQ(kept.p.kind, kind);
    EXPECT_EQ(kept.p.eta, eta);
    EXPECT_EQ(kept.p.hand_stiffness, 300);
    EXPECT_EQ(kept.p.hand_damping, 4);
    EXPECT_TRUE(kept.plan.document.scene.objects.empty());
    EXPECT_NEAR((kept.hand(0) - kHome).norm(), 0, 1e-9);
    for (const double f : {0.5, 1.0, 2.0, 3.0, 5.0, 7.0, 10.0}) {
      EXPECT_NEAR(shaken_by(kept, f, along, 2), 2.5e-4 / f, 0.01 * 2.5e-4 / f) << f << " Hz";
    }
    for (const double f : {1.5, 4.0, 8.0}) EXPECT_LT(shaken_by(kept, f, along, 2), 5e-6) << f;
    const Vec3 across = along.cross(Vec3::UnitZ()).normalized();
    EXPECT_LT(shaken_by(kept, 1, across, 2), 1e-9);
    EXPECT_NEAR(kept.time(kept.size()), 4, 3e-3);
  }
}

TEST(FiguresOf, LightnessShowEtaBesideWhatIsFelt) {
  const Made made("lightness");
  const std::string felt = "Predictive: inertia felt (dashed: eta)";
  const double etas[] = {0.2, 0.3, 0.5, 1, 2, 5};
  for (std::size_t i = 0; i < std::size(etas); ++i) {
    const Series& curve = made.curve(felt, fmt::format("eta = {}", etas[i]));
    expect_from_to(curve, 0.5, 10, 1e-9);
    ASSERT_EQ(curve.points.size(), 7u);
    for (const FigurePoint& p : curve.points) {
      if (p.x <= 5) {
        EXPECT_NEAR(p.y, etas[i], 0.1 * etas[i]) << p.x;
      }
    }
    // The dashed line of eta and the points have no label of their own.
    expect_on(made.unnamed(felt, 2 * i), [&](double) { return etas[i]; });
    expect_from_to(made.unnamed(felt, 2 * i), 0.45, Parameters{}.band, 1e-9);
    EXPECT_EQ(made.unnamed(felt, 2 * i + 1).points.size(), 7u);
    EXPECT_NEAR(
        made.curve("Damping felt at 0.5 Hz", "predictive").points[i].y,
        made.curve("Predictive: damping felt", fmt::format("eta = {}", etas[i])).points[0].y,
        1e-12);
    EXPECT_NEAR(made.curve("Inertia felt at 2 Hz", "predictive").points[i].y, curve.points[2].y,
                1e-12);
    EXPECT_EQ(made.curve("Inertia felt at 2 Hz", "predictive").points[i].x, etas[i]);
  }
  // |Z| at 0.5 Hz is the damping and the inertia together, and 1 at eta = 1.
  const std::string slow = "Torque divided by speed at 0.5 Hz, relative to eta = 1";
  for (const char* law : {"proposed", "predictive"}) {
    const Series& curve = made.curve(slow, law);
    ASSERT_EQ(curve.points.size(), 6u);
    EXPECT_EQ(curve.points[3].x, 1);
    EXPECT_NEAR(curve.points[3].y, 1, 1e-12);
  }
  expect_on(
      made.curve(slow, "proposed"), [](double eta) { return eta; }, 0.05);
  for (const char* title :
       {"Inertia felt at 2 Hz", "Torque divided by speed at 0.5 Hz, relative to eta = 1"}) {
    expect_on(made.curve(title, "eta"), [](double eta) { return eta; });
    const Series& standard = made.curve(title, "standard");
    EXPECT_EQ(standard.style, Series::Style::dashed) << "it takes no eta";
    expect_from_to(standard, 0.1, 10, 0);
    EXPECT_EQ(standard.points[0].y, standard.points[1].y);
  }
  // 1 - eta times the inertia times the band in rad/s.
  const Series& least =
      made.curve("Damping felt at 0.5 Hz", "smallest damping of any passive law with this inertia");
  const double at_none = least.points.front().y / (1 - least.points.front().x);
  expect_on(least, [&](double eta) { return at_none * (1 - eta); });
  EXPECT_NEAR(at_none / (kTwoPi * Parameters{}.band), 3.1e-4, 2e-4) << "kg m^2 of the arm";
  const Series& bound =
      made.curve("Cost of a light device: damping at 0.5 Hz against inertia at 2 Hz",
                 "smallest damping of any passive law that keeps this inertia up to 5.3 Hz");
  EXPECT_EQ(bound.points.front().x, 0);
  EXPECT_NEAR(bound.points.front().y, at_none, 1e-12);
  EXPECT_EQ(bound.points.back().x, 1);
  EXPECT_EQ(bound.points.back().y, 0);
  const Series& cost =
      made.curve("Cost of a light device: damping at 0.5 Hz against inertia at 2 Hz",
                 "predictive, eta 0.2 to 1");
  ASSERT_EQ(cost.points.size(), 4u) << "0.2, 0.3, 0.5 and 1";
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(cost.points[i].x, made.curve("Inertia felt at 2 Hz", "predictive").points[i].y);
    EXPECT_EQ(cost.points[i].y, made.curve("Damping felt at 0.5 Hz", "predictive").points[i].y);
  }
}

TEST(FiguresOf, LightnessSortTheProposedLawByItsEta) {
  const Made made("lightness");
  const std::string low = "Proposed with eta up to 1, and standard: inertia felt (dashed: eta)",
                    high = "Proposed with eta above 1: inertia felt (dashed: eta)";
  const auto labels = [&](const std::string& title) {
    std::vector<std::string> all;
    for (const Series& s : made.panel(title).series) {
      if (!s.label.empty()) all.push_back(s.label);
    }
    return all;
  };
  EXPECT_THAT(labels(low), testing::UnorderedElementsAre("eta = 0.2", "eta = 0.3", "eta = 0.5",
                                                         "eta = 1", "standard (hides eta = 1)"));
  EXPECT_THAT(labels(high), testing::UnorderedElementsAre("eta = 2", "eta = 5"));
  EXPECT_EQ(labels("Proposed and standard: damping felt").size(), 7u);
  // The standard law is the proposed one at eta = 1.
  for (std::size_t i = 0; i < 7; ++i) {
    const double one = made.curve(low, "eta = 1").points[i].y;
    EXPECT_NEAR(made.curve(low, "standard (hides eta = 1)").points[i].y, one, 0.05 * std::abs(one));
  }
}

// All lines shake with the same speed, 0.5 mm/s, at whole multiples of 0.2 Hz.
TEST(FiguresOf, ObserverShowItsResponseAtThreeGains) {
  const Made made("observer");
  const std::string title = "Estimated / true human torque, heaviest mode (lines: theory)";
  const FigurePanel& response =
      *std::ranges::find(made.figure().panels, title, &FigurePanel::title);
  EXPECT_TRUE(response.log_x && response.log_y);
  std::size_t at = 0;
  for (const double alpha : {0.0035, 0.035, 0.35}) {
    const Kept kept = made.kept(fmt::format("alpha-{:.3g}", alpha));
    EXPECT_EQ(kept.p.alpha, alpha);
    EXPECT_EQ(kept.p.hand_damping, 0);
    EXPECT_EQ(kept.p.hand_stiffness, 300);
    EXPECT_EQ(kept.p.eta, 1);
    const Series& points = made.curve(title, fmt::format("alpha = {}", alpha));
    const Series& theory = made.unnamed(title, at++);
    ASSERT_EQ(points.points.size(), theory.points.size());
    EXPECT_GE(points.points.size(), 40u);
    expect_from_to(points, 0.2, 200, 0.5);
    for (std::size_t i = 0; i < points.points.size(); ++i) {
      const double f = points.points[i].x;
      EXPECT_EQ(f, theory.points[i].x);
      EXPECT_NEAR(points.points[i].y, theory.points[i].y, 0.05 * theory.points[i].y) << f;
      if (i % 6 != 0) continue;
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(kTwoPi * f * shaken_by(kept, f, Vec3::Unit(axis), 5), 5e-4, 5e-5)
            << f << " Hz, axis " << axis;
      }
    }
    EXPECT_NEAR(kept.time(kept.size()), 10, 3e-3) << "a period of 5 s to settle, and one measured";
  }
  const std::string decay = "Decay of a wrong estimate, heaviest mode (dashed: exp(-w_f t))";
  at = 0;
  for (const double alpha : {0.0035, 0.035, 0.35}) {
    const Series& seen = made.curve(decay, fmt::format("alpha = {}", alpha));
    const Series& ideal = made.unnamed(decay, at++);
    ASSERT_EQ(seen.points.size(), ideal.points.size());
    EXPECT_NEAR(seen.points[0].y, 1, 0.02);
    EXPECT_EQ(seen.points[0].x, 0);
    EXPECT_NEAR(ideal.points[0].y, 1, 1e-12);
    const double rate = -std::log(ideal.points[1].y) / ideal.points[1].x;
    expect_on(
        ideal, [&](double t) { return std::exp(-rate * t); }, 1e-6);
    if (alpha == 0.0035) {
      expect_on(
          seen, [&](double t) { return std::exp(-rate * t); }, 0.05);
    }
  }
  const std::string band = "Bandwidth of the estimate, all modes, alpha 0.002 to 1";
  expect_on(made.curve(band, "alpha / m"), [](double w) { return w; });
  expect_from_to(made.curve(band, "alpha / m"), 3, 2e4, 2e3);
  EXPECT_EQ(made.curve(band, "phase -45 deg").points.size(), 19u * 3) << "gains, modes";
  for (const FigurePoint& p : made.curve(band, "gain -3 dB").points) {
    if (p.x < 50) {
      EXPECT_NEAR(p.y, p.x, 0.02 * p.x) << "slow observers are not sampled visibly";
    }
  }
  const Series& bounded =
      made.panel("Largest estimated torque, divided by the largest true torque").series.at(0);
  ASSERT_EQ(bounded.points.size(), 9u);
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_NEAR(bounded.points[i].x, std::pow(10.0, static_cast<double>(i) - 5),
                1e-9 * bounded.points[i].x);
    EXPECT_LE(bounded.points[i].y, 1.1);
    if (i > 0) {
      EXPECT_GE(bounded.points[i].y, 0.9 * bounded.points[i - 1].y);
    }
  }
  EXPECT_LT(bounded.points[0].y, 0.1) << "a slow estimate hardly follows";
}

TEST(FiguresOf, TransparencyShowMeasurementOnTheory) {
  const Made made("transparency");
  const std::string free = "Impedance felt in free motion (lines: theory)",
                    touch = "Impedance felt at a wall of 600 N/m (lines: theory)";
  const auto on_theory = [&](const std::string& title, const std::string& label, std::size_t n,
                             double to) {
    const Series &points = made.curve(title, label), &theory = made.unnamed(title, n);
    ASSERT_EQ(points.points.size(), theory.points.size());
    for (std::size_t i = 0; i < points.points.size(); ++i) {
      EXPECT_EQ(points.points[i].x, theory.points[i].x);
      if (points.points[i].x > to) continue;
      EXPECT_NEAR(points.points[i].y, theory.points[i].y, 0.1 * theory.points[i].y)
          << title << ", " << label << " at " << points.points[i].x << " Hz";
    }
  };
  std::size_t n = 0;
  on_theory(free, "standard", n++, 50);
  for (const double eta : {0.4, 0.6, 1.0, 2.0, 5.0}) {
    on_theory(free, fmt::format("eta = {}", eta), n++, 50);
    const Kept kept = made.kept(fmt::format("proposed-eta-{}-wall-0", eta));
    EXPECT_EQ(kept.p.eta, eta);
    EXPECT_EQ(kept.p.hand_stiffness, 100);
    EXPECT_EQ(kept.p.hand_damping, 0);
    EXPECT_TRUE(kept.plan.document.scene.objects.empty());
    EXPECT_NEAR(kept.hand(2).x(), 0.19, 1e-12);
    EXPECT_NEAR(kept.hand(2).z(), 0, 1e-12);
    EXPECT_NEAR(kept.time(kept.size()), 4, 3e-3);
    EXPECT_NEAR(kTwoPi * shaken_by(kept, 1, Vec3::UnitY(), 2), 2e-3, 1e-4);
  }
  n = 0;
  on_theory(touch, "standard", n++, 20);
  for (const double eta : {0.6, 1.0, 2.0}) {
    on_theory(touch, fmt::format("eta = {}", eta), n++, 20);
    const Kept kept = made.kept(fmt::format("proposed-eta-{}-wall-600", eta));
    EXPECT_EQ(kept.object(0).material.stiffness, 600);
    EXPECT_EQ(kept.p.hand_damping, 2);
    EXPECT_EQ(kept.p.hand_stiffness, 100);
    double force = 0;
    const std::size_t from = kept.row(2), to = kept.row(4);
    for (std::size_t k = from; k < to; ++k) {
      force += kept.one(k, Column::contact_force, 1) / static_cast<double>(to - from);
    }
    EXPECT_NEAR(force, 1, 0.05) << "it presses with 1 N";
  }
  expect_on(made.curve(touch, "the wall alone"),
            [](double f) { return 600 * 0.19 * 0.19 / (kTwoPi * f); });
  const std::string scaling = "Impedance in free motion / impedance at eta = 1 (lines: theory)";
  expect_on(made.curve(scaling, "eta"), [](double eta) { return eta; });
  for (const Series& s : made.panel(scaling).series) {
    if (s.style != Series::Style::points) continue;
    ASSERT_EQ(s.points.size(), 5u) << s.label;
    EXPECT_EQ(s.points[2].x, 1);
    EXPECT_NEAR(s.points[2].y, 1, 1e-12);
  }
  EXPECT_EQ(made.curve(scaling, "0.5 Hz").points.size(), 5u);
  expect_on(
      made.curve(scaling, "0.5 Hz"), [](double eta) { return eta; }, 0.1);
  const std::string pressing = "Stiffness felt when pressing a wall";
  const double series = Parameters{}.k_vc / (0.19 * 0.19);
  const auto in_series = [&](double K) { return 1 / (1 / K + 1 / series); };
  expect_on(made.curve(pressing, "as set"), [](double K) { return K; });
  expect_on(made.curve(pressing, "wall in series with k_vc"), in_series);
  expect_on(made.curve(pressing, "standard"), in_series, 0.02);
  expect_on(
      made.curve(pressing, "proposed"), [](double K) { return K; }, 0.03);
  expect_from_to(made.curve(pressing, "proposed"), 50, 1000, 0);
}

// A body of 5, 50 or 500 g is held at 5000 N/m, and shaken at five frequencies, 0.25 mm at 1 Hz.
TEST(FiguresOf, MassShowTheSpringsTheory) {
  const Made made("mass");
  const double masses[] = {0.005, 0.05, 0.5};
  for (const double mass : masses) {
    const std::string title = fmt::format("Mass felt for a cube of {} g", 1e3 * mass);
    const auto theory = [&](double K) {
      return [=](double f) { return 1 / (1 - mass * std::pow(kTwoPi * f, 2) / K); };
    };
    expect_on(made.curve(title, "theory, 1 / (1 - m w^2 / K)"), theory(5000));
    const Series& ours = made.curve(title, "predictive");
    ASSERT_EQ(ours.points.size(), 5u);
    expect_from_to(ours, 0.5, 5, 0);
    expect_on(ours, theory(5000), 0.02);
    expect_on(made.curve(title, "predictive, eta = 0.3"), theory(5000), 0.04);
    if (mass < 0.5) {
      expect_on(made.curve(title, "predictive, in a grip of 600 N/m"), theory(600), 0.02);
    }
    const Kept kept = made.kept(fmt::format("predictive-eta-1-{}-g-5000", 1e3 * mass));
    EXPECT_EQ(kept.p.hand_stiffness, 3000);
    EXPECT_EQ(kept.object(0).material.stiffness, 5000);
    ASSERT_TRUE(kept.object(0).body);
    EXPECT_NEAR(kept.object(0).body->mass, mass, 1e-9);
    EXPECT_TRUE(kept.object(0).body->magnet);
    // The centre of mass is where the tip is.
    ASSERT_TRUE(kept.object(0).body->center);
    EXPECT_NEAR((kept.object(0).pose * *kept.object(0).body->center - kHome).norm(), 0, 1e-9);
    EXPECT_NEAR(kept.plan.document.scene.gravity.norm(), 0, 0);
    EXPECT_EQ(kept.one(kept.size() - 1, Column::magnet), 1);
    for (const double f : {0.5, 1.0, 2.0, 3.0, 5.0}) {
      EXPECT_NEAR(shaken_by(kept, f, Vec3(1, 0.8, 0.6).normalized(), 2), 2.5e-4 / f, 3e-6 / f);
    }
  }
  const std::string least = "The smallest mass that can be held";
  expect_on(made.curve(least, "K T^2/4 + B T/2"),
            [](double K) { return 1e3 * (K * 1e-6 / 4 + 2 * 1e-3 / 2); });
  expect_on(made.curve(least, "K T^2/4"), [](double K) { return 1e3 * K * 1e-6 / 4; });
  for (const FigurePoint& p : made.curve(least, "staggered, 2 N s/m").points) {
    if (p.x > 5000) continue;
    const double wanted = 1e3 * (p.x * 1e-6 / 4 + 1e-3);
    EXPECT_NEAR(p.y, wanted, 0.1 * wanted) << p.x;
  }
  const Series& ours = made.curve(least, "predictive: stable with 0.1 g, the lightest tried");
  ASSERT_EQ(ours.points.size(), 8u);
  expect_on(ours, [](double) { return 0.1; });
  expect_from_to(ours, 100, 20000, 0);
}

// 0.5 N and a detent of 0.4 N over 8 mm; pressed from 2 mm above to 12.5 mm below, at 35 mm/s.
TEST(FiguresOf, ClickFollowTheButtonsOwnForce) {
  const Made made("click");
  const auto given = [](double mm) { return 0.5 + 0.4 * std::sin(kTwoPi * mm / 8); };
  const std::string ours = "Predictive, contacts of three stiffnesses";
  for (const FigurePanel& panel : made.figure().panels) {
    expect_on(made.curve(panel.title, "given"), given);
    expect_from_to(made.curve(panel.title, "given"), 0, 9.6, 0.1);
  }
  for (const double stiffness : {600.0, 2000.0, 5000.0}) {
    const Kept kept = made.kept(fmt::format("predictive-{}", stiffness));
    EXPECT_EQ(kept.object(0).material.stiffness, stiffness);
    EXPECT_NEAR(kept.object(0).body->mass, 0.002, 1e-12);
    ASSERT_TRUE(kept.object(0).body->joint);
    EXPECT_NEAR(kept.object(0).body->joint->force.detent_force, 0.4, 1e-12);
    EXPECT_NEAR(kept.object(0).body->joint->force.detent_period, 0.008, 1e-12);
    EXPECT_EQ(kept.p.hand_stiffness, 3000);
    EXPECT_NEAR(kept.hand(0.1).z(), 0.002, 1e-9);
    double deepest = 0, fastest = 0;
    std::size_t at_rest = 0;
    for (std::size_t k = 1; k < kept.size(); ++k) {
      const double z = kept.one(k, Column::hand_target, 2);
      const double speed = std::abs(z - kept.one(k - 1, Column::hand_target, 2)) / 1e-3;
      deepest = std::min(deepest, z);
      fastest = std::max(fastest, speed);
      at_rest += speed == 0 && z < 0;
    }
    EXPECT_NEAR(deepest, -0.0125, 1e-6);
    EXPECT_NEAR(fastest, 0.035, 2e-4);
    EXPECT_NEAR(static_cast<double>(at_rest), 200, 10) << "0.2 s";
    EXPECT_NEAR(kept.hand(kept.time(kept.size() - 1)).z(), 0.002, 1e-6) << "and up again";
    // Each point: the travel between two rows, and the force of the hand's spring.
    const Series& curve = made.curve(ours, fmt::format("{} N/m", stiffness));
    const double top = kept.one(0, Column::body_pose, 2);
    std::size_t i = 0;
    double off = 0;
    for (std::size_t k = 0; k + 1 < kept.size(); ++k) {
      const double travel =
          top - (kept.one(k, Column::body_pose, 2) + kept.one(k + 1, Column::body_pose, 2)) / 2;
      if (travel < 2e-4) continue;
      ASSERT_LT(i, curve.points.size());
      EXPECT_NEAR(curve.points[i].x, 1e3 * travel, 1e-6);
      off += std::pow(curve.points[i].y - given(curve.points[i].x), 2);
      ++i;
    }
    ASSERT_EQ(i, curve.points.size());
    const std::string which = fmt::format("predictive, {} N/m: ", stiffness);
    EXPECT_NEAR(
        made.check(which + "rms difference between the force felt and the force given [N]").value,
        std::sqrt(off / static_cast<double>(i)), 1e-6);
    EXPECT_NEAR(made.check(which + "largest displacement of the button [m]").value,
                1e-3 * std::ranges::max(curve.points, {}, &FigurePoint::x).x, 1e-9);
  }
  for (const char* law : {"proposed", "standard"}) {
    EXPECT_EQ(made.kept(fmt::format("{}-2000", law)).object(0).material.stiffness, 2000);
    EXPECT_EQ(made.curve("Other laws, contacts of 2000 N/m", law).style, Series::Style::points);
  }
  // Without a damper nothing damps the staggered button; with one the force is less off.
  const auto off_of = [&](const Series& curve) {
    double sum = 0;
    for (const FigurePoint& p : curve.points) sum += std::pow(p.y - given(p.x), 2);
    return std::sqrt(sum / static_cast<double>(curve.points.size()));
  };
  const std::string soft = "Staggered solution, contacts of 2000 N/m";
  EXPECT_LT(off_of(made.curve(soft, "staggered, 2 N s/m")),
            off_of(made.curve(soft, "staggered, 0 N s/m")));
}

// A block of 50 g falls freely by 10 cm, and brings m g h = 49 mJ.
TEST(FiguresOf, DropFallFreelyUntilTheTip) {
  const Made made("drop");
  EXPECT_THAT(made.figure().caption, HasSubstr("The falling block has an energy of 49 mJ"));
  const std::string height = "Height of the block's lower face above the resting tip",
                    reserve = "Reserve of the energy account, predictive";
  for (const double stiffness : {600.0, 2000.0, 5000.0}) {
    const Kept kept = made.kept(fmt::format("predictive-{}", stiffness));
    EXPECT_EQ(kept.object(0).material.stiffness, stiffness);
    EXPECT_EQ(kept.object(0).material.friction_static, 0.5);
    EXPECT_NEAR(kept.object(0).body->mass, 0.05, 1e-12);
    EXPECT_NEAR(kept.plan.document.scene.gravity.z(), -9.81, 1e-9);
    EXPECT_NEAR((kept.hand(0.5) - kept.hand(0)).norm(), 0, 0) << "the hand holds the tip still";
    EXPECT_NEAR(kept.time(kept.size()), 0.6, 2e-3);
    const std::string label = fmt::format("{} N/m", stiffness);
    const Series& fall = made.curve(height, label);
    EXPECT_NEAR(fall.points.front().y, 100, 1e-6);
    for (const FigurePoint& p : fall.points) {
      if (p.x < 0.14) {
        EXPECT_NEAR(p.y, 100 - 1e3 * 9.81 / 2 * p.x * p.x, 0.8) << p.x;
      }
    }
    expect_over_time(made.curve(reserve, label), kept,
                     [&](auto k) { return 1e3 * kept.one(k, Column::energy_ledger); });
    double hardest = 0, least = HUGE_VAL;
    for (std::size_t k = 0; k < kept.size(); ++k) {
      const auto f = kept.session.at(k, Column::contact_force);
      hardest = std::max(hardest, Vec3(f[0], f[1], f[2]).norm());
      least =
          std::min(least, kept.one(k, Column::energy_ledger) - kept.one(0, Column::energy_ledger));
    }
    const std::string which = fmt::format("predictive, {} N/m: ", stiffness);
    EXPECT_EQ(made.check(which + "largest force on the tip [N]").value, hardest);
    EXPECT_EQ(made.check(which +
                         "lowest reserve of the energy account, minus the reserve at the start [J]")
                  .value,
              least);
    EXPECT_GT(hardest, 9.81 * 0.05) << "harder than the block's weight";
  }
  const std::string force = "Force on the tip, K_o = 2000 N/m",
                    beyond = "Energy to the human minus the block's energy, K_o = 2000 N/m";
  for (const char* law : {"predictive", "proposed", "standard"}) {
    const Kept kept = made.kept(fmt::format("{}-2000", law));
    EXPECT_STREQ(name(kept.p.kind), law);
    expect_over_time(made.curve(force, law), kept, [&](auto k) {
      const auto f = kept.session.at(k, Column::contact_force);
      return Vec3(f[0], f[1], f[2]).norm();
    });
    expect_over_time(made.curve(beyond, law), kept, [&](auto k) {
      return 1e3 * (kept.one(k, Column::energy_port) + kept.one(k, Column::energy_to_objects));
    });
  }
  // Free fall takes sqrt(2 h / g) = 0.143 s.
  for (const char* damping : {"0", "2"}) {
    const Series& curve = made.curve(force, fmt::format("staggered, {} N s/m", damping));
    for (std::size_t k = 0; k < curve.points.size(); ++k) {
      EXPECT_NEAR(curve.points[k].x, 1e-3 * static_cast<double>(k), 1e-9);
      EXPECT_EQ(curve.points[k].y > 0, curve.points[k].x > 0.1425) << curve.points[k].x;
      if (curve.points[k].x > 0.146) break;
    }
  }
}

// Blocks of 30 mm on each other, pressed by 1 N from 1 s on.
TEST(FiguresOf, StackSinkUnderTheWeightAbove) {
  const Made made("stack");
  const std::tuple<const char*, const char*, std::vector<double>> stacks[] = {
      {"five", "5 of 20 g", {0.02, 0.02, 0.02, 0.02, 0.02}},
      {"heavy-below", "500, 50, 5 g from below", {0.5, 0.05, 0.005}},
      {"heavy-above", "5, 50, 500 g from below", {0.005, 0.05, 0.5}},
      {"hundred-times", "5, 500 g from below", {0.005, 0.5}}};
  const std::string depths = "Depth of contacts under the weight above";
  expect_on(made.curve(depths, "weight / (4 K_o)"), [](double W) { return 1e3 * W / 80000; });
  for (const auto& [name, label, masses] : stacks) {
    const Kept kept = made.kept(name);
    ASSERT_EQ(kept.plan.document.scene.objects.size(), masses.size() + 1);
    EXPECT_EQ(kept.p.kind, CouplingKind::predictive);
    EXPECT_EQ(kept.p.hand_stiffness, 300);
    const double floor = kept.object(0).pose.translation().z();
    const double top = floor + 0.03 * static_cast<double>(masses.size());
    double weight = 0, give = 1.0 / 300 + 1.0 / 2000, sunk = 0;
    const Series& dots = made.curve(depths, label);
    ASSERT_EQ(dots.points.size(), masses.size());
    for (std::size_t i = masses.size(); i-- > 0;) {
      const Object& block = kept.object(i + 1);
      EXPECT_NEAR(block.body->mass, masses[i], 1e-9);
      EXPECT_EQ(block.material.stiffness, 2000);
      EXPECT_EQ(block.material.friction_static, 0.5);
      EXPECT_NEAR(block.pose.translation().z(), floor + 0.03 * (static_cast<double>(i) + 0.5),
                  1e-9);
      weight += 9.81 * masses[i];
      sunk += weight / 80000;
      EXPECT_NEAR(dots.points[i].x, weight, 1e-9);
      const double place = kept.one(900, Column::body_pose, 7 * i + 2);
      const double below =
          i == 0 ? floor - 0.015 : kept.one(900, Column::body_pose, 7 * (i - 1) + 2);
      EXPECT_NEAR(dots.points[i].y, 1e3 * (0.03 - (place - below)), 1e-6);
    }
    EXPECT_NEAR(kept.hand(0.9).z(), top + 0.004 + 0.005, 1e-9);
    EXPECT_NEAR(kept.hand(1.25).z(), top + 0.004 + 0.005 - (0.005 + give) / 2, 1e-5);
    EXPECT_NEAR(kept.hand(2).z(), top + 0.004 - give, 1e-9);
    EXPECT_NEAR(kept.time(kept.size()), 3, 2e-3);
    const double wanted = (give - sunk) / (give + static_cast<double>(masses.size()) / 80000);
    const double last = kept.one(kept.size() - 1, Column::contact_force, 2);
    EXPECT_NEAR(last, wanted, 0.02 * wanted) << label;
    EXPECT_NEAR(
        made.check(
                std::string(label) +
                ": relative deviation of the final force from the force of all springs in series")
            .value,
        std::abs(last / wanted - 1), 1e-9);
    expect_over_time(
        made.curve("Solver iterations until a tick's contact forces were found", label), kept,
        [&](auto k) { return kept.one(k, Column::objects_sweeps); });
    expect_over_time(
        made.curve("Energy gained by the stack, minus energy given to the stack", label), kept,
        [&](auto k) { return 1e3 * kept.one(k, Column::objects_gain); });
    expect_over_time(made.curve("Force of the top block on the tip", label), kept,
                     [&](auto k) { return kept.one(k, Column::contact_force, 2); });
  }
}

// The longest delay at which a curve of walls is above the softest one, 100 N/m [ms].
double longest_delay(const Series& walls) {
  double longest = 0;
  for (const FigurePoint& p : walls.points) {
    if (p.y > 100 && p.x >= 1) longest = std::max(longest, p.x);
  }
  return longest;
}

// Delays of 0 to 100 ms each way; no delay stands at 0.5 on the logarithmic axis.
TEST(FiguresOf, LinkShowWallsOverTheDelay) {
  const Made made("link");
  const std::string walls = "The stiffest wall on which a tap comes to rest";
  const std::vector<double> delays{0.5, 1, 2, 3, 4, 5, 7, 10, 20, 50, 100};
  const auto expect_delays = [&](const Series& curve, std::size_t count) {
    ASSERT_EQ(curve.points.size(), count) << curve.label;
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(curve.points[i].x, delays[i]) << curve.label;
      EXPECT_GE(curve.points[i].y, 100 - 1e-9) << curve.label;
      EXPECT_LE(curve.points[i].y, 20000 + 1e-9) << curve.label;
    }
  };
  for (const char* law : {"standard, gains by condition (3)", "standard", "proposed", "tank"}) {
    expect_delays(made.curve(walls, law), 11);
  }
  // A law without a link has both ways in its motors, which it knows up to 20 ms.
  expect_delays(made.curve(walls, "predictive, delayed motors instead"), 8);
  expect_delays(made.curve(walls, "predictive, wall computed by `limpid analyze`"), 8);
  const Series &standard = made.curve(walls, "standard"), &tank = made.curve(walls, "tank"),
               &proposed = made.curve(walls, "proposed"),
               &fitted = made.curve(walls, "standard, gains by condition (3)"),
               &lag = made.curve(walls, "proposed, theory");
  // The standard law ends where its poles say, within a quarter. Lines under others are broad.
  const double foretold = longest_delay(made.curve(walls, "standard, theory"));
  EXPECT_GT(foretold, 0);
  EXPECT_NEAR(made.check("standard: longest delay at which a tap comes to rest, divided by the "
                         "longest delay of theory")
                  .value,
              longest_delay(standard) / foretold, 1e-12);
  EXPECT_NEAR(longest_delay(standard) / foretold, 1, 0.25);
  EXPECT_GT(fitted.width, standard.width);
  EXPECT_GT(standard.width, tank.width);
  const auto softest = [](const Series& curve, double to) {
    double least = HUGE_VAL;
    for (const FigurePoint& p : curve.points) {
      if (p.x <= to) least = std::min(least, p.y);
    }
    return least;
  };
  EXPECT_NEAR(made.check("tank, delays up to 50 ms: stiffest wall [N/m]").value, softest(tank, 50),
              1e-6);
  EXPECT_NEAR(made.check("standard, gains by condition (3): stiffest wall [N/m]").value,
              softest(fitted, 100), 1e-6);
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < 3; ++i) {
    least = std::min(least, proposed.points[i].y / lag.points[i].y);
  }
  EXPECT_NEAR(
      made.check(
              "proposed, delays up to 2 ms: stiffest wall, divided by the stiffest wall of theory")
          .value,
      least, 1e-9);
  const std::string energy = "Highest energy E_c on walls of 600 and 5000 N/m";
  double most = 0;
  for (const FigurePoint& p : made.curve(energy, "tank").points) most = std::max(most, p.y);
  EXPECT_NEAR(std::max(1e-3, 1e3 * made.check("tank, delays up to 100 ms: highest E_c [J]").value),
              most, 1e-9);
  expect_on(made.curve(energy, "energy in the tanks at the start"), [](double) { return 5.0; });
  expect_from_to(made.curve(energy, "energy in the tanks at the start"), 0.45, 112, 1e-9);
  // A wall that holds a tap is felt at most as stiff as it is.
  const std::string felt = "Stiffness felt at the device, at the stiffest wall";
  for (const FigurePoint& p : made.curve(felt, "standard").points) EXPECT_LE(p.y, 20000 * 1.25);
  EXPECT_EQ(made.curve(felt, "tank").points.size(), 11u);
}

}  // namespace
}  // namespace limpid
