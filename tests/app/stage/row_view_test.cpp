// The 3D view of a row, live or recorded.
#include "app/stage/row_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "app/run/recorder.h"
#include "app/run/replay.h"
#include "tests/devices/files/test_files.h"
#include "tests/support/test_session.h"

namespace limpid {
namespace {

std::vector<ContactMark> marks(const RowView& rows, ViewMemory& memory, const RowLayout& layout,
                               std::span<const double> row) {
  ViewState view = rows.view(layout, row);
  memory.update(view, rows.contacts(layout, row), layout.in(row, Column::time)[0]);
  return view.contacts;
}

// A plan in which the middle of the last link meets a ball, over the table.
RunPlan link_against_a_ball() {
  RunPlan plan = test::plan("table.toml", "touch.csv", 3);
  const Arm<kAnyDof> arm(plan.arm);
  Arm<kAnyDof>::Frames f;
  arm.frames(rest_pose(plan.arm), f);
  const Vec3 middle = 0.5 * (f.p[2] + arm.tip(f));
  plan.document.scene.probes.push_back(
      {"link", 2, Vec3::Zero(), plan.arm.tip.translation(), 0.005});
  plan.document.scene.add({"", pose_at(middle - Vec3(0, 0, 0.026)), Sphere{0.02}, 500});
  return plan;
}

TEST(RowView, ShowsTheRecordedContactsOfALinkAsTheyWereLive) {
  const test::TempDir dir;
  const RunPlan plan = link_against_a_ball();
  const RowView rows(plan.arm);
  const RowLayout layout(plan.arm.dof());
  ViewMemory live, played;
  std::vector<std::vector<ContactMark>> seen;
  Recorder recorder(dir / "a.h5", session_info(plan), plan.parameters, false);
  simulate(plan, {}, [&](std::span<const double> row, LaneChanges) {
    seen.push_back(marks(rows, live, layout, row));
    return recorder.push_waiting(row);
  });
  recorder.finish();
  const Session session = read_session(dir / "a.h5");
  ASSERT_EQ(session.size(), seen.size());
  int on_link = 0;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    const auto again = marks(rows, played, session.layout, session.row(k));
    ASSERT_EQ(again.size(), seen[k].size()) << k;
    const Vec3 tip = rows.tip(session.at(k, Column::proxy_position));
    for (std::size_t i = 0; i < again.size(); ++i) {
      ASSERT_EQ(again[i].position, seen[k][i].position) << k;
      ASSERT_EQ(again[i].force, seen[k][i].force) << k;
      ASSERT_EQ(again[i].age, seen[k][i].age) << k;
      if ((again[i].position - tip).norm() > 0.03) ++on_link;
    }
  }
  EXPECT_GT(on_link, 100);
}

// With one contact, at the tip, the torque determines point and force.
TEST(RowView, ShowsOneForceAtTheTipWhereOnlyTheTorqueWasRecorded) {
  const RunPlan plan = test::plan("table.toml", "touch.csv", 3);
  const RowView view(plan.arm);
  const test::Rows rows = test::rows_of(plan);
  int touched = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto known = view.contacts(rows.layout(), rows.row(k));
    if (known.empty()) continue;
    ASSERT_EQ(known.size(), 1u);
    ++touched;
    std::vector<double> row(rows.row(k).begin(), rows.row(k).end());
    for (const Column c : {Column::contact_point, Column::contact_force}) {
      std::ranges::fill(rows.layout().in(std::span(row), c),
                        std::numeric_limits<double>::quiet_NaN());
    }
    const auto guessed = view.contacts(rows.layout(), row);
    ASSERT_EQ(guessed.size(), 1u);
    ASSERT_LT((guessed[0].point - known[0].point).norm(), 1e-9) << k;
    ASSERT_LT((guessed[0].force - known[0].force).norm(), 1e-4 * known[0].force.norm()) << k;
  }
  EXPECT_GT(touched, 100);
}

TEST(RowView, ShowsWhereTheHandWantsTheTip) {
  const RunPlan plan = test::plan("table.toml", "touch.csv", 1);
  const RowLayout layout(plan.arm.dof());
  std::vector<double> row(static_cast<std::size_t>(layout.stride()), 0.0);
  const Vec3 target(0.1, 0.2, 0.3);
  std::ranges::copy(target, layout.in(std::span(row), Column::hand_target).begin());
  const ViewState view = RowView(plan.arm).view(layout, row);
  EXPECT_EQ(view.hand_target, target);
  EXPECT_FALSE(view.hand_grips);
}

// A quarter turn to the left: the tool's x is the frame's y.
TEST(RowView, TurnsTheToolAsTheRowSays) {
  const RunPlan plan = test::plan("table.toml", "touch.csv", 1);
  const RowLayout layout = plan.layout();
  std::vector<double> row(static_cast<std::size_t>(layout.stride()), 0.0);
  const auto orientation = layout.in(std::span(row), Column::tool_orientation);
  std::ranges::copy(std::array{std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)}, orientation.begin());
  const RowView rows(plan.arm);
  const ViewState view = rows.view(layout, row);
  ASSERT_TRUE(view.tool);
  EXPECT_NEAR((view.tool->col(0) - Vec3::UnitY()).norm(), 0, 1e-12);
  EXPECT_NEAR((view.tool->col(2) - Vec3::UnitZ()).norm(), 0, 1e-12);
  std::ranges::fill(orientation, std::nan(""));
  EXPECT_FALSE(rows.view(layout, row).tool);
}

// A row has the centre of mass, the picture the object's own frame.
TEST(RowView, PlacesWhatMovesByItsCentreOfMass) {
  RunPlan plan = test::plan("table.toml", "touch.csv", 1);
  Object lever{.name = "lever", .pose = pose_at(Vec3(0.2, 0, 0)), .shape = Box{}, .body = Body{}};
  lever.body->center = Vec3(0.02, 0, 0);
  plan.document.scene.add(lever);
  const RowLayout layout = plan.layout();
  ASSERT_EQ(layout.bodies(), 1);
  std::vector<double> row(static_cast<std::size_t>(layout.stride()), 0.0);
  // A quarter turn to the left, as a quaternion of another length than 1.
  std::ranges::copy(std::array{0.1, 0.2, 0.3, 2.0, 0.0, 0.0, 2.0},
                    layout.in(std::span(row), Column::body_pose).begin());
  const ViewState view = RowView(plan.arm, plan.document.scene).view(layout, row);
  ASSERT_EQ(view.bodies.size(), 1u);
  const Pose& frame = view.bodies[0];
  EXPECT_NEAR((frame * *lever.body->center - Vec3(0.1, 0.2, 0.3)).norm(), 0, 1e-12);
  EXPECT_NEAR((frame.linear() * Vec3::UnitX() - Vec3::UnitY()).norm(), 0, 1e-12);
  EXPECT_NEAR((frame.translation() - Vec3(0.1, 0.18, 0.3)).norm(), 0, 1e-12);
  // A row without bodies, or a scene with fewer, places nothing.
  const RowLayout none(plan.arm.dof(), 0);
  EXPECT_TRUE(RowView(plan.arm, plan.document.scene).bodies(none, row).empty());
  EXPECT_TRUE(RowView(plan.arm).bodies(layout, row).empty());
}

TEST(RowView, GivesAMeshThatMovesItsPlaceInItsBody) {
  Scene scene;
  const auto shape = [](bool moves) {
    Object object{.name = "bunny", .pose = pose_at(Vec3(0.2, 0, 0)), .shape = Mesh{}};
    if (moves) object.body.emplace();
    return object;
  };
  scene.objects = {shape(false), shape(true), shape(true)};
  const auto model = std::make_shared<const Model>();
  const auto pictures = mesh_pictures(scene, {model, model, model});
  ASSERT_EQ(pictures.size(), 3u);
  EXPECT_EQ(pictures[0].body, -1);
  EXPECT_EQ(pictures[0].pose.translation(), Vec3(0.2, 0, 0));
  EXPECT_EQ(pictures[1].body, 0);
  EXPECT_EQ(pictures[2].body, 1);
  EXPECT_EQ(pictures[2].pose.translation(), Vec3::Zero());
}

// A body that the hand's magnet holds and that is pulled by a point of its own.
TEST(RowView, ShowsTheMagnetAndThePullOfABody) {
  RunPlan plan = test::plan("table.toml", "touch.csv", 1);
  for (const char* name : {"one", "two"}) {
    plan.document.scene.add({.name = name, .shape = Box{}, .body = Body{}});
  }
  const RowLayout layout = plan.layout();
  ASSERT_EQ(layout.bodies(), 2);
  std::vector<double> row(static_cast<std::size_t>(layout.stride()), 0.0);
  const auto put = [&](Column c, const std::vector<double>& values) {
    std::ranges::copy(values, layout.in(std::span(row), c).begin());
  };
  // The second one is a quarter turn to the left.
  const double s = std::sqrt(0.5);
  put(Column::body_pose, {0, 0, 0, 1, 0, 0, 0, 0.1, 0.2, 0.3, s, 0, 0, s});
  const RowView rows(plan.arm, plan.document.scene);
  ViewState view = rows.view(layout, row);
  EXPECT_FALSE(view.magnet || view.magnet_holds || view.pull || view.hand_grips);
  put(Column::hand_magnet, {1});
  put(Column::hand_grip, {1});
  put(Column::hand_pull, {2});
  put(Column::pull_point, {0.01, 0.02, 0.03});
  put(Column::pull_target, {0.4, 0.5, 0.6});
  view = rows.view(layout, row);
  EXPECT_TRUE(view.magnet && view.hand_grips && view.show_hand);
  EXPECT_FALSE(view.magnet_holds);
  EXPECT_EQ(view.pulled, 1u);
  ASSERT_TRUE(view.pull);
  const auto& [point, target] = *view.pull;
  EXPECT_NEAR((point - Vec3(0.1 - 0.02, 0.2 + 0.01, 0.33)).norm(), 0, 1e-12);
  EXPECT_EQ(target, Vec3(0.4, 0.5, 0.6));
  put(Column::magnet, {1});
  put(Column::hand_pull, {3});
  view = rows.view(layout, row);
  EXPECT_TRUE(view.magnet_holds);
  EXPECT_FALSE(view.pull) << "there is no third one";
}

// Virtual work: a force at the tip and its torque on the joints, found by moving each a little.
TEST(RowView, ShowsTheHandsForceAtTheDevicesTip) {
  const RunPlan plan = test::plan("table.toml", "touch.csv", 1);
  const RowLayout layout = plan.layout();
  const RowView rows(plan.arm);
  std::vector<double> row(static_cast<std::size_t>(layout.stride()), 0.0);
  const Eigen::VectorXd rest = rest_pose(plan.arm);
  std::ranges::copy(rest, layout.in(std::span(row), Column::device_position).begin());
  const Vec3 force(0.4, -0.3, 1.2);
  for (Eigen::Index j = 0; j < rest.size(); ++j) {
    Eigen::VectorXd more = rest, less = rest;
    more[j] += 1e-6;
    less[j] -= 1e-6;
    const Vec3 way = rows.tip({more.data(), 3}) - rows.tip({less.data(), 3});
    layout.in(std::span(row), Column::hand_torque)[static_cast<std::size_t>(j)] =
        force.dot(way) / 2e-6;
  }
  const ViewState view = rows.view(layout, row);
  EXPECT_NEAR((view.hand_force - force).norm(), 0, 1e-4);
  EXPECT_NEAR((view.device.tip - rows.tip({rest.data(), 3})).norm(), 0, 1e-12);
  ASSERT_EQ(view.device.links.size(), 3u);
  EXPECT_NEAR((view.device.links[2] * plan.arm.tip.translation() - view.device.tip).norm(), 0, 1e-9)
      << "the tip is fixed to the last link";
}

TEST(RowView, LaysARunOverAnother) {
  ViewState view, other;
  other.device.tip = Vec3(1, 0, 0);
  other.proxy.tip = Vec3(0, 1, 0);
  other.hand_force = Vec3(0, 0, 2);
  other.contacts.resize(3);
  other.bodies.resize(2);
  lay_over(view, other);
  ASSERT_EQ(view.beside.size(), 1u);
  EXPECT_EQ(view.beside[0].device.tip, other.device.tip);
  EXPECT_EQ(view.beside[0].proxy.tip, other.proxy.tip);
  EXPECT_EQ(view.beside[0].hand_force, other.hand_force);
  EXPECT_EQ(view.beside[0].contacts.size(), 3u);
  EXPECT_EQ(view.beside[0].bodies.size(), 2u);
}

// A view whose tips are at `x`, at a time.
ViewState seen_at(ViewMemory& memory, double time, double x,
                  const std::vector<ContactForce>& contacts = {}) {
  ViewState view;
  view.device.tip = Vec3(x, 0, 0);
  view.proxy.tip = Vec3(0, x, 0);
  memory.update(view, contacts, time);
  return view;
}

TEST(MemoryOfAView, HasWhereTheTipsWereInTheLastSecond) {
  ViewMemory memory;
  ViewState view;
  for (int k = 0; k <= 30; ++k) view = seen_at(memory, 0.125 * k, k);
  ASSERT_EQ(view.device.trail.size(), 9u);
  ASSERT_EQ(view.proxy.trail.size(), 9u);
  for (int i = 0; i < 9; ++i) {
    EXPECT_EQ(view.device.trail[static_cast<std::size_t>(i)], Vec3(22 + i, 0, 0)) << "oldest first";
    EXPECT_EQ(view.proxy.trail[static_cast<std::size_t>(i)], Vec3(0, 22 + i, 0));
  }
  view = seen_at(memory, 3.75, 77);
  ASSERT_EQ(view.device.trail.size(), 9u) << "time stood still";
  EXPECT_EQ(view.device.trail.back().x(), 77);
  EXPECT_EQ(seen_at(memory, 3.5, 1).device.trail.size(), 1u) << "time went back";
  EXPECT_EQ(seen_at(memory, 4.5, 1).device.trail.size(), 2u);
  EXPECT_EQ(seen_at(memory, 5.6, 1).device.trail.size(), 1u) << "it jumped";
  memory.clear();
  EXPECT_EQ(seen_at(memory, 5.7, 1).device.trail.size(), 1u);
}

TEST(MemoryOfAView, KnowsSinceWhenAContactHasBeenThere) {
  ViewMemory memory;
  const ContactForce here{Vec3::Zero(), Vec3(0, 0, 2)};
  const auto age = [&](double time, const ContactForce& contact) {
    const ViewState view = seen_at(memory, time, 0, {contact});
    EXPECT_EQ(view.contacts.size(), 1u);
    EXPECT_EQ(view.contacts.at(0).position, contact.point);
    EXPECT_EQ(view.contacts.at(0).force, contact.force);
    return view.contacts.at(0).age;
  };
  EXPECT_NEAR(age(1, here), 0, 1e-12);
  EXPECT_NEAR(age(1.02, here), 0.02, 1e-12);
  EXPECT_NEAR(age(1.04, {Vec3(0.014, 0, 0), Vec3(0, 0, 1)}), 0.04, 1e-12) << "it slid";
  EXPECT_NEAR(age(1.06, {Vec3(0.028, 0, 0), Vec3(0, 0, 1)}), 0.06, 1e-12);
  EXPECT_NEAR(age(1.07, {Vec3(0.044, 0, 0), Vec3(0, 0, 1)}), 0, 1e-12) << "16 mm are too far";
  EXPECT_TRUE(seen_at(memory, 1.1, 0, {{here.point, Vec3::Zero()}}).contacts.empty());
  EXPECT_NEAR(age(1.11, {Vec3(0.044, 0, 0), Vec3(0, 0, 1)}), 0.04, 1e-12) << "a short pause";
  seen_at(memory, 1.17, 0);
  EXPECT_NEAR(age(1.18, {Vec3(0.044, 0, 0), Vec3(0, 0, 1)}), 0, 1e-12) << "it had ended";
  memory.clear();
  EXPECT_NEAR(age(1.19, {Vec3(0.044, 0, 0), Vec3(0, 0, 1)}), 0, 1e-12);
}

}  // namespace
}  // namespace limpid
