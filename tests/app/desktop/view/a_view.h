// A 3D view, drawn frame by frame: an arm at rest, and a mouse. Skipped where EGL gives no context.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/desktop/view/view_panel.h"
#include "core/dynamics/arm.h"
#include "tests/app/plot/imgui_frames.h"
#include "tests/support/built_in.h"
#include "tests/support/computer.h"
#include "tests/support/drawn_text.h"
#include "tests/support/faultless_context.h"

namespace limpid {

class AView : public ImGuiFrames {
 protected:
  void SetUp() override {
    if (!test::has_offscreen_pictures()) GTEST_SKIP() << "no EGL here";
    context_.emplace(400, 300);
    open({});
    const Eigen::VectorXd rest = rest_pose(test::omni());
    for (const Column c : {Column::device_position, Column::proxy_position}) {
      std::ranges::copy(rest, layout_.in(std::span(row_), c).begin());
    }
    camera_.reset(stage_->picture.bounds());
    camera_.finish();
  }
  void open(const SceneDocument& document) {
    History history({.channels = TraceChannels(layout_).count(), .seconds = 1, .tick = 0.01});
    stage_ = std::make_unique<Stage>(test::omni(), document, MeshModels{}, std::move(history), 1);
  }
  // Returns whether the picture says this in a line of its own.
  static bool says(const std::string& line) {
    return std::ranges::any_of(test::drawn_texts(), [&](const test::DrawnText& each) {
      return each.text.starts_with(line);
    });
  }
  ViewScene scene() {
    ViewScene all{.stage = *stage_, .row = row_, .selected = selected_, .pixel_height = 600};
    all.grasp = [this](const Ray&) { return under_; };
    all.aim = [this](const Ray& ray) { return aim_along(ray, objects_, {}); };
    all.drop = [this](const Vec3&) { return below_; };
    all.recorded = recorded_;
    all.told = told_;
    all.asked = asked_below_;
    all.blind = blind_;
    all.overlaid = overlaid_;
    if (twin_) {
      all.beside.emplace_back(row_);
      all.names = {{"left run", "right run"}, true};
    }
    return all;
  }
  void draw() {
    frame([&] { asked_ = panel_.draw(scene(), camera_, controls_, settings_, rect_, taken_); });
  }
  // Draws a frame with the mouse at `at` in the window.
  void point(const Eigen::Vector2d& at) {
    show_mouse({static_cast<float>(at.x()), static_cast<float>(at.y())});
    draw();
  }
  void press(int button, bool down) {
    show_mouse_button(button, down);
    draw();
  }
  // Presses Ctrl and the left button at `at`.
  void point_at_body(const Eigen::Vector2d& at) {
    show_modifiers(true, false, false);
    point(at);
    press(0, true);
  }
  Eigen::Vector2d seen(const Vec3& point) const {
    const auto pixel = *camera_.project(point);
    return {pixel.x() + static_cast<double>(rect_.min.x),
            pixel.y() + static_cast<double>(rect_.min.y)};
  }
  Vec3 tip() const {
    return stage_->rows().tip(layout_.in(std::span<const double>(row_), Column::device_position));
  }
  bool differs(const Settings& settings) { return panel_.differs(scene(), camera_, settings); }

  const RowLayout layout_{3};
  std::vector<double> row_ = std::vector<double>(static_cast<std::size_t>(layout_.stride()), 0.0);
  std::optional<test::FaultlessContext> context_;
  std::unique_ptr<Stage> stage_;
  ViewPanel panel_;
  Camera camera_;
  Controls controls_;
  ScreenRect rect_{{0, 0}, {400, 300}};
  bool taken_ = false;
  std::optional<BodyPull> under_;
  std::optional<Object> selected_;
  Scene objects_;
  std::optional<double> below_;
  std::string told_;
  bool recorded_ = false, asked_below_ = false, blind_ = false, overlaid_ = false, twin_ = false;
  ViewRequest asked_;
  Settings settings_;
};

}  // namespace limpid
