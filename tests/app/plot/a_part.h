// Parts of a plot, drawn by themselves at twice the usual scale.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "app/plot/plot_frame.h"
#include "tests/app/plot/imgui_frames.h"
#include "tests/support/drawn_shapes.h"
#include "tests/support/drawn_text.h"

namespace limpid {

// Six seconds and ten units in an area of 600 by 440. ImGui's own font has 7 by 13 px a letter.
class APart : public ImGuiFrames {
 protected:
  APart() {
    frame([] {});  // the font is there from the first frame on
    for (int k = 0; k < 600; ++k) append(std::array{1e-2 * k, 3.0});
  }
  void append(const std::array<double, 2>& row) {
    history_.append(1e-2 * (static_cast<double>(history_.end()) + 0.5), row);
  }
  void draw(const std::function<void(const PlotFrame&)>& what) {
    frame([&] {
      what({*ImGui::GetForegroundDrawList(), kLightPalette, 2, outer_, area_, window_, x_, y_});
    });
    texts_ = test::drawn_texts();
  }
  std::vector<SampleIndex> pixels() const {
    std::vector<SampleIndex> rows;
    pixel_rows(history_, window_, rows);
    return rows;
  }
  static void expect_box(const test::DrawnShape& shape, ImVec2 min, ImVec2 max,
                         float within = 0.1f) {
    EXPECT_NEAR(shape.min.x, min.x, within);
    EXPECT_NEAR(shape.min.y, min.y, within);
    EXPECT_NEAR(shape.max.x, max.x, within);
    EXPECT_NEAR(shape.max.y, max.y, within);
  }
  // Expects a text at a place, in its colour.
  void expect_said(const std::string& what, ImVec2 at, Rgb rgb) const {
    const auto found = std::ranges::find(texts_, what, &test::DrawnText::text);
    ASSERT_NE(found, texts_.end()) << what;
    EXPECT_NEAR(found->at.x, at.x, 1) << what;
    EXPECT_NEAR(found->at.y, at.y, 1) << what;
    EXPECT_EQ(found->colour, colour(rgb)) << what;
  }
  bool says(const std::string& what) const {
    return std::ranges::find(texts_, what, &test::DrawnText::text) != texts_.end();
  }

  const ScreenRect area_{{60, 40}, {660, 480}};
  ScreenRect outer_{{0, 0}, {700, 520}};
  PixelWindow window_{1e-2, 0, 600};
  AxisMap x_{{0, 6}}, y_{{0, 10}};
  PlotSpec spec_{.curves = {{.label = "one", .ink = Ink::hand}}};
  History history_{{.channels = 2, .tick = 1e-2}};
  std::vector<test::DrawnText> texts_;
  const Palette& palette_ = kLightPalette;
};

}  // namespace limpid
