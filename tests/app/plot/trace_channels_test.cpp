#include "app/plot/trace_channels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <sstream>
#include <vector>

#include "tests/devices/files/session/sample_session.h"
#include "tests/support/built_in.h"
#include "tests/support/rows.h"
#include "tests/support/test_session.h"

namespace limpid {
namespace {

class TraceChannelsOfJoints : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Arms, TraceChannelsOfJoints, testing::Values(1, 2, 3, 7, 32));

TEST_P(TraceChannelsOfJoints, AreTheQuantitiesOfTheRow) {
  const int n = GetParam();
  const RowLayout layout(n);
  const TraceChannels channels(layout);
  ASSERT_GT(channels.count(), 8 + n);
  test::Rows rows(layout);
  rows.add(test::sample_rows(layout, 5, 1));
  std::vector<double> values(static_cast<std::size_t>(channels.count()));
  channels.values(rows.row(0), values);
  const auto value = [&](Channel c) { return values[static_cast<std::size_t>(c)]; };
  const Eigen::VectorXd x_E =
      rows.vec(0, Column::device_position) - rows.vec(0, Column::proxy_position);
  EXPECT_EQ(value(Channel::kind), rows.at(0, Column::kind));
  EXPECT_NEAR(value(Channel::error), x_E.norm(), 1e-12 * (1 + x_E.norm()));
  EXPECT_EQ(value(Channel::energy_total), rows.at(0, Column::energy_total));
  EXPECT_EQ(value(Channel::energy_commanded), rows.at(0, Column::energy_commanded));
  const auto expect_norm = [&](Channel c, Column column) {
    const double norm = rows.vec(0, column).norm();
    EXPECT_NEAR(value(c), norm, 1e-12 * (1 + norm));
  };
  expect_norm(Channel::human, Column::hand_torque);
  expect_norm(Channel::human_estimate, Column::hand_torque_estimate);
  expect_norm(Channel::contact, Column::contact_torque);
  for (int j = 0; j < n; ++j) {
    EXPECT_EQ(values[static_cast<std::size_t>(Channel::joints) + static_cast<std::size_t>(j)],
              x_E[j]);
  }
}

// Under a law that uses the observer's estimate the motors' torque depends on the observer's gain.
TEST(TraceChannels, SayWhichLawsUseTheObserversEstimate) {
  const TraceChannels channels{RowLayout(3)};
  const auto human_estimate = static_cast<std::size_t>(Channel::human_estimate);
  std::set<std::string> said, used;
  std::istringstream help(channels.infos()[human_estimate].help);
  for (std::string word; help >> word;) said.insert(word);
  for (std::uint8_t i = 0; i < kLaws; ++i) {
    RunPlan plan = test::plan("table.toml", "touch.csv", 1);
    plan.parameters.kind = CouplingKind{i};
    const test::Rows rows = test::rows_of(plan);
    plan.parameters.alpha *= 0.5;
    const test::Rows slower = test::rows_of(plan);
    bool differs = false;
    double f1 = 0, error = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const Eigen::VectorXd hand = rows.vec(k, Column::hand_torque);
      differs = differs || rows.vec(k, Column::motor_torque) != slower.vec(k, Column::motor_torque);
      f1 += hand.squaredNorm();
      error += (rows.vec(k, Column::hand_torque_estimate) - hand).squaredNorm();
    }
    EXPECT_LT(error, 0.2 * f1) << kLawKeys[i] << ": it is an estimate under every law";
    if (differs) used.insert(kLawKeys[i]);
  }
  EXPECT_FALSE(used.empty());
  for (const char* law : kLawKeys) EXPECT_EQ(said.contains(law), used.contains(law)) << law;
}

// A unit of a slide's travel is 0.1 m, its torque of 1 N m a force of 10 N.
TEST(TraceChannels, AreInMetresAndNewtonsOfJointsThatSlide) {
  const RowLayout layout(2);
  std::vector<double> row(static_cast<std::size_t>(layout.stride()), 0.0);
  const auto set = [&](Column c, double first, double second) {
    layout.in(std::span(row), c)[0] = first;
    layout.in(std::span(row), c)[1] = second;
  };
  set(Column::device_position, 3, 4);
  set(Column::contact_torque, 0.5, -0.25);
  const auto shown = [&](const TraceChannels& channels, const std::string& key) {
    std::vector<double> values(static_cast<std::size_t>(channels.count()));
    channels.values(row, values);
    const auto at = static_cast<std::size_t>(channels.find(key).value());
    return std::pair(values[at], channels.infos()[at].unit);
  };
  using Shown = std::pair<double, std::string>;
  const TraceChannels mixed(layout, {false, true}), slides(layout, {true, true}), turns(layout);
  EXPECT_EQ(shown(mixed, "device/position.1"), Shown(3, "rad"));
  EXPECT_EQ(shown(mixed, "device/position.2"), Shown(0.4, "m"));
  EXPECT_EQ(shown(mixed, "device/velocity.2"), Shown(0, "m/s"));
  EXPECT_EQ(shown(mixed, "proxy/contact_torque.2"), Shown(-2.5, "N"));
  EXPECT_EQ(shown(mixed, "coordination/error.2"), Shown(0.4, "m"));
  EXPECT_EQ(shown(mixed, "coordination/error"), Shown(5, "rad or dm"));
  EXPECT_EQ(shown(slides, "coordination/error"), Shown(0.5, "m"));
  EXPECT_EQ(shown(slides, "proxy/contact_torque_norm").second, "N");
  EXPECT_DOUBLE_EQ(shown(slides, "proxy/contact_torque_norm").first, 10 * std::hypot(0.5, 0.25));
  EXPECT_EQ(shown(turns, "device/position.2"), Shown(4, "rad"));
  EXPECT_EQ(shown(turns, "coordination/error"), Shown(5, "rad"));
}

// A motor is asked for more than its limit, the arm's or the parameters' own.
TEST(TraceChannels, SayWhichMotorGivesAllItCan) {
  const ArmDescription arm = test::omni();
  Parameters p;
  const double effort = arm.joints[1].effort;
  EXPECT_EQ(motor_limits(arm, p)[1].peak, effort);
  p.torque_limit = 0.2;
  TraceChannels channels{RowLayout(3)};
  const RowLayout& layout = channels.layout();
  std::vector<double> row(static_cast<std::size_t>(layout.stride()), 0.0);
  layout.in(std::span(row), Column::commanded_torque)[1] = -0.5;
  layout.in(std::span(row), Column::motor_torque)[1] = -0.2;
  EXPECT_FALSE(channels.limited(row, 1)) << "no limit is known yet";
  channels.set_limits(motor_limits(arm, p));
  EXPECT_TRUE(channels.limited(row, 1));
  EXPECT_FALSE(channels.limited(row, 0));
  layout.in(std::span(row), Column::motor_torque)[1] = -0.1;  // still rising, or fading
  EXPECT_FALSE(channels.limited(row, 1));
  layout.in(std::span(row), Column::motor_torque)[1] = 0;  // force off
  EXPECT_FALSE(channels.limited(row, 1));
}

// Lanes have limits of their own, or else those of the first.
TEST(TraceChannels, SayInWhichLaneAMotorGivesAllItCan) {
  const ArmDescription arm = test::omni();
  TraceChannels channels{RowLayout(3)};
  const RowLayout& layout = channels.layout();
  std::vector<double> row(static_cast<std::size_t>(layout.stride()), 0.0);
  layout.in(std::span(row), Column::commanded_torque)[1] = -0.5;
  layout.in(std::span(row), Column::motor_torque)[1] = -0.2;
  std::vector<double> values(static_cast<std::size_t>(channels.count()));
  const auto limited = [&](std::size_t lane) {
    channels.values(row, values, lane);
    return values[static_cast<std::size_t>(Channel::limited)] > 0;
  };
  Parameters p;
  p.torque_limit = 0.2;
  channels.set_limits(motor_limits(arm, p));
  for (std::size_t lane = 0; lane < kMostLanes; ++lane) EXPECT_TRUE(limited(lane));
  p.torque_limit = 0.4;
  channels.set_limits(motor_limits(arm, p), kTwinLane);
  EXPECT_TRUE(limited(kMainLane));
  EXPECT_FALSE(limited(kTwinLane));
  History history({.channels = 2 * channels.count(), .seconds = 1, .tick = 0.001});
  const std::vector<std::span<const double>> both{row, row};
  channels.append(history, both);
  const int limit = static_cast<int>(Channel::limited);
  EXPECT_EQ(history.value(limit, 0), 1);
  EXPECT_EQ(history.value(channels.count() + limit, 0), 0);
}

// Every column of a recording is a channel, with its value and its unit.
TEST_P(TraceChannelsOfJoints, AreAllThatARecordingHolds) {
  const RowLayout layout(GetParam());
  const TraceChannels channels(layout);
  test::Rows rows(layout);
  rows.add(test::sample_rows(layout, 5, 1));
  std::vector<double> values(static_cast<std::size_t>(channels.count()));
  channels.values(rows.row(0), values);
  for (const ColumnInfo& column : kColumnInfo) {
    if (column.column == Column::time) continue;
    const bool one = column.width == ColumnWidth::one;
    for (int part = 0; part < layout.width(column.column); ++part) {
      const std::string key = column.path + 1 + (one ? "" : "." + std::to_string(part + 1));
      const auto channel = channels.find(key);
      ASSERT_TRUE(channel) << key;
      const auto at = static_cast<std::size_t>(*channel);
      EXPECT_EQ(values[at], layout.in(rows.row(0), column.column)[static_cast<std::size_t>(part)]);
      EXPECT_EQ(channels.infos()[at].unit, column.unit) << key;
    }
  }
}

TEST(TraceChannels, AreOfEachBodyWhereItIsAndHowFastItMoves) {
  const RowLayout layout(3, 2);
  const TraceChannels channels(layout, {}, {"die", "key"});
  std::vector<double> row(static_cast<std::size_t>(layout.stride()), 0.0);
  std::ranges::copy(std::array{0.1, 0.2, 0.3, 1.0, 0.0, 0.0, 0.0, 0.4, 0.5, 0.6},
                    layout.in(std::span(row), Column::body_pose).begin());
  std::ranges::copy(std::array{3.0, 0.0, 4.0, 0.0, 5.0, 12.0},
                    layout.in(std::span(row), Column::body_velocity).begin());
  layout.in(std::span(row), Column::energy_objects)[0] = 0.25;
  std::vector<double> values(static_cast<std::size_t>(channels.count()));
  channels.values(row, values);
  const auto value = [&](const char* key) {
    return values[static_cast<std::size_t>(channels.find(key).value())];
  };
  EXPECT_EQ(value("objects/die.x"), 0.1);
  EXPECT_EQ(value("objects/die.z"), 0.3);
  EXPECT_EQ(value("objects/die.speed"), 5);
  EXPECT_EQ(value("objects/die.turning"), 13);
  EXPECT_EQ(value("objects/key.y"), 0.5);
  EXPECT_EQ(value("objects/key.speed"), 0);
  EXPECT_EQ(value("energy/objects"), 0.25);
  const ChannelInfo& speed =
      channels.infos()[static_cast<std::size_t>(channels.find("objects/die.speed").value())];
  EXPECT_EQ(speed.label, "die speed");
  EXPECT_EQ(speed.unit, "m/s");
}

// Compared with the arm's own kinematics, speeds by finite differences.
TEST(TraceChannels, KnowTheTipsOfTheArm) {
  const RowLayout layout(3);
  const TraceChannels channels(test::omni(), layout, {});
  std::vector<double> row = test::sample_rows(layout, 705, 1),
                      values(static_cast<std::size_t>(channels.count()));
  const auto value_of = [&](const TraceChannels& of, const std::string& key) {
    of.values(row, values);
    return values[static_cast<std::size_t>(of.find(key).value())];
  };
  const auto value = [&](const std::string& key) { return value_of(channels, key); };
  EXPECT_TRUE(std::isnan(value_of(TraceChannels(layout), "device/tip.1")))
      << "which arm is not known";
  const Arm<3> arm(test::omni());
  const auto tip = [&](Column x, Column v, double dt) {
    Eigen::Vector3d q;
    for (int j = 0; j < 3; ++j) {
      const auto i = static_cast<std::size_t>(j);
      q[j] = layout.in(std::span(row), x)[i] + dt * layout.in(std::span(row), v)[i];
    }
    return Vec3(arm.tip_at(q));
  };
  const auto speed = [&](Column x, Column v) {
    return (tip(x, v, 1e-6) - tip(x, v, -1e-6)).norm() / 2e-6;
  };
  const Vec3 device = tip(Column::device_position, Column::device_velocity, 0);
  const Vec3 proxy = tip(Column::proxy_position, Column::proxy_velocity, 0);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(value("device/tip." + std::to_string(i + 1)), device[i], 1e-12);
    EXPECT_NEAR(value("proxy/tip." + std::to_string(i + 1)), proxy[i], 1e-12);
  }
  EXPECT_NEAR(value("device/tip_speed"), speed(Column::device_position, Column::device_velocity),
              1e-7);
  EXPECT_NEAR(value("proxy/tip_speed"), speed(Column::proxy_position, Column::proxy_velocity),
              1e-7);
  EXPECT_NEAR(value("coordination/gap"), (device - proxy).norm(), 1e-12);
  Vec3 force = Vec3::Zero();
  const auto forces = layout.in(std::span(row), Column::contact_force);
  for (std::size_t i = 0; i < forces.size(); ++i) force[static_cast<int>(i % 3)] += forces[i];
  EXPECT_GT(force.norm(), 0);
  EXPECT_NEAR(value("contact/total_force_norm"), force.norm(), 1e-12);
}

TEST(TraceChannels, HaveNoneOfBodiesWhereNothingMoves) {
  const TraceChannels channels{RowLayout(3, 0)};
  for (const ChannelInfo& info : channels.infos()) EXPECT_NE(info.group, "Objects");
  EXPECT_FALSE(channels.find("energy/objects"));
}

// A row's channels fit even with the largest number of bodies on the largest arm.
TEST(TraceChannels, FitIntoAHistoryHoweverManyMove) {
  const RowLayout layout(kMaxDof, kMostBodies);
  const TraceChannels channels(layout, {}, std::vector<std::string>(kMostBodies, "die"));
  std::set<std::string> keys;
  for (const ChannelInfo& info : channels.infos()) {
    EXPECT_TRUE(keys.insert(info.key).second) << info.key;
  }
  History history({.channels = static_cast<int>(kMostLanes) * channels.count(), .seconds = 0.01});
  const std::vector<double> row(static_cast<std::size_t>(layout.stride()), 0.5);
  std::array<std::span<const double>, kMostLanes> lanes;
  lanes.fill(row);
  channels.append(history, lanes);
  int last = 0;  // number of the bodies' last channel
  for (int i = 0; i < channels.count(); ++i) {
    if (channels.infos()[static_cast<std::size_t>(i)].key.ends_with("turning")) last = i;
  }
  EXPECT_EQ(history.value(channels.count() + last, history.first()),
            static_cast<float>(std::sqrt(0.75)));
}

TEST_P(TraceChannelsOfJoints, HaveNamesOfTheirOwn) {
  const TraceChannels channels{RowLayout(GetParam())};
  std::set<std::string> keys, names, labels;
  for (const ChannelInfo& info : channels.infos()) {
    EXPECT_TRUE(keys.insert(info.key).second) << info.key;
    EXPECT_TRUE(names.insert(info.group + ": " + info.name).second) << info.name;
    EXPECT_TRUE(labels.insert(info.label).second) << info.label;
    EXPECT_FALSE(info.help.empty()) << info.key;
  }
}

}  // namespace
}  // namespace limpid
