// Panels of numbers: of one tick, and of several runs side by side.
#include "app/desktop/coupling/tick_panel.h"

#include <cmath>

#include "app/desktop/coupling/lanes_panel.h"
#include "app/style/ticks.h"
#include "core/dynamics/arm.h"
#include "tests/app/desktop/widgets/read_panel.h"
#include "tests/support/built_in.h"
#include "tests/support/computer.h"
#include "tests/support/drawn_ink.h"
#include "tests/support/faultless_context.h"

namespace limpid {
namespace {

using testing::HasSubstr;
using testing::Not;

// Rows of the built-in arm, beside a scene with a ball that moves or an empty one.
class NumbersOfATick : public ReadPanel {
 protected:
  void SetUp() override {
    if (!test::has_offscreen_pictures()) GTEST_SKIP() << "no EGL here";
    context_.emplace(64, 64);
    use(false);
  }
  void use(bool ball, RunNames names = {}) {
    stage_.reset();
    SceneDocument document;
    if (ball)
      document.scene.add({.name = "ball", .shape = Sphere{0.02}, .body = Body{.mass = 0.1}});
    const RowLayout layout(3, ball ? 1 : 0);
    History history({.channels = TraceChannels(layout).count(), .seconds = 1, .tick = 0.01});
    stage_ = std::make_unique<Stage>(test::omni(), document, MeshModels{}, std::move(history), 1);
    names_ = std::move(names);
    row_.assign(static_cast<std::size_t>(stage_->channels().layout().stride()), 0.0);
    const Eigen::VectorXd rest = rest_pose(test::omni());
    for (const Column c : {Column::device_position, Column::proxy_position}) {
      std::ranges::copy(rest, in(c).begin());
    }
  }
  std::span<double> in(Column c) { return stage_->channels().layout().in(std::span(row_), c); }
  void draw() {
    show([this] { draw_tick(*stage_, row_); });
  }

  std::optional<test::FaultlessContext> context_;
  std::unique_ptr<Stage> stage_;
  RunNames names_;
  std::vector<double> row_;
};

TEST_F(NumbersOfATick, AreThoseOfItsRow) {
  in(Column::time)[0] = 1.2345;
  in(Column::kind)[0] = static_cast<double>(CouplingKind::predictive);
  in(Column::solved)[0] = 2;
  in(Column::energy_ledger)[0] = 1.5e-3;
  in(Column::governor)[0] = 0.875;
  in(Column::contact_potential)[0] = 2.5e-4;
  in(Column::energy_total)[0] = -3e-3;
  draw();
  EXPECT_EQ(value("t"), "1.2345 s");
  EXPECT_TRUE(find("The proxy touches nothing."));
  EXPECT_EQ(value("gap of the tips"), "0.0000 mm");
  EXPECT_EQ(value("force of the motors"), "0.000 N");
  EXPECT_EQ(value("solved"), "all at once");
  EXPECT_EQ(value("reserve"), "1.5000 mJ");
  EXPECT_EQ(value("wall force let through"), "87.5 %");
  EXPECT_EQ(value("stored in contacts"), "0.2500 mJ");
  EXPECT_EQ(value("controller, E_c"), "-3.0000 mJ");
  EXPECT_FALSE(find("sweeps")) << "nothing moves";
  for (const auto& [label, words] :
       {std::pair("t", "Time at which the tick begins"),
        {"gap of the tips", "Distance between the tips of device and proxy"},
        {"force of the motors", "on the device's tip"},
        {"solved", "the motors' limits"},
        {"reserve", "the law may still give"}}) {
    EXPECT_THAT(hint(label), HasSubstr(words)) << label;
  }
  for (const auto& [number, words] : {std::pair(0.0, "one after the other"),
                                      {1.0, "with motors at their limit"},
                                      {3.0, "no solution: the proxy stood still"}}) {
    in(Column::solved)[0] = number;
    draw();
    EXPECT_EQ(value("solved"), words);
  }
  in(Column::kind)[0] = static_cast<double>(CouplingKind::standard);
  draw();
  for (const char* label : {"solved", "reserve", "wall force let through"}) {
    EXPECT_FALSE(find(label)) << label << " is of laws that solve all together";
  }
}

TEST_F(NumbersOfATick, SayWhereAndHowTheProxyIsPushed) {
  const Vec3 point(0.01, 0.02, 0.04), force(1, -2, 2);
  std::ranges::copy(point, in(Column::contact_point).begin());
  std::ranges::copy(force, in(Column::contact_force).begin());
  draw();
  EXPECT_FALSE(find("The proxy touches nothing."));
  for (const char* millimetres : {"10.000", "20.000", "40.000"}) {
    EXPECT_TRUE(find(millimetres)) << millimetres << " is not in:\n" << words();
  }
  EXPECT_THAT(hint("3.000"), HasSubstr("on the proxy: 1.0000, -2.0000, 2.0000 N"));
}

// The tips' distance and the motors' force, by the arm's own kinematics.
TEST_F(NumbersOfATick, ReckonAtTheTips) {
  const Arm<kAnyDof> arm(test::omni());
  const auto tip = [&](std::span<const double> x) {
    Arm<kAnyDof>::Frames frames;
    arm.frames(Eigen::Map<const Eigen::VectorXd>(x.data(), 3), frames);
    return arm.tip(frames);
  };
  in(Column::proxy_position)[1] += 0.02;
  // The torque that a force at the tip gives.
  const Vec3 force(1, -2, 2);
  Arm<kAnyDof>::Frames frames;
  arm.frames(Eigen::Map<const Eigen::VectorXd>(in(Column::device_position).data(), 3), frames);
  Jacobian<kAnyDof> J;
  arm.point_jacobian(frames, 2, arm.tip(frames), J);
  const Eigen::VectorXd torque = J.transpose() * force;
  std::ranges::copy(torque, in(Column::motor_torque).begin());
  draw();
  const double gap = (tip(in(Column::device_position)) - tip(in(Column::proxy_position))).norm();
  EXPECT_EQ(value("gap of the tips"), fmt::format("{:.4f} mm", 1e3 * gap));
  EXPECT_EQ(value("force of the motors"), "3.000 N");
}

TEST_F(NumbersOfATick, CountWhatMoves) {
  use(true);
  in(Column::objects_sweeps)[0] = 12;
  in(Column::objects_awake)[0] = 1;
  in(Column::objects_gain)[0] = -2e-3;
  draw();
  EXPECT_EQ(value("sweeps"), "12");
  EXPECT_EQ(value("awake"), "1 of 1");
  EXPECT_EQ(value("objects gained"), "-2.0000 mJ");
  EXPECT_THAT(hint("sweeps"), HasSubstr("through all contacts"));
  EXPECT_THAT(hint("objects gained"), HasSubstr("minus their energy at the start"));
}

// The panel of several runs, with its buttons.
class NumbersOfRuns : public NumbersOfATick {
 protected:
  void draw_runs(std::size_t count, bool choosable = true, float scale = 1) {
    rows_.assign(count, row_);
    for (std::size_t run = 0; run < count; ++run) {
      const RowLayout& layout = stage_->channels().layout();
      layout.in(std::span(rows_[run]), Column::energy_total)[0] =
          scale * 1e-3f * (run == 0 ? 2.0f : 3.0f);
    }
    show([this, choosable] {
      std::vector<std::span<const double>> rows(rows_.begin(), rows_.end());
      draw_lanes(*stage_, rows, choosable ? &edited_ : nullptr, overlaid_,
                 [this](std::string_view id) { asked_ = id; });
    });
  }
  std::vector<std::string> line(const char* label) {
    std::vector<std::string> all;
    const auto at = find(label);
    EXPECT_TRUE(at) << label << " is not in\n" << words();
    if (!at) return all;
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.min.x > at->max.x && std::abs(each.middle().y - at->middle().y) < 4) {
        all.push_back(each.text);
      }
    }
    return all;
  }
  std::vector<std::vector<double>> rows_;
  std::size_t edited_ = 0;
  bool overlaid_ = false;
  std::string asked_;
};

TEST_F(NumbersOfRuns, StandSideBySideWithTheirRatio) {
  draw_runs(2);
  EXPECT_THAT(line("E_c mJ"), testing::ElementsAre("2.00", "3.00", testing::HasSubstr("1.50")));
  EXPECT_THAT(line("|f1| N m"), testing::ElementsAre("0.00", "0.00")) << "nothing over nothing";
  draw_runs(2, true, -1);
  EXPECT_EQ(line("E_c mJ").size(), 3u) << "a loss over a loss";
  draw_runs(2, true, 1e3f);
  EXPECT_THAT(line("E_c mJ"), testing::ElementsAre("2000.0", "3000.0", testing::HasSubstr("1.50")));
  draw_runs(3);
  EXPECT_THAT(line("E_c mJ"), testing::ElementsAre("2.00", "3.00", "3.00")) << "no room for ratios";
}

TEST_F(NumbersOfRuns, ComeAndGoByTheirButtons) {
  draw_runs(2);
  click("+ run");
  EXPECT_EQ(asked_, "session.add_run");
  EXPECT_THAT(hint("+ run"), HasSubstr("Adds another coupling"));
  click("? run");  // a minus sign that ImGui's own font lacks
  EXPECT_EQ(asked_, "session.drop_run");
  click("all in one picture");
  EXPECT_TRUE(overlaid_);
  EXPECT_THAT(hint("all in one picture"), HasSubstr("in other shades"));
  draw_runs(kMostLanes);
  EXPECT_FALSE(find("+ run")) << "there are as many as there may be";
  EXPECT_TRUE(find("? run"));
  draw_runs(2, false);
  EXPECT_FALSE(find("+ run")) << "of a recording";
  EXPECT_FALSE(find("? run"));
}

TEST_F(NumbersOfRuns, ChooseTheRunThatSlidersChange) {
  stage_.reset();
  const int channels = TraceChannels(test::omni(), RowLayout(3), {}).count();
  History history({.channels = 3 * channels, .seconds = 1, .tick = 0.01});
  stage_ =
      std::make_unique<Stage>(test::omni(), SceneDocument{}, MeshModels{}, std::move(history), 1);
  stage_->name_runs(
      {{"standard", "tank", "third"},
       true,
       {static_cast<int>(CouplingKind::standard), static_cast<int>(CouplingKind::tank), -1}});
  draw_runs(3);
  const auto first = find("standard"), second = find("tank"), third = find("third");
  ASSERT_TRUE(first && second && third) << words();
  EXPECT_NEAR(first->middle().y, second->middle().y, 1) << "in one line";
  EXPECT_NEAR(second->middle().y, third->middle().y, 1);
  EXPECT_LT(first->max.x, second->min.x);
  EXPECT_NEAR(second->middle().x - first->middle().x, third->middle().x - second->middle().x, 3);
  const auto inked = [](const test::DrawnText& name, float down, Rgb rgb) {
    return test::inked({name.middle().x, name.max.y + down},
                       [=](ImU32 rgba) { return rgba == colour(rgb); });
  };
  const auto edged = [&](const test::DrawnText& name, CouplingKind kind) {
    for (float down = 0; down < 12; down += 0.5f) {
      if (inked(name, down, law_ink(current_palette(), static_cast<int>(kind)))) return true;
    }
    return false;
  };
  EXPECT_TRUE(edged(*first, CouplingKind::standard));
  EXPECT_TRUE(edged(*second, CouplingKind::tank));
  EXPECT_FALSE(edged(*third, CouplingKind::standard)) << "its law is not known";
  EXPECT_TRUE(inked(*first, 0.5f, current_palette().frame_active)) << "it is chosen";
  EXPECT_FALSE(inked(*second, 0.5f, current_palette().frame_active));
  EXPECT_EQ(hint("tank"), "Click here. Then the sliders below change the run tank.");
  click("third");
  EXPECT_EQ(edited_, 2u);
  EXPECT_TRUE(inked(*find("third"), 0.5f, current_palette().frame_active));
  EXPECT_FALSE(inked(*find("standard"), 0.5f, current_palette().frame_active));
  click("tank");
  EXPECT_EQ(edited_, 1u);
  draw_runs(3, false);
  EXPECT_FALSE(find("tank")) << "nothing is set of a recording";
}

// Labels stand below each other at the left, and numbers end where their columns end.
TEST_F(NumbersOfRuns, StandInColumns) {
  draw_runs(2, true, 1e3f);
  float below = 0, left = 0, ends[2] = {0, 0};
  for (const char* what : {"|x_E| mrad", "|f1| N m", "|f2| N m", "E_c mJ"}) {
    const auto at = find(what);
    ASSERT_TRUE(at) << what;
    EXPECT_GT(at->min.y, below) << what;
    below = at->max.y;
    EXPECT_EQ(at->colour, colour(current_palette().muted)) << what;
    if (left == 0) left = at->min.x;
    EXPECT_NEAR(at->min.x, left, 2) << what;
    std::size_t column = 0;
    for (const test::DrawnText& each : test::drawn_texts()) {
      const bool in_line = std::abs(each.middle().y - at->middle().y) < 4;
      if (!in_line || each.min.x <= at->max.x || column == 2) continue;
      if (ends[column] == 0) ends[column] = each.max.x;
      EXPECT_NEAR(each.max.x, ends[column++], 2) << what << ": " << each.text;
      EXPECT_EQ(each.colour, colour(current_palette().text)) << what;
    }
    EXPECT_EQ(column, 2u) << what;
  }
}

}  // namespace
}  // namespace limpid
