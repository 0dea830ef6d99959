// The 3D view as it is drawn, frame by frame. Skipped where EGL gives no context.
#include "app/desktop/panels/view_panel.h"

#include <optional>

#include "render/gl/offscreen.h"
#include "tests/app/plot/imgui_frames.h"
#include "tests/support/built_in.h"

namespace limpid {
namespace {

class AView : public ImGuiFrames {
 protected:
  void SetUp() override {
    try {
      context_.emplace(400, 300);
    } catch (const std::runtime_error& error) {
      GTEST_SKIP() << error.what();
    }
    History history({.channels = TraceChannels(layout_).count(), .seconds = 1, .tick = 0.01});
    stage_ =
        std::make_unique<Stage>(test::omni(), SceneDocument{}, MeshModels{}, std::move(history), 1);
    camera_.reset(stage_->picture.bounds());
    camera_.finish();
  }
  ViewScene scene() { return {.stage = *stage_, .row = row_, .pixel_height = 600}; }
  void draw() {
    frame([&] { panel_.draw(scene(), camera_, controls_, settings_, {{0, 0}, {400, 300}}); });
  }
  bool differs(const Settings& settings) { return panel_.differs(scene(), camera_, settings); }

  const RowLayout layout_{3};
  std::vector<double> row_ = std::vector<double>(static_cast<std::size_t>(layout_.stride()), 0.0);
  std::optional<OffscreenContext> context_;
  std::unique_ptr<Stage> stage_;
  ViewPanel panel_;
  Camera camera_;
  Controls controls_;
  Settings settings_;
};

// As in playback that is paused: the same row in every frame, with what moved before it behind it.
TEST_F(AView, IsNotDrawnAgainWhileARowStandsStill) {
  for (const double time : {0.0, 0.1, 0.2}) {
    layout_.in(std::span(row_), Column::time)[0] = time;
    layout_.in(std::span(row_), Column::device_position)[0] = time;
    draw();
    EXPECT_FALSE(differs(settings_)) << time;
  }
}

TEST_F(AView, IsDrawnAgainForEachOfItsSwitches) {
  draw();
  EXPECT_FALSE(differs(settings_)) << "nothing has moved";
  using Switch = bool Settings::*;
  for (const Switch one : {&Settings::show_ghost, &Settings::show_trail, &Settings::show_forces,
                           &Settings::show_grid, &Settings::show_joints}) {
    Settings other = settings_;
    other.*one = !(other.*one);
    EXPECT_TRUE(differs(other));
  }
  Settings other = settings_;
  other.theme = other.theme == Theme::dark ? Theme::light : Theme::dark;
  EXPECT_TRUE(differs(other));
}

}  // namespace
}  // namespace limpid
