// Room that the legend takes in a picture.
#include "app/style/picture_legend.h"

#include "tests/app/plot/imgui_frames.h"

namespace limpid {
namespace {

class ALegend : public ImGuiFrames {
 protected:
  ImVec2 size_in(float width, float height) {
    ImVec2 size;
    frame([&] { size = picture_legend_size({0, 0}, {width, height}); });
    return size;
  }
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

}  // namespace
}  // namespace limpid
