// Figures of experiments against the recordings that they were drawn from, and the recordings
// against what captions and README say of hand, scene and settings.
#include <map>
#include <numbers>
#include <utility>

#include "app/experiments/coordination.h"
#include "app/experiments/passivity.h"
#include "tests/app/experiments/made.h"

namespace limpid {
namespace {

using test::expect_from_to;
using test::expect_on;
using test::expect_over_time;
using test::Kept;
using test::Made;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

// The dots of |x_E| over |f2| are rows in contact.
void expect_rows_in_contact(const Series& dots, const Kept& kept) {
  std::multimap<double, double> rows;
  for (std::size_t k = 0; k < kept.size(); ++k) {
    const double f2 = kept.norm(k, Column::contact_torque);
    if (f2 > 0) rows.emplace(f2, 1e3 * kept.error(k));
  }
  EXPECT_GT(dots.points.size(), 50u);
  for (const FigurePoint& p : dots.points) {
    const auto [first, last] = rows.equal_range(p.x);
    EXPECT_TRUE(std::any_of(first, last,
                            [&](const auto& row) { return std::abs(p.y - row.second) <= 1e-9; }))
        << p.x << ", " << p.y;
  }
}

// The least-squares line through the origin of all rows in contact [mrad/(N m)].
double slope_of(const Kept& kept) {
  double xy = 0, xx = 0;
  for (std::size_t k = 0; k < kept.size(); ++k) {
    const double f2 = kept.norm(k, Column::contact_torque);
    if (f2 <= 1e-6) continue;
    xy += f2 * kept.error(k);
    xx += f2 * f2;
  }
  return 1e3 * xy / xx;
}

double largest_error(const Kept& kept) {
  double most = 0;
  for (std::size_t k = 0; k < kept.size(); ++k) most = std::max(most, kept.error(k));
  return most;
}

// A contact lasts a tenth of a second, and comes that long after the one before.
TEST(LastingContacts, AreLongAndApart) {
  Session s;
  const auto stride = static_cast<std::size_t>(s.layout.stride());
  const auto add = [&](std::size_t rows, double torque) {
    for (std::size_t i = 0; i < rows; ++i) {
      s.rows.resize(s.rows.size() + stride, 0.0);
      s.layout.in(std::span(s.rows).last(stride), Column::contact_torque)[1] = torque;
    }
  };
  EXPECT_EQ(lasting_contacts(s), 0);
  add(150, 0);
  EXPECT_EQ(lasting_contacts(s), 0) << "nothing is touched";
  add(99, 0.1);
  EXPECT_EQ(lasting_contacts(s), 0) << "too short";
  add(150, 0);
  add(150, -0.1);
  EXPECT_EQ(lasting_contacts(s), 1);
  add(50, 0);
  add(150, 0.1);
  EXPECT_EQ(lasting_contacts(s), 1) << "the same one, lifted for a moment";
  add(120, 0);
  add(100, 0.1);
  EXPECT_EQ(lasting_contacts(s), 2);
}

TEST(FiguresOf, CoordinationShowItsFourRuns) {
  const Made made("coordination");
  EXPECT_THAT(made.trials(),
              UnorderedElementsAre("standard", "proposed", "inertia-error-0.5", "inertia-error-2"));
  const Kept standard = made.kept("standard"), proposed = made.kept("proposed"),
             half = made.kept("inertia-error-0.5"), twice = made.kept("inertia-error-2");
  EXPECT_EQ(standard.p.kind, CouplingKind::standard);
  for (const Kept* one : {&proposed, &half, &twice}) {
    EXPECT_EQ(one->p.kind, CouplingKind::proposed);
    EXPECT_EQ(one->plan.hand.position, standard.plan.hand.position) << "the same hand";
    EXPECT_EQ(one->size(), standard.size());
  }
  EXPECT_EQ(proposed.p.inertia_error, 1);
  EXPECT_EQ(half.p.inertia_error, 0.5);
  EXPECT_EQ(twice.p.inertia_error, 2);
  constexpr const char* kJoints[] = {"Turret", "Shoulder", "Elbow"};
  for (const auto& [kept, law] : {std::pair(&standard, "standard"), {&proposed, "proposed"}}) {
    for (std::size_t j = 0; j < 3; ++j) {
      const std::string title = fmt::format("{}, {} coupling", kJoints[j], law);
      expect_over_time(made.curve(title, "device x1"), *kept,
                       [&](auto k) { return kept->one(k, Column::device_position, j); });
      expect_over_time(made.curve(title, "proxy x2"), *kept,
                       [&](auto k) { return kept->one(k, Column::proxy_position, j); });
    }
    expect_over_time(made.curve("Contact torque |f2|", law), *kept,
                     [&](auto k) { return kept->norm(k, Column::contact_torque); });
    expect_over_time(made.curve("Coordination error |x1 - x2|", law), *kept,
                     [&](auto k) { return 1e3 * kept->error(k); });
  }
  for (const auto& [kept, label] :
       {std::pair(&half, "half the inertia"), {&twice, "twice the inertia"}}) {
    expect_over_time(
        made.curve("Proposed coupling: error added by a wrong inertia in the model", label), *kept,
        [&](auto k) { return 1e6 * (kept->error(k) - proposed.error(k)); });
  }
}

TEST(FiguresOf, CoordinationPutALineThroughTheContacts) {
  const Made made("coordination");
  const std::string title = "Coordination error against contact torque";
  const FigurePanel& panel = made.panel(title);
  ASSERT_EQ(panel.series.size(), 4u);
  std::size_t at = 0;
  for (const char* law : {"standard", "proposed"}) {
    const Kept kept = made.kept(law);
    expect_rows_in_contact(panel.series[at], kept);
    EXPECT_EQ(panel.series[at++].style, Series::Style::points);
    const Series& line = panel.series[at++];
    const double slope = slope_of(kept);
    EXPECT_EQ(line.label, fmt::format("{}: {:.3g} mrad/(N m)", law, slope));
    expect_on(line, [&](double f2) { return slope * f2; });
    EXPECT_EQ(line.points.front().x, 0);
    EXPECT_EQ(line.points.back().x,
              std::ranges::max(panel.series[at - 2].points, {}, &FigurePoint::x).x);
  }
  const double standard = slope_of(made.kept("standard"));
  EXPECT_NEAR(standard, 1e3 / Parameters{}.k_vc, 2) << "the error is f2 / k_vc";
  const Kept right = made.kept("proposed");
  for (const char* error : {"0.5", "2"}) {
    const Kept wrong = made.kept(std::string("inertia-error-") + error);
    EXPECT_NEAR(made.check(fmt::format("largest error if the model has {} times the inertia, "
                                       "divided by the largest error with the right inertia",
                                       error))
                    .value,
                largest_error(wrong) / largest_error(right), 1e-9);
    EXPECT_NEAR(made.check(fmt::format("slope of the error if the model has {} times the inertia, "
                                       "divided by the slope of the standard coupling",
                                       error))
                    .value,
                slope_of(wrong) / standard, 1e-9);
  }
  EXPECT_NEAR(made.check("largest error, proposed coupling divided by standard coupling").value,
              largest_error(right) / largest_error(made.kept("standard")), 1e-9);
}

TEST(FiguresOf, InertiaShowThreeEtasInOneHand) {
  const Made made("inertia");
  EXPECT_THAT(made.trials(), ElementsAre("eta-0.6", "eta-1", "eta-5"));
  const Kept one = made.kept("eta-1");
  const auto rms = [](const Kept& kept) {
    double sum = 0;
    for (std::size_t k = 0; k < kept.size(); ++k) {
      sum += kept.vec(k, Column::hand_torque).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(kept.size()));
  };
  std::size_t unnamed = 0;
  for (const double eta : {0.6, 1.0, 5.0}) {
    const Kept kept = made.kept(fmt::format("eta-{}", eta));
    EXPECT_EQ(kept.p.eta, eta);
    EXPECT_EQ(kept.p.kind, CouplingKind::proposed);
    EXPECT_THAT(made.figure().caption,
                HasSubstr(fmt::format("grip {} N/m and {} N s/m", kept.p.hand_stiffness,
                                      kept.p.hand_damping)));
    EXPECT_TRUE(kept.plan.document.scene.objects.empty()) << "no contact";
    const std::string label = fmt::format("eta = {}", eta),
                      title = "Human torque |f1| and its estimate";
    expect_over_time(made.curve(title, label), kept,
                     [&](auto k) { return kept.norm(k, Column::hand_torque); });
    const Series& estimate =
        eta == 0.6 ? made.curve(title, "estimates") : made.unnamed(title, unnamed++);
    expect_over_time(estimate, kept,
                     [&](auto k) { return kept.norm(k, Column::hand_torque_estimate); });
    EXPECT_EQ(estimate.style, Series::Style::dashed);
    expect_over_time(made.curve("Shoulder angle: the same motion at all three etas", label), kept,
                     [&](auto k) { return kept.one(k, Column::device_position, 1); });
    if (eta == 1) continue;
    EXPECT_NEAR(made.check(fmt::format("rms human torque at eta = {}: relative deviation from eta "
                                       "times the rms torque at eta = 1",
                                       eta))
                    .value,
                std::abs(rms(kept) / (eta * rms(one)) - 1), 1e-9);
    double difference = 0, range = 0;
    for (std::size_t k = 0; k < one.size(); ++k) {
      const Eigen::VectorXd x = one.vec(k, Column::device_position);
      difference = std::max(difference, (x - kept.vec(k, Column::device_position)).norm());
      range = std::max(range, (x - one.vec(0, Column::device_position)).norm());
    }
    EXPECT_NEAR(made.check(fmt::format("difference between the motions at eta = {} and at eta = 1, "
                                       "divided by the range of motion",
                                       eta))
                    .value,
                difference / range, 1e-9);
  }
}

// The hand goes down to 55 mm within 0.5 s, rests there until 1.2 s, and is back within 0.15 s.
TEST(FiguresOf, SaturationShowFourPresses) {
  const Made made("saturation");
  EXPECT_THAT(made.trials(), ElementsAre("anti-windup", "predictive", "standard", "wound-up"));
  const Kept with = made.kept("anti-windup"), without = made.kept("wound-up"),
             standard = made.kept("standard"), predicted = made.kept("predictive");
  EXPECT_EQ(with.p.kind, CouplingKind::proposed);
  EXPECT_EQ(without.p.kind, CouplingKind::proposed);
  EXPECT_EQ(standard.p.kind, CouplingKind::standard);
  EXPECT_EQ(predicted.p.kind, CouplingKind::predictive);
  EXPECT_FALSE(without.p.anti_windup);
  for (const Kept* kept : {&with, &without, &standard, &predicted}) {
    EXPECT_EQ(kept->p.eta, 0.6);
    EXPECT_EQ(kept->p.torque_limit, 0.2);
    EXPECT_EQ(kept->p.anti_windup, kept != &without);
    EXPECT_EQ(kept->object(0).material.stiffness, 600);
    EXPECT_NEAR(kept->object(0).pose.translation().z(), -0.04, 1e-12);
    EXPECT_NEAR(kept->hand(0).z(), 0, 1e-9);
    EXPECT_NEAR(kept->hand(0.25).z(), -0.055 / 2, 1e-4) << "half way after half of the time";
    for (const double t : {0.5, 0.9, 1.2}) EXPECT_NEAR(kept->hand(t).z(), -0.055, 1e-6) << t;
    EXPECT_NEAR(kept->hand(1.275).z(), -0.055 / 2, 4e-4);
    for (const double t : {1.35, 1.6}) EXPECT_NEAR(kept->hand(t).z(), 0, 1e-6) << t;
    EXPECT_NEAR(kept->time(kept->size()), 1.7, 2e-3);
    EXPECT_NEAR(kept->hand(0.7).x(), 0.19, 1e-9);
    EXPECT_NEAR(kept->hand(0.7).y(), 0, 1e-9);
  }
  const auto shoulder = [&](const char* title, const char* label, const Kept& kept, Column c) {
    expect_over_time(made.curve(title, label), kept, [&](auto k) { return kept.one(k, c, 1); });
  };
  for (const char* title :
       {"Human torque at the shoulder", "Human torque at the shoulder while the hand pulls out"}) {
    shoulder(title, "estimate, no anti-windup", without, Column::hand_torque_estimate);
    shoulder(title, "true, no anti-windup", without, Column::hand_torque);
    shoulder(title, "estimate, anti-windup", with, Column::hand_torque_estimate);
    shoulder(title, "true, anti-windup", with, Column::hand_torque);
    shoulder(title, "true, predictive", predicted, Column::hand_torque);
  }
  const char* motors = "Torque of the shoulder's motor, commanded and given";
  shoulder(motors, "commanded, no anti-windup", without, Column::commanded_torque);
  shoulder(motors, "commanded, anti-windup", with, Column::commanded_torque);
  shoulder(motors, "given, no anti-windup", without, Column::motor_torque);
  shoulder(motors, "given, anti-windup", with, Column::motor_torque);
  shoulder(motors, "given, predictive", predicted, Column::motor_torque);
  for (const auto& [kept, law] :
       {std::pair(&with, "proposed"), {&predicted, "predictive"}, {&standard, "standard"}}) {
    for (const auto& [what, c] :
         {std::pair("device", Column::device_position), {"proxy", Column::proxy_position}}) {
      expect_over_time(made.curve("Depth of device and proxy in the table, under each coupling",
                                  fmt::format("{}, {}", what, law)),
                       *kept, [&, c = c](auto k) { return 1e3 * (-0.04 - kept->tip(k, c).z()); });
    }
  }
  const auto& out = made.panel("Human torque at the shoulder while the hand pulls out");
  EXPECT_EQ(out.x_range, std::pair(1.2, 1.45));
}

TEST(FiguresOf, SaturationJudgeWhatWasRecorded) {
  const Made made("saturation");
  const Kept with = made.kept("anti-windup"), without = made.kept("wound-up"),
             predicted = made.kept("predictive");
  const auto rms = [](const Kept& kept, double from, double to, const auto& value) {
    double sum = 0;
    for (std::size_t k = kept.row(from); k < kept.row(to); ++k) sum += value(k).squaredNorm();
    return std::sqrt(sum / static_cast<double>(kept.row(to) - kept.row(from)));
  };
  const auto of = [](const Kept& kept, Column c) {
    return [&kept, c](std::size_t k) { return kept.vec(k, c); };
  };
  const auto error = [](const Kept& kept) {
    return [&kept](std::size_t k) -> Eigen::VectorXd {
      return kept.vec(k, Column::hand_torque_estimate) - kept.vec(k, Column::hand_torque);
    };
  };
  const auto pull = [](const Kept& kept) {
    double most = 0;
    for (std::size_t k = kept.row(1.2); k < kept.size(); ++k) {
      most = std::max(most, -kept.one(k, Column::hand_torque, 1));
    }
    return most;
  };
  // All rests from 0.8 s on, until the hand leaves at 1.2 s.
  EXPECT_NEAR(made.checks()[0].value,
              rms(with, 0.8, 1.2, error(with)) / rms(with, 0.8, 1.2, of(with, Column::hand_torque)),
              1e-3 * made.checks()[0].value);
  EXPECT_NEAR(made.checks()[1].value,
              rms(without, 0.8, 1.2, of(without, Column::hand_torque_estimate)) /
                  rms(without, 0.8, 1.2, of(without, Column::hand_torque)),
              1e-3 * made.checks()[1].value);
  EXPECT_NEAR(made.checks()[3].value,
              rms(without, 1.2, 1.35, error(without)) / rms(with, 1.2, 1.35, error(with)),
              0.02 * made.checks()[3].value);
  EXPECT_NEAR(made.checks()[4].value, pull(without) / pull(with), 1e-9);
  EXPECT_NEAR(made.checks()[5].value, pull(with) / pull(predicted), 1e-9);
}

// 120 corners and 48 more, each a point at its motors' limit, which is drawn between 0.1 and 0.6 N
// m.
TEST(FiguresOf, SaturationHaveAPointForEachCorner) {
  const Made made("saturation");
  const std::string torque = "Tip pressed into random corners of walls: contact torque";
  const std::string steps = "Tip pressed into random corners of walls: the proxy's steps";
  const std::pair<const char*, std::size_t> sets[] = {{"built-in arm", 120},
                                                      {"other arms, more walls, any eta", 48}};
  const double bounds[] = {1.3, 1.6};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& [label, count] = sets[i];
    const Series &torques = made.curve(torque, label), &jumps = made.curve(steps, label);
    ASSERT_EQ(torques.points.size(), count);
    ASSERT_EQ(jumps.points.size(), count);
    double most_torque = 0, most_jump = 0;
    for (std::size_t k = 0; k < count; ++k) {
      EXPECT_GE(torques.points[k].x, 0.1);
      EXPECT_LE(torques.points[k].x, 0.6);
      EXPECT_EQ(torques.points[k].x, jumps.points[k].x);
      EXPECT_GT(torques.points[k].y, 0) << "it is pressed into corner " << k;
      EXPECT_GT(jumps.points[k].y, 0) << "it moves on its way into corner " << k;
      most_torque = std::max(most_torque, torques.points[k].y);
      most_jump = std::max(most_jump, jumps.points[k].y);
    }
    const std::string where = fmt::format("{} corners, {}: ", count, label);
    EXPECT_EQ(made.check(where + "largest contact torque, divided by the motors' limit").value,
              most_torque);
    EXPECT_NEAR(1e3 * made.check(where + "longest step of the proxy in a tick [rad]").value,
                most_jump, 1e-9);
    expect_on(made.curve(torque, fmt::format("bound, {}", label)),
              [&](double) { return bounds[i]; });
  }
  expect_on(made.curve(steps, "bound"), [](double) { return 10.0; });
}

// The tip is pressed with 3 N on a plane of 1000 N/m within 0.5 s, and dragged by 30 mm within
// 1.5 s, and back.
TEST(FiguresOf, FrictionShowItsDrags) {
  const Made made("friction");
  const std::tuple<const char*, const char*, double, double> drags[] = {
      {"drag-0.5-0.3", "0.5 static, 0.3 kinetic", 0.5, 0.3},
      {"drag-0.2-0.2", "0.2 for both", 0.2, 0.2},
      {"drag-0-0", "smooth", 0, 0}};
  const std::string title =
      "Tangential force divided by normal force, while the hand moves sideways";
  for (const auto& [name, label, sticking, slipping] : drags) {
    const Kept kept = made.kept(name);
    EXPECT_EQ(kept.p.kind, CouplingKind::predictive);
    EXPECT_EQ(kept.p.hand_stiffness, 300);
    EXPECT_EQ(kept.p.hand_damping, 2);
    ASSERT_EQ(kept.plan.document.scene.objects.size(), 1u);
    const Material& material = kept.object(0).material;
    EXPECT_EQ(material.stiffness, 1000);
    EXPECT_EQ(material.friction_static, sticking);
    EXPECT_EQ(material.friction_kinetic, slipping);
    EXPECT_NEAR(kept.hand(0).z(), -0.04 + 0.005, 1e-9);
    for (const double t : {0.5, 2.0, 3.4}) {
      EXPECT_NEAR(kept.hand(t).z(), -0.04 - 3.0 / 300 - 3.0 / 1000, 1e-6) << t;
    }
    EXPECT_NEAR(kept.hand(0.5).y(), 0, 1e-9);
    EXPECT_NEAR(kept.hand(1.25).y(), 0.015, 1e-6);
    EXPECT_NEAR(kept.hand(2.0).y(), 0.03, 1e-6);
    EXPECT_NEAR(kept.hand(3.499).y(), 0, 1e-6);
    EXPECT_NEAR(kept.time(kept.size()), 3.5, 2e-3);
    const Series& curve = made.curve(title, label);
    EXPECT_GT(curve.points.size(), 1000u);
    double most = 0;
    for (const FigurePoint& p : curve.points) {
      EXPECT_LE(std::abs(p.y), sticking + 1e-6);
      EXPECT_GE(p.x, -1e-6);
      EXPECT_LE(p.x, 30 + 1e-6);
      most = std::max(most, std::abs(p.y));
    }
    EXPECT_GE(most, 0.99 * sticking) << "it breaks away at the cone";
    EXPECT_NEAR(std::ranges::max(curve.points, {}, &FigurePoint::x).x, 30, 0.01);
    EXPECT_NEAR(curve.points.front().x, 0, 0.01) << "from where it pressed";
    EXPECT_NEAR(curve.points.back().x, 0, 0.01) << "and back";
    if (sticking == 0) continue;
    // On the way there the plane drags the tip back, on the way back it drags it forth.
    const std::size_t half = curve.points.size() / 2;
    EXPECT_NEAR(curve.points[half / 2].y, slipping, 0.02 + (sticking - slipping));
    EXPECT_LT(curve.points[half + half / 2].y, 0);
  }
  const Kept rough = made.kept("drag-0.5-0.3");
  const std::string slip = "Stick and slip: 0.5 static, 0.3 kinetic";
  expect_over_time(made.curve(slip, "hand"), rough,
                   [&](auto k) { return 1e3 * rough.one(k, Column::hand_target, 1); });
  expect_over_time(made.curve(slip, "device"), rough,
                   [&](auto k) { return 1e3 * rough.tip(k, Column::device_position).y(); });
  expect_over_time(made.curve(slip, "proxy"), rough,
                   [&](auto k) { return 1e3 * rough.tip(k, Column::proxy_position).y(); });
  const std::string taken =
      "Energy that friction gave: work of its force plus energy in its spring";
  const auto& smooth = made.curve(taken, "smooth");
  expect_on(
      smooth, [](double) { return 0.0; }, 1e-6);
  for (const char* label : {"0.5 static, 0.3 kinetic", "0.2 for both"}) {
    const Series& curve = made.curve(taken, label);
    for (std::size_t i = 1; i < curve.points.size(); ++i) {
      EXPECT_LE(curve.points[i].y, curve.points[i - 1].y + 1e-3) << "it only takes";
    }
    // Slipping over 60 mm under 3 N takes mu N s, less the stretches in which it sticks.
    const double all = 1e3 * 0.06 * 3 * (label[2] == '5' ? 0.3 : 0.2);
    EXPECT_NEAR(curve.points.back().y, -all, 0.25 * all) << label;
  }
}

TEST(FiguresOf, FrictionShowEdgesAndCorners) {
  const Made made("friction");
  constexpr const char* kWhich[] = {"motors of 100 N m", "the arm's own motors"};
  for (const bool strong : {true, false}) {
    const std::string which = kWhich[strong ? 0 : 1];
    double energy = 0;
    for (const int walls : {2, 3}) {
      for (const double mu : {0.0, 0.5, 1.0}) {
        for (const auto& [eta, grip] : {std::pair(0.3, 300.0), {1.0, 3000.0}}) {
          const std::string place = walls == 2 ? "edge" : "corner";
          const Kept kept = made.kept(
              fmt::format("{}-{}-eta-{}-{}-motors", place, mu, eta, strong ? "strong" : "own"));
          EXPECT_EQ(kept.p.eta, eta);
          EXPECT_EQ(kept.p.hand_stiffness, grip);
          EXPECT_EQ(kept.p.kind, CouplingKind::predictive);
          if (strong) {
            EXPECT_EQ(kept.p.torque_limit, 100);
          } else {
            EXPECT_TRUE(std::isnan(kept.p.torque_limit));
          }
          ASSERT_EQ(kept.plan.document.scene.objects.size(), static_cast<std::size_t>(walls));
          Vec3 out = Vec3::Zero();
          for (int i = 0; i < walls; ++i) {
            const Object& wall = kept.object(static_cast<std::size_t>(i));
            EXPECT_EQ(wall.material.stiffness, 3000);
            EXPECT_EQ(wall.material.friction_static, mu);
            EXPECT_EQ(wall.material.friction_kinetic, mu);
            out += std::get<Plane>(wall.shape).normal;
          }
          // The hand comes from 10 mm before the walls, straight, and wanders about a place in
          // which it presses with 5 N, by half as much along each axis.
          const Vec3 meet(0.2, 0, -0.04), in = -out.normalized();
          const double press = 5 / grip + 5.0 / 3000;
          EXPECT_NEAR((kept.hand(0) - (meet - 0.01 * in)).norm(), 0, 1e-6);
          EXPECT_NEAR((kept.hand(0.3) - (meet + press * in)).norm(), 0, 1e-6);
          for (double t = 0.65; t < 1.59; t += 0.1) {
            const Vec3 about(std::sin(6 * t), std::sin(9 * t), std::cos(7 * t));
            EXPECT_NEAR((kept.hand(t) - meet - press * in - 0.5 * press * about).norm(), 0, 1e-6);
          }
          EXPECT_NEAR(kept.time(kept.size()), 1.6, 2e-3);
          for (std::size_t k = 0; k < kept.size(); ++k) {
            energy = std::max(energy, kept.one(k, Column::energy_total));
          }
          if (grip != 300) continue;
          expect_over_time(made.curve("Tip rubbed along walls of 3000 N/m, " + which,
                                      fmt::format("{}, coefficient {}", place, mu)),
                           kept, [&](auto k) { return 1e3 * kept.one(k, Column::energy_total); });
        }
      }
    }
    EXPECT_NEAR(made.check("edge and corner, " + which + ": highest E_c [J]").value, energy, 1e-12);
  }
}

// A hand swings by 6 mm at 3.3 Hz about the middle, across the stop at the joint's zero.
TEST(FiguresOf, SwitchingShowStopsAndTurns) {
  const Made made("switching");
  for (const auto& [name, law, stop] :
       {std::tuple("stop-20-proposed", CouplingKind::proposed, 20.0),
        {"stop-20-predictive", CouplingKind::predictive, 20.0},
        {"stop-500-predictive", CouplingKind::predictive, 500.0}}) {
    const Kept kept = made.kept(name);
    EXPECT_EQ(kept.p.kind, law);
    EXPECT_EQ(kept.p.hand_stiffness, 300);
    EXPECT_EQ(kept.p.hand_damping, 2);
    EXPECT_EQ(kept.p.eta, 1);
    EXPECT_EQ(kept.object(0).material.stiffness, stop);
    EXPECT_TRUE(has_shape<JointStop>(kept.object(0)));
    for (double t = 0; t < 2.49; t += 0.083) {
      const double s = kept.time(kept.row(t));
      EXPECT_NEAR(kept.hand(t).y(), -0.006 * std::cos(2 * std::numbers::pi * 3.3 * s), 1e-9);
      EXPECT_NEAR(kept.hand(t).x(), 0.19, 1e-12);
    }
    EXPECT_NEAR(kept.time(kept.size()), 2.5, 2e-3);
  }
  const Kept ours = made.kept("stop-20-predictive");
  const std::string stop = "A joint moves into its stop of 20 N m/rad and out again";
  expect_over_time(made.curve(stop, "device x1"), ours,
                   [&](auto k) { return 1e3 * ours.one(k, Column::device_position, 0); });
  expect_over_time(made.curve(stop, "proxy x2"), ours,
                   [&](auto k) { return 1e3 * ours.one(k, Column::proxy_position, 0); });
  const std::string gave = "Energy that the stop created";
  const Kept paper = made.kept("stop-20-proposed");
  expect_over_time(made.curve(gave, "proposed, 20 N m/rad"), paper,
                   [&](auto k) { return 1e6 * paper.one(k, Column::contact_gain); });
  for (const char* label : {"predictive, 20 N m/rad", "predictive, 500 N m/rad"}) {
    expect_on(
        made.curve(gave, label), [](double) { return 0.0; }, 1e-3);
  }
}

TEST(FiguresOf, SwitchingFollowEachLawByEachOther) {
  const Made made("switching");
  const Kept turns = made.kept("switching");
  // 1 N on 600 N/m in a grip of 300 N/m; each of the six switches 0.3 s after the one before.
  EXPECT_NEAR(turns.hand(0).z(), -0.03, 1e-9);
  EXPECT_NEAR(turns.hand(0.25).z(), -0.04 + 0.01 - (0.01 + 1.0 / 300 + 1.0 / 600) / 2, 1e-4);
  EXPECT_NEAR(turns.hand(1).z(), -0.04 - 1.0 / 300 - 1.0 / 600, 1e-9);
  EXPECT_NEAR(turns.hand(1).x(), 0.2, 1e-9);
  EXPECT_NEAR(turns.time(turns.size()), 0.8 + 6 * 0.3, 2e-3);
  std::set<std::pair<double, double>> followed;
  std::vector<double> when;
  for (std::size_t k = 1; k < turns.size(); ++k) {
    const double before = turns.one(k - 1, Column::kind), now = turns.one(k, Column::kind);
    if (before == now) continue;
    followed.emplace(before, now);
    when.push_back(turns.time(k));
  }
  EXPECT_EQ(followed.size(), 6u) << "three laws, each after each other one";
  ASSERT_EQ(when.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(when[i], 0.8 + 0.3 * static_cast<double>(i), 2e-3);
  const std::string torque =
      "Motor torque while the couplings change and the hand presses the table";
  constexpr const char* kJoints[] = {"turret", "shoulder", "elbow"};
  for (std::size_t j = 0; j < 3; ++j) {
    expect_over_time(made.curve(torque, kJoints[j]), turns,
                     [&](auto k) { return turns.one(k, Column::motor_torque, j); });
  }
  std::vector<double> lines;
  for (const Series& s : made.panel(torque).series) {
    if (s.style == Series::Style::dashed) lines.push_back(s.points.front().x);
  }
  ASSERT_EQ(lines.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(lines[i], when[i], 2e-3);
  const std::string apart = "Distance of device and proxy while the couplings change";
  std::size_t shown = 0;
  for (const char* law : {"standard", "proposed", "predictive"}) {
    for (const FigurePoint& p : made.curve(apart, law).points) {
      const std::size_t k = turns.row(p.x);
      EXPECT_STREQ(name(static_cast<CouplingKind>(turns.one(k, Column::kind))), law);
      EXPECT_NEAR(p.y, 1e3 * turns.error(k), 1e-9);
      ++shown;
    }
  }
  EXPECT_EQ(shown, (turns.size() + 1) / 2) << "every other row, each once";
  double most = 0, last = 0;
  std::size_t since = 0;
  for (std::size_t k = turns.row(0.8); k < turns.size(); ++k) {
    const Eigen::VectorXd change =
        turns.vec(k, Column::motor_torque) - turns.vec(k - 1, Column::motor_torque);
    since = turns.one(k, Column::kind) != turns.one(k - 1, Column::kind) ? 0 : since + 1;
    (since < 300 ? most : last) = std::max(most, change.cwiseAbs().maxCoeff());
  }
  EXPECT_NEAR(std::max(made.checks()[4].value, made.checks()[5].value), std::max(most, last),
              1e-12);
}

// Each curve is the mean of ten trials, in their band, over the time of each.
TEST(FiguresOf, PassivityShowMeansAndBandsOfTenTrials) {
  const Made made("passivity");
  std::map<std::string, std::vector<Kept>> cases;
  for (const auto& [label, file, kind, eta] :
       {std::tuple("eta = 0.6", "eta-0.6", CouplingKind::proposed, 0.6),
        {"eta = 5", "eta-5", CouplingKind::proposed, 5.0},
        {"standard", "standard", CouplingKind::standard, 1.0}}) {
    for (int i = 0; i < 10; ++i) {
      cases[label].push_back(made.kept(fmt::format("{}-{}", file, i)));
      EXPECT_EQ(cases[label].back().p.kind, kind);
      EXPECT_EQ(cases[label].back().p.eta, eta);
    }
  }
  for (const auto& [title, column] :
       {std::pair("Total", Column::energy_total), {"Commanded", Column::energy_commanded}}) {
    const FigurePanel& panel = made.panel(title);
    for (const auto& [label, trials] : cases) {
      const Series& curve = made.curve(title, label);
      const Series& band = *(&curve - 1);
      ASSERT_GT(&curve, panel.series.data());
      EXPECT_EQ(band.style, Series::Style::band);
      EXPECT_EQ(curve.style, label == "standard" ? Series::Style::dashed : Series::Style::line);
      ASSERT_EQ(curve.points.size(), 201u);
      double highest = 0;
      for (std::size_t i = 0; i <= 200; i += 8) {
        double sum = 0, low = HUGE_VAL, high = -HUGE_VAL;
        for (const Kept& one : trials) {
          const double e = 1e3 * one.one(i * (one.size() - 1) / 200, column);
          sum += e;
          low = std::min(low, e);
          high = std::max(high, e);
        }
        EXPECT_NEAR(curve.points[i].x, static_cast<double>(i) / 200, 1e-12);
        EXPECT_NEAR(curve.points[i].y, sum / 10, 1e-9);
        EXPECT_NEAR(band.points[i].low, low, 1e-9);
        EXPECT_NEAR(band.points[i].high, high, 1e-9);
      }
      for (const Kept& one : trials) {
        for (std::size_t k = 0; k < one.size(); ++k) {
          highest = std::max(highest, one.one(k, column));
        }
      }
      const std::string what = column == Column::energy_total
                                   ? "highest total E_c of all trials, "
                                   : "highest commanded E_c of all trials, ";
      EXPECT_EQ(made.check(what + label + " [J]").value, highest);
    }
  }
  EXPECT_NEAR(made.check("mean of the final total E_c: standard minus eta = 0.6 [J]").value,
              1e-3 * (made.curve("Total", "standard").points.back().y -
                      made.curve("Total", "eta = 0.6").points.back().y),
              1e-12);
}

// The device is nudged by a tenth of a millimetre along each axis, in an undamped grip of 3000 N/m,
// a tenth above and below the smallest stable eta.
TEST(FiguresOf, PassivityHoldTheDeviceInAStiffGrip) {
  const Made made("passivity");
  const Kept above = made.kept("grip-above"), below = made.kept("grip-below");
  EXPECT_NEAR(above.p.eta / below.p.eta, 1.1 / 0.9, 1e-9);
  EXPECT_THAT(made.figure().caption, HasSubstr(fmt::format("{:.3f}", above.p.eta / 1.1)));
  for (const auto& [kept, which] : {std::pair(&above, "above"), {&below, "below"}}) {
    EXPECT_EQ(kept->p.hand_stiffness, 3000);
    EXPECT_EQ(kept->p.hand_damping, 0);
    EXPECT_NEAR((kept->hand(0.09) - kept->hand(0)).norm(), 0, 1e-12);
    for (const double t : {0.13, 1.5}) {
      EXPECT_NEAR((kept->hand(t) - kept->hand(0) - Vec3::Constant(1e-4)).norm(), 0, 1e-9);
    }
    const Series& curve = made.curve("Held in a stiff grip",
                                     fmt::format("eta {:.3f}, {} the limit", kept->p.eta, which));
    EXPECT_GT(curve.points.size(), 60u);
    for (const FigurePoint& p : curve.points) {
      double most = 0;
      for (std::size_t k = kept->row(p.x); k < kept->row(p.x) + 20; ++k) {
        most = std::max(most, kept->norm(k, Column::device_velocity));
      }
      EXPECT_NEAR(p.y, most, 1e-12) << p.x;
    }
    EXPECT_GE(curve.points.front().x, 0.08) << "nothing moves before";
  }
}

// Welch's densities add up to the mean square of the velocity, but for the ends of a trial, which
// is at rest there: Hann's windows hardly see them.
TEST(FiguresOf, SpectrumShareOutThePowerOfTheVelocity) {
  const Made made("spectrum");
  const std::string density = "Power density of the velocity",
                    part = "Share of the power up to a frequency";
  const Series& mean = made.curve(density, "mean of all trials");
  const double step = mean.points[1].x - mean.points[0].x;
  EXPECT_NEAR(step, 1000.0 / 2048, 1e-12);
  EXPECT_NEAR(mean.points.back().x, 25, step);
  double power = 0;
  for (const FigurePoint& p : mean.points) {
    EXPECT_LE(p.low, p.y);
    EXPECT_GE(p.high, p.y);
    power += p.y * step;
  }
  double square = 0;
  for (const PassivityCase& one : passivity_cases()) {
    for (const Trial& trial : passivity_trials(built_in_arm(), one, 0)) {
      const Kept kept = made.kept(trial.name, "passivity");
      double sum = 0;
      for (std::size_t k = 0; k < kept.size(); ++k) {
        sum += kept.vec(k, Column::device_velocity).squaredNorm();
      }
      square += sum / static_cast<double>(kept.size()) / 50;
    }
  }
  EXPECT_NEAR(power, square, 0.3 * square);
  const Series& share = made.curve(part, "mean of all trials");
  for (std::size_t i = 1; i < share.points.size(); ++i) {
    EXPECT_GE(share.points[i].y, share.points[i - 1].y);
    EXPECT_LE(share.points[i].high, 1 + 1e-12);
  }
  EXPECT_NEAR(share.points.back().y, 1, 0.02);
  for (const auto& [title, high] : {std::pair(density, 0.0), {part, 1.02}}) {
    const Series& line = made.curve(title, "5 Hz");
    for (const FigurePoint& p : line.points) EXPECT_EQ(p.x, 5);
    const auto& range = made.panel(title).y_range;
    ASSERT_TRUE(range);
    EXPECT_EQ(line.points.front().y, range->first);
    EXPECT_EQ(line.points.back().y, range->second);
    if (high > 0) {
      EXPECT_EQ(range->second, high);
    }
  }
  EXPECT_GE(made.checks()[0].value, made.checks()[1].value)
      << "the liveliest trial has the least below 5 Hz";
}

}  // namespace
}  // namespace limpid
