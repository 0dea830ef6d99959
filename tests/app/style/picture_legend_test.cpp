// Room that the legend takes in a picture, and its words beside their colours.
#include "app/style/picture_legend.h"

#include <gtest/gtest.h>

#include "app/style/palette.h"
#include "app/style/theme.h"
#include "tests/app/plot/imgui_frames.h"
#include "tests/support/drawn_shapes.h"
#include "tests/support/drawn_text.h"

namespace limpid {
namespace {

class ALegend : public ImGuiFrames {
 protected:
  ImVec2 size_in(float width, float height) {
    ImVec2 size;
    frame([&] { size = picture_legend_size({0, 0}, {width, height}); });
    return size;
  }
  // Draws the legend of a picture whose corner is at 100, 50, in letters of 7 by 13 px.
  void draw(ImVec2 to, const PictureLegend& legend = {}) {
    frame([] {});
    frame([&] { draw_picture_legend(*ImGui::GetForegroundDrawList(), {100, 50}, to, legend); });
    texts_ = test::drawn_texts();
  }
  // Expects an entry: its text with a dot of each colour before it.
  void expect_entry(std::size_t i, const std::string& text, ImVec2 at,
                    const std::vector<Rgb>& dots) {
    ASSERT_LT(i, texts_.size());
    EXPECT_EQ(texts_[i].text, text);
    const float before = 0.7f * 13 * static_cast<float>(dots.size());
    EXPECT_NEAR(texts_[i].at.x, at.x + before + 3.9f, 1.1) << text;
    EXPECT_NEAR(texts_[i].at.y, at.y, 1.1) << text;
    EXPECT_EQ(texts_[i].colour, colour(current_palette().text, 0.85f));
    for (std::size_t k = 0; k < dots.size(); ++k) {
      const float x = at.x + 3.9f + 9.1f * static_cast<float>(k);
      bool found = false;
      for (const test::DrawnShape& each : test::drawn_shapes(colour(dots[k]))) {
        found = found || (std::abs(each.middle().x - x) < 0.5f &&
                          std::abs(each.middle().y - at.y - 7.15f) < 0.5f &&
                          std::abs(each.width() - 6.8f) < 0.7f);
      }
      EXPECT_TRUE(found) << text << ", dot " << k;
    }
  }
  static Rgb of(Ink which, float shade = 0) { return ink(current_palette(), which, shade); }

  std::vector<test::DrawnText> texts_;
};

TEST_F(ALegend, IsACornerOfALargePicture) {
  const ImVec2 size = size_in(900, 500);
  EXPECT_LT(size.x, 300);
  EXPECT_LT(size.y, 150);
  EXPECT_GT(size.y, 60) << "a line for each thing";
}

TEST_F(ALegend, IsAStripOfASmallOne) {
  for (const auto& [width, height] : {std::pair{450.f, 180.f}, {340.f, 400.f}}) {
    EXPECT_LT(size_in(width, height).y, 40) << width << " x " << height;
  }
}

TEST_F(ALegend, GoesOnInAnotherLineWhereAStripIsTooLong) {
  EXPECT_GT(size_in(120, 400).y, size_in(340, 400).y);
}

TEST_F(ALegend, HasALineForEachThingInItsColour) {
  draw({700, 450});
  ASSERT_EQ(texts_.size(), 4u);
  const float x = 111.7f, y = 60.4f, line = 17.55f;
  expect_entry(0, "device (ghost)", {x, y}, {of(Ink::device)});
  expect_entry(1, "proxy", {x, y + line}, {of(Ink::proxy)});
  expect_entry(2, "hand", {x, y + 2 * line}, {of(Ink::hand)});
  expect_entry(3, "contact force, 1 N = 2 cm", {x, y + 3 * line}, {of(Ink::contact)});
  draw({700, 450}, {.beside = "again", .cone = "sticks", .runs = {"one", "two"}});
  ASSERT_EQ(texts_.size(), 8u);
  expect_entry(4, "one", {x, y + 4 * line}, {of(Ink::device), of(Ink::proxy)});
  EXPECT_EQ(texts_[5].text, "two");
  EXPECT_NEAR(texts_[5].at.x, x + 2 * 9.1f + 3.9f, 1.1) << "behind two dots";
  expect_entry(6, "again", {x, y + 6 * line}, {of(Ink::rerun)});
  expect_entry(7, "sticks", {x, y + 7 * line}, {rgb(0xcc79a7)});
  draw({700, 450}, {.cone = "slips", .slips = true});
  expect_entry(4, "slips", {x, y + 4 * line}, {rgb(0xf0e442)});
}

TEST_F(ALegend, HasShortWordsSideBySideInASmallPicture) {
  const float x = 111.7f, y = 60.4f, gap = 13 + 14.3f;
  for (const ImVec2 to : {ImVec2{700, 250}, {480, 450}}) {
    draw(to);
    ASSERT_EQ(texts_.size(), 4u);
    expect_entry(0, "device", {x, y}, {of(Ink::device)});
    expect_entry(1, "proxy", {x + 42 + gap, y}, {of(Ink::proxy)});
    expect_entry(2, "hand", {x + 77 + 2 * gap, y}, {of(Ink::hand)});
    expect_entry(3, "contact", {x + 105 + 3 * gap, y}, {of(Ink::contact)});
    EXPECT_EQ(test::drawn_shapes().size(), 4u) << "dots alone";
  }
  draw({700, 450}, {.compact = true});
  expect_entry(3, "contact", {x + 105 + 3 * gap, y}, {of(Ink::contact)});
  const auto veils = test::drawn_shapes(colour(current_palette().backdrop, 0.72f));
  ASSERT_EQ(veils.size(), 4u);
  EXPECT_NEAR(veils[0].min.x, x - 7.15f, 0.1);
  EXPECT_NEAR(veils[0].max.x, x + 13 + 42 + 7.15f, 0.1);
  EXPECT_NEAR(veils[0].min.y, y - 1.95f, 0.1);
  EXPECT_NEAR(veils[0].max.y, y + 15.6f, 0.1);
  draw({270, 250});
  expect_entry(2, "hand", {x, y + 17.55f}, {of(Ink::hand)});
}

TEST_F(ALegend, TellsItsSizeFromItsCorner) {
  ImVec2 size;
  frame([] {});
  frame([&] { size = picture_legend_size({100, 50}, {700, 450}); });
  EXPECT_NEAR(size.x, 0.9f * 13 + 13 + 25 * 7, 0.5) << "its longest line";
  EXPECT_NEAR(size.y, 0.8f * 13 + 6 * 17.55f, 0.5) << "four lines, and two that come and go";
  frame([&] { size = picture_legend_size({100, 50}, {600, 250}); });
  EXPECT_NEAR(size.x, 500, 0.1) << "all of the width";
  EXPECT_NEAR(size.y, 0.8f * 13 + 17.55f, 0.5);
}

}  // namespace
}  // namespace limpid
