// The stage's picture and plots, and the lens over the picture. Skipped where EGL gives no context.
#include "app/stage/stage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/stage/magnifier.h"
#include "app/style/palette.h"
#include "app/style/theme.h"
#include "core/dynamics/arm.h"
#include "tests/app/plot/imgui_frames.h"
#include "tests/support/built_in.h"
#include "tests/support/computer.h"
#include "tests/support/drawn_shapes.h"
#include "tests/support/drawn_text.h"
#include "tests/support/faultless_context.h"

namespace limpid {
namespace {

constexpr int kStageWide = 600, kStageHigh = 400;  // [px]

// A stage of two runs in an empty scene, in a window of 600 by 400.
class AStage : public ImGuiFrames {
 protected:
  void SetUp() override {
    if (!test::has_offscreen_pictures()) GTEST_SKIP() << "no EGL here";
    context_.emplace(kStageWide, kStageHigh);
    ImGui::GetIO().DisplaySize = {kStageWide, kStageHigh};
    apply_theme(Theme::dark, 1);
    frame([] {});
    open(2);
  }
  void open(int runs) {
    History history({.channels = runs * TraceChannels(layout_).count(), .seconds = 10});
    stage_.emplace(test::omni(), SceneDocument{}, MeshModels{}, std::move(history), 10);
    camera_.resize(kStageWide, kStageHigh);
    camera_.reset(stage_->picture.bounds());
    camera_.finish();
    const Eigen::VectorXd rest = rest_pose(test::omni());
    std::vector<double> row(static_cast<std::size_t>(layout_.stride()), 0.0);
    for (const Column c : {Column::device_position, Column::proxy_position}) {
      std::ranges::copy(rest, layout_.in(std::span(row), c).begin());
    }
    view_ = stage_->rows().view(layout_, row);
  }
  std::vector<unsigned char> picture() {
    fill(0x112233);
    stage_->picture.draw(view_, camera_, 0, 0, kStageWide, kStageHigh);
    return read_rgba(kStageWide, kStageHigh);
  }
  static SceneDocument with_ball(bool moves) {
    SceneDocument document;
    Object ball{.name = "ball", .pose = pose_at(Vec3(0.1, 0.1, 0.1)), .shape = Sphere{0.05}};
    if (moves) ball.body.emplace();
    document.scene.add(ball);
    return document;
  }
  static int different(const std::vector<unsigned char>& a, const std::vector<unsigned char>& b) {
    int count = 0;
    for (std::size_t i = 0; i < a.size(); i += 4) {
      const auto apart = [&](std::size_t k) { return std::abs(a[i + k] - b[i + k]); };
      count += apart(0) + apart(1) + apart(2) > 30 ? 1 : 0;
    }
    return count;
  }

  const RowLayout layout_{3};
  std::optional<test::FaultlessContext> context_;
  std::optional<Stage> stage_;
  Camera camera_;
  ViewState view_;
};

TEST_F(AStage, ShowsAnotherSceneAroundTheSameArm) {
  const auto empty = picture();
  const SceneDocument ball = with_ball(false), moving = with_ball(true);
  stage_->show(ball, {nullptr}, {});
  const auto with = picture();
  EXPECT_GT(different(empty, with), 500);
  EXPECT_EQ(stage_->document().scene.objects.size(), 1u);
  for (const auto& change :
       {std::function<void(Object&)>([](Object& o) { o.pose.translation().x() += 0.1; }),
        {[](Object& o) { o.shape = Sphere{0.08}; }},
        {[](Object& o) { o.color = Vec3(1, 0, 0); }}}) {
    SceneDocument other = ball;
    change(other.scene.objects[0]);
    stage_->show(other, {nullptr}, {});
    EXPECT_GT(different(with, picture()), 300);
    stage_->show(ball, {nullptr}, {});
    EXPECT_LT(different(with, picture()), 100) << "as before";
  }
  // A body that moves has a place in the rows.
  stage_->show(moving, {nullptr}, {});
  const RowLayout layout(3, 1);
  std::vector<double> row(static_cast<std::size_t>(layout.stride()), 0.0);
  layout.in(std::span(row), Column::body_pose)[3] = 1;
  EXPECT_EQ(stage_->rows().bodies(layout, row).size(), 1u);
  stage_->show({}, {}, {});
  EXPECT_LT(different(empty, picture()), 100);
  EXPECT_TRUE(stage_->rows().bodies(layout, row).empty());
}

TEST_F(AStage, HasAPlotForEachChoiceAndKeepsThoseThatStay) {
  const auto titles = [&] {
    std::vector<std::string> all;
    for (const Plot& plot : stage_->plots) all.push_back(plot.spec().title);
    return all;
  };
  std::vector<PlotChoice> choices = default_plots();
  ASSERT_EQ(titles().size(), 4u);
  EXPECT_EQ(titles()[1], choices[1].title);
  stage_->plots[1].spec().curves[0].visible = false;
  stage_->plots[2].spec().curves[1].visible = false;
  choices.erase(choices.begin());
  stage_->choose_plots(choices);
  ASSERT_EQ(titles(), (std::vector{choices[0].title, choices[1].title, choices[2].title}));
  EXPECT_FALSE(stage_->plots[0].spec().curves[0].visible) << "it went along";
  EXPECT_FALSE(stage_->plots[1].spec().curves[1].visible);
  choices[0].title = "another name";
  stage_->choose_plots(choices);
  EXPECT_EQ(titles()[0], "another name");
  EXPECT_FALSE(stage_->plots[1].spec().curves[1].visible);
  choices.push_back({.title = "new", .channels = {"hand/torque_norm"}});
  stage_->choose_plots(choices);
  ASSERT_EQ(titles().size(), 4u);
  EXPECT_EQ(titles()[3], "new");
  EXPECT_EQ(stage_->plots[3].spec().curves.size(), 1u);
}

TEST_F(AStage, NamesItsRunsInAllPlots) {
  const auto labels = [&](std::size_t plot) {
    std::vector<std::string> all;
    for (const Curve& curve : stage_->plots[plot].spec().curves) all.push_back(curve.label);
    return all;
  };
  ASSERT_EQ(labels(0).size(), 1u);
  stage_->name_runs({{"one", "two", "three"}, true, {0, 2, 1}});
  EXPECT_EQ(labels(0), (std::vector<std::string>{"one", "two"})) << "the history has two";
  EXPECT_EQ(stage_->names().name(1), "two");
  EXPECT_EQ(stage_->names().name(2), "");
  stage_->plots[0].spec().curves[1].visible = false;
  stage_->name_runs({{"first", "second"}, true, {0, 2}});
  EXPECT_EQ(labels(0), (std::vector<std::string>{"first", "second"}));
  EXPECT_FALSE(stage_->plots[0].spec().curves[1].visible) << "hidden as before";
  EXPECT_TRUE(stage_->plots[0].spec().curves[0].visible);
  stage_->name_runs({{"recorded", "re-run"}, false});
  EXPECT_EQ(labels(0), (std::vector<std::string>{"recorded", "re-run"}));
  EXPECT_TRUE(stage_->plots[0].spec().curves[1].visible) << "other runs than before";
  stage_->name_runs({});
  EXPECT_EQ(labels(0).size(), 1u);
}

// The lens has 0.42 of the height. Its corner is 0.6 letters from the lower right one.
class ALens : public AStage {
 protected:
  // Draws frames of 0.1 s and returns the lens's place.
  std::optional<ScreenRect> look(const Crowd& crowd = {}, int frames = 1) {
    for (int i = 0; i < frames; ++i) {
      frame(
          [&] {
            magnifier_.draw(stage_->picture, view_, camera_, {area_, 1, kStageHigh, 0}, crowd);
            magnifier_.draw_frame(view_, camera_, *ImGui::GetForegroundDrawList());
          },
          0.1f);
    }
    return magnifier_.rect();
  }
  // Puts the tips so far apart in the picture [px].
  void apart(double pixels) {
    view_.device.tip = view_.proxy.tip;
    const double size = camera_.meters_per_pixel(view_.proxy.tip);
    view_.device.tip += pixels * size * camera_.right();
  }
  const ScreenRect area_{{0, 0}, {kStageWide, kStageHigh}};
  const ImVec2 corner_{600 - 7.8f - 168, 400 - 7.8f - 168};
  Magnifier magnifier_;
};

TEST_F(ALens, EnlargesTheTipsInItsCorner) {
  apart(3);
  fill(0x112233);
  const auto place = look();
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->min.x, corner_.x, 1);
  EXPECT_NEAR(place->min.y, corner_.y, 1);
  EXPECT_NEAR(place->width(), 168, 1.1);
  EXPECT_NEAR(place->height(), 168, 1.1);
  const auto pixels = read_rgba(kStageWide, kStageHigh);
  int outside = 0, inside = 0;
  for (int y = 0; y < kStageHigh; ++y) {
    for (int x = 0; x < kStageWide; ++x) {
      const auto i = 4 * static_cast<std::size_t>(y * kStageWide + x);
      const bool drawn = pixels[i] != 0x11 || pixels[i + 1] != 0x22 || pixels[i + 2] != 0x33;
      const ImVec2 at(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      (place->contains(at) ? inside : outside) += drawn ? 1 : 0;
    }
  }
  EXPECT_EQ(outside, 0);
  EXPECT_EQ(inside, std::lround(place->width() * place->height()));
}

TEST_F(ALens, HasAFrameItsPlaceInThePictureAndABarOfRoundLength) {
  apart(3);
  const ScreenRect place = look().value();
  const Palette& p = current_palette();
  const float scale = 13 / 16.0f;
  const auto frame = test::drawn_shapes(colour(p.text, 0.55f));
  ASSERT_EQ(frame.size(), 1u);
  EXPECT_NEAR(frame[0].min.x, place.min.x, 1.6);
  EXPECT_NEAR(frame[0].max.y, place.max.y, 1.6);
  // A fifth of its size, around the middle of the tips.
  const auto part = test::drawn_shapes(colour(p.text, 0.35f));
  ASSERT_EQ(part.size(), 1u);
  const Vec3 tips = 0.5 * (view_.device.tip + view_.proxy.tip);
  const Eigen::Vector2d middle = *camera_.project(tips);
  EXPECT_NEAR(part[0].middle().x, middle.x(), 0.6);
  EXPECT_NEAR(part[0].middle().y, middle.y(), 0.6);
  EXPECT_NEAR(part[0].width(), 168 / 5.0, 2 * scale + 2);
  // The longest of 0.1, 0.2, 0.5, 1 ... 50 mm below two fifths of the lens.
  const double pixel = camera_.meters_per_pixel(tips) / 5;
  double bar = 0;
  for (const double mm : {0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0}) {
    if (mm < 1e3 * 0.4 * 168 * pixel) bar = mm;
  }
  const float length = static_cast<float>(1e-3 * bar / pixel);
  const auto texts = test::drawn_texts();
  ASSERT_EQ(texts.size(), 1u);
  EXPECT_EQ(texts[0].text, fmt::format("x5   {:g} mm", bar));
  EXPECT_NEAR(texts[0].at.x, place.min.x + 6.5f, 1.1);
  EXPECT_NEAR(texts[0].at.y, place.min.y + 2.6f, 1.1);
  EXPECT_EQ(texts[0].colour, colour(p.text));
  const auto line = test::drawn_shapes(colour(p.text));
  ASSERT_EQ(line.size(), 1u);
  EXPECT_NEAR(line[0].min.x, place.min.x + 6.5f + 0.5f, 1);
  EXPECT_NEAR(line[0].width(), length, 1);
  EXPECT_NEAR(line[0].middle().y, place.min.y + 1.55f * 13 + 0.5f, 1);
  const auto veil = test::drawn_shapes(colour(p.backdrop, 0.75f));
  ASSERT_EQ(veil.size(), 1u);
  const float words = 7 * static_cast<float>(texts[0].text.size());
  EXPECT_NEAR(veil[0].min.x, place.min.x + 1, 0.1);
  EXPECT_NEAR(veil[0].min.y, place.min.y + 1, 0.1);
  EXPECT_NEAR(veil[0].max.x, place.min.x + std::max(words, length) + 19.5f, 0.6);
  EXPECT_NEAR(veil[0].max.y, place.min.y + 1.9f * 13, 0.1);
}

TEST_F(ALens, StaysAMomentAndBeginsAgainInItsBestCorner) {
  apart(3);
  ASSERT_TRUE(look());
  const Crowd there{{{corner_, {600, 400}}}, {}};
  const ScreenRect moved = look(there).value();
  EXPECT_LT(moved.min.y, 20) << "the tips are where it was";
  EXPECT_NEAR(look({}).value().min.y, moved.min.y, 0.1) << "it does not come back for nothing";
  apart(0);
  EXPECT_TRUE(look({}, 6)) << "for 0.7 s";
  EXPECT_FALSE(look({}, 3));
  EXPECT_TRUE(test::drawn_shapes().empty());
  apart(3);
  EXPECT_NEAR(look().value().min.y, corner_.y, 1);
  magnifier_.hide();
  EXPECT_FALSE(magnifier_.rect());
  apart(41);
  EXPECT_FALSE(look({}, 9)) << "that can be seen without";
  apart(39);
  EXPECT_TRUE(look());
  apart(0);
  EXPECT_FALSE(look({}, 9));
  apart(0.2);
  EXPECT_FALSE(look()) << "nobody could tell them apart";
}

}  // namespace
}  // namespace limpid
