// Layout of a plot in the window, at twice the usual scale: title, unit, legend, menu and area.
#include <array>
#include <cmath>

#include "app/plot/plot.h"
#include "tests/app/plot/imgui_frames.h"
#include "tests/support/drawn_shapes.h"
#include "tests/support/drawn_text.h"

namespace limpid {
namespace {

// ImGui's own font has 7 by 13 px a letter, however large the window's is.
class ALayout : public ImGuiFrames {
 protected:
  ALayout() {
    ImGui::GetIO().FontGlobalScale = 32 / 13.0f;
    for (int k = 0; k <= 1000; ++k) history_.append(1e-2 * k, std::array{3.0, 5.0});
  }
  void draw(ImVec2 size = {700, 500}) {
    if (!plot_) plot_.emplace(spec_);
    for (int i = 0; i < 3; ++i) {
      frame([&] {
        ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({790, 590});
        ImGui::Begin("plots", nullptr, ImGuiWindowFlags_NoDecoration);
        group_.begin_frame(history_);
        plot_->draw(history_, group_, size, saving_);
        ImGui::End();
        ImGui::PopStyleVar();
      });
    }
    texts_ = test::drawn_texts();
  }
  void draw_anew(ImVec2 size = {700, 500}) {
    plot_.reset();
    draw(size);
  }
  void expect_area(ImVec2 min, ImVec2 max) const {
    EXPECT_NEAR(plot_->area().min.x, min.x, 0.1);
    EXPECT_NEAR(plot_->area().min.y, min.y, 0.1);
    EXPECT_NEAR(plot_->area().max.x, max.x, 0.1);
    EXPECT_NEAR(plot_->area().max.y, max.y, 0.1);
  }
  void expect_at(const std::string& text, ImVec2 at, Rgb rgb) const {
    const auto found = std::ranges::find(texts_, text, &test::DrawnText::text);
    ASSERT_NE(found, texts_.end()) << text;
    EXPECT_NEAR(found->at.x, at.x, 1) << text;
    EXPECT_NEAR(found->at.y, at.y, 1) << text;
    EXPECT_EQ(found->colour, colour(rgb)) << text;
  }
  bool shown(const std::string& text) const {
    return std::ranges::find(texts_, text, &test::DrawnText::text) != texts_.end();
  }

  PlotSpec spec_{.title = "force",
                 .y = {.unit = "N", .zero_line = false},
                 .curves = {{.label = "first", .help = "what it is", .ink = Ink::hand},
                            {.channel = 1, .label = "second", .ink = Ink::contact}}};
  History history_{{.channels = 2, .tick = 1e-2}};
  std::optional<Plot> plot_;
  PlotGroup group_;
  PlotSaving saving_;
  std::vector<test::DrawnText> texts_;
};

TEST_F(ALayout, HasTitleUnitLegendAndMenuAboveItsArea) {
  saving_.arranged = true;
  draw();
  const Palette& p = current_palette();
  expect_area({58, 31}, {688, 475});
  expect_at("force", {4, 4}, p.text);
  expect_at("N", {53, 4}, p.muted);
  // Entries of 73 and 80 px, 24 apart, end 12 px left of the menu's button of 21.
  expect_at("first", {490 + 38, 6}, p.muted);
  expect_at("second", {490 + 97 + 38, 6}, p.muted);
  for (const auto& [which, left] : {std::pair(Ink::hand, 490.0f), {Ink::contact, 587.0f}}) {
    const auto all = test::drawn_shapes(colour(ink(p, which)));
    const auto swatch =
        std::ranges::find_if(all, [](const test::DrawnShape& each) { return each.max.y < 31; });
    ASSERT_NE(swatch, all.end());
    EXPECT_NEAR(swatch->min.x, left, 0.8);
    EXPECT_NEAR(swatch->max.x, left + 28, 0.8);
    EXPECT_NEAR(swatch->middle().y, 13, 0.6);
    EXPECT_NEAR(swatch->height(), 4, 1.2);
  }
  const auto muted = test::drawn_shapes(colour(p.muted));
  ASSERT_EQ(muted.size(), 3u) << "dots";
  EXPECT_NEAR(muted[1].middle().x, 689.5, 0.1);
  EXPECT_NEAR(muted[1].middle().y, 10.5, 0.1);
  saving_.arranged = false;
  draw();
  expect_at("second", {490 + 21 + 97 + 38, 6}, p.muted);
  EXPECT_TRUE(test::drawn_shapes(colour(p.muted)).empty()) << "nothing to arrange";
}

TEST_F(ALayout, HasItsLegendInLinesWhereItsTitleLeavesNoRoom) {
  draw({200, 300});
  const Palette& p = current_palette();
  expect_area({58, 48}, {188, 275});
  expect_at("first", {4 + 38, 23}, p.muted);
  expect_at("second", {4 + 97 + 38, 23}, p.muted);
  spec_.curves.push_back({.label = "third"});
  draw_anew({200, 300});
  expect_area({58, 48 + 17}, {188, 275});
  expect_at("third", {4 + 38, 40}, p.muted);
  // A hidden curve keeps its name, faint.
  plot_->spec().curves[2].visible = false;
  draw({200, 300});
  expect_at("third", {4 + 38, 40}, mix(p.muted, p.panel, 0.6f));
}

TEST_F(ALayout, ShortensItsTitleBeforeItsUnit) {
  spec_.title = std::string(200, 'w');
  spec_.y.unit = "mN";
  draw();
  const auto title = std::ranges::find_if(
      texts_, [](const test::DrawnText& each) { return each.text.starts_with("www"); });
  const auto unit = std::ranges::find(texts_, "mN", &test::DrawnText::text);
  ASSERT_NE(title, texts_.end());
  ASSERT_NE(unit, texts_.end());
  EXPECT_TRUE(title->text.ends_with("?")) << "an ellipsis";
  EXPECT_GT(unit->at.x, title->max.x + 8);
  EXPECT_LE(unit->max.x, 700 - 12 + 1);
  EXPECT_GT(unit->max.x, 700 - 12 - 8);
}

TEST_F(ALayout, LeavesAMarginForValuesAtTheEndWhereItIsWideEnough) {
  spec_.end_labels = true;
  draw();
  expect_area({58, 31}, {700 - 12 - 54, 475});
  EXPECT_TRUE(shown("3.00") || shown("3.000") || shown("3.0"));
  draw_anew({150, 300});
  EXPECT_NEAR(plot_->area().max.x, 138, 0.1) << "54 px are more than a third";
}

TEST_F(ALayout, SaysThatThereIsNothing) {
  history_.clear();
  draw();
  const Palette& p = current_palette();
  expect_at("no data yet", {58 + (630 - 77) / 2.0f, 31 + (444 - 13) / 2.0f}, p.muted);
  history_.append(0, std::array{3.0, 5.0});
  spec_.curves.clear();
  draw_anew();
  expect_at("nothing to show", {58 + (630 - 105) / 2.0f, 31 + (444 - 13) / 2.0f}, p.muted);
  spec_.curves = {{.label = "first"}};
  draw_anew();
  EXPECT_FALSE(shown("no data yet") || shown("nothing to show"));
}

// The curve whose name the mouse is on is thicker, and the others are faint.
TEST_F(ALayout, ExplainsTheCurveWhoseNameIsPointedAt) {
  draw();
  const auto thickness = [&](Ink which, float alpha) {
    float thick = 0;
    for (const auto& each : test::drawn_shapes(colour(ink(current_palette(), which), alpha))) {
      if (each.width() > 500) thick = std::max(thick, each.height());
    }
    return thick;
  };
  const float usual = thickness(Ink::hand, 1);
  EXPECT_GT(usual, 0);
  EXPECT_NEAR(thickness(Ink::contact, 1), usual, 0.1);
  const auto found = std::ranges::find(texts_, "first", &test::DrawnText::text);
  ASSERT_NE(found, texts_.end());
  const test::DrawnText name = *found;
  show_mouse(name.middle());
  draw();
  EXPECT_GT(thickness(Ink::hand, 1), usual + 0.9f);
  EXPECT_EQ(thickness(Ink::contact, 1), 0);
  EXPECT_NEAR(thickness(Ink::contact, 0.3f), usual, 0.1);
  std::string said;
  for (const test::DrawnText& each : texts_) {
    if (each.window.starts_with("##Tooltip")) said += (said.empty() ? "" : " ") + each.text;
  }
  EXPECT_EQ(said, "first: what it is. A click hides or shows this curve.");
  expect_at("first", name.at, current_palette().text);
}

TEST(PlotsOfAGroup, KeepPlaybackAtThreeQuartersOfTheirTime) {
  History history({.channels = 1, .tick = 1e-2});
  for (int k = 0; k <= 3000; ++k) history.append(1e-2 * k, std::array{0.0});
  PlotGroup group(10);
  for (const auto& [playback, stop] :
       {std::pair(12.0, 14.5), {29.0, 30.0}, {3.0, 10.0}, {0.0, 10.0}}) {
    group.begin_frame(history, playback);
    EXPECT_NEAR(group.stop(), stop, 1e-9) << playback;
    EXPECT_NEAR(group.start(), stop - 10, 1e-9);
    EXPECT_EQ(group.playback(), playback);
  }
  group.pan(100);
  EXPECT_FALSE(group.following()) << "the newest data is not what it follows";
  group.begin_frame(history, 5.0);
  EXPECT_NEAR(group.stop(), 39, 1e-9) << "a tenth of the window keeps its data";
  group.pan(-1000);
  group.begin_frame(history, 5.0);
  EXPECT_NEAR(group.stop(), 1, 1e-9);
  group.zoom(100, 1);
  EXPECT_NEAR(group.length(), 36, 1e-9) << "1.2 of all there is";
  group.zoom(1e-9, 1);
  EXPECT_NEAR(group.length(), 0.08, 1e-9) << "eight ticks";
  group.set_fitted_length(20);
  group.fit();
  group.begin_frame(history);
  EXPECT_NEAR(group.start(), 10, 1e-9);
  EXPECT_NEAR(group.stop(), 30, 1e-9);
}

TEST(PlotsOfAGroup, ForgetASelectionWithItsRowsAndTheMouseAfterAFrame) {
  History history({.channels = 1, .tick = 1e-2});
  for (int k = 0; k <= 3000; ++k) history.append(1e-2 * k, std::array{0.0});
  PlotGroup group(10);
  const auto kept = [&](double start, double stop) {
    group.select(PlotRange{start, stop, 2});
    group.begin_frame(history);
    return group.range().has_value();
  };
  EXPECT_TRUE(kept(29, 45));
  EXPECT_EQ(group.range(), (PlotRange{29, 45, 2}));
  EXPECT_TRUE(kept(-5, 1));
  EXPECT_FALSE(kept(31, 45));
  EXPECT_FALSE(kept(-5, -1));
  group.select(PlotRange{1, 2});
  group.begin_frame(History({.channels = 1}));
  EXPECT_FALSE(group.range()) << "of nothing";
  group.begin_frame(history);
  group.hover(7);
  group.hover_frequency(40);
  EXPECT_EQ(group.hovered(), 7);
  group.begin_frame(history);
  EXPECT_EQ(group.hovered(), 7) << "for plots that were drawn before";
  EXPECT_EQ(group.hovered_frequency(), 40);
  group.begin_frame(history);
  EXPECT_FALSE(group.hovered());
  EXPECT_FALSE(group.hovered_frequency());
}

}  // namespace
}  // namespace limpid
