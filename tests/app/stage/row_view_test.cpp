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

}  // namespace
}  // namespace limpid
