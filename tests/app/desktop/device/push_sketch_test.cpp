// The sketch of the check of a device's axes: which way its arrow points, and the room it takes.
#include "app/desktop/device/push_sketch.h"

#include <algorithm>
#include <string>
#include <vector>

#include "app/plot/plot_frame.h"
#include "tests/app/desktop/widgets/read_panel.h"
#include "tests/support/built_in.h"

namespace limpid {
namespace {

ArmDescription shipped_arm(const char* name) {
  return read_urdf(test::assets_dir() / "devices" / name);
}

void expect_arrow(const ArmDescription& arm, int axis, PushView view, ImVec2 direction) {
  SCOPED_TRACE(arm.name + ", axis " + std::to_string(axis));
  const auto arrow = push_arrow(arm, axis);
  ASSERT_TRUE(arrow);
  EXPECT_EQ(arrow->view, view);
  EXPECT_NEAR(arrow->direction.x, direction.x, 0.02);
  EXPECT_NEAR(arrow->direction.y, direction.y, 0.02);
}

TEST(PushArrow, PointsWhereTheFirstPushMovesTheTip) {
  const ArmDescription omni = test::omni();
  expect_arrow(omni, 0, PushView::above, {-1, 0});                         // to the left
  expect_arrow(omni, 1, PushView::side, {0, 1});                           // down
  expect_arrow(omni, 2, PushView::side, {-0.7071f, 0.7071f});              // back and down
  expect_arrow(shipped_arm("paddle.urdf"), 0, PushView::side, {1, 0});     // forward
  expect_arrow(shipped_arm("joystick.urdf"), 0, PushView::above, {1, 0});  // to the right
  expect_arrow(shipped_arm("joystick.urdf"), 1, PushView::side, {-1, 0});  // towards the user
}

TEST(PushArrow, IsMissingWhereNoTipMoves) {
  ArmDescription arm = test::omni();
  EXPECT_FALSE(push_arrow(arm, -1));
  EXPECT_FALSE(push_arrow(arm, arm.dof()));
  arm.joints.back().axis = Vec3::UnitX();  // along the forearm
  EXPECT_FALSE(push_arrow(arm, arm.dof() - 1));
}

class APushSketch : public ReadPanel {
 protected:
  void draw(const ArmDescription& arm, int axis, AxisStage stage) {
    show([this, arm, axis, stage] {
      ImDrawList& list = *ImGui::GetWindowDrawList();
      const int before = list.VtxBuffer.Size;
      drawn_ = draw_push_sketch(arm, axis, stage);
      corners_.assign(list.VtxBuffer.begin() + before, list.VtxBuffer.end());
      room_ = {ImGui::GetItemRectMin(), ImGui::GetItemRectMax()};
      ImGui::TextUnformatted("below");
    });
  }

  bool drawn_ = false;
  std::vector<ImDrawVert> corners_;
  ScreenRect room_{};
};

TEST_F(APushSketch, TakesItsRoomAndStaysInIt) {
  for (int axis = 0; axis < 3; ++axis) {
    draw(test::omni(), axis, AxisStage::pushing);
    ASSERT_TRUE(drawn_);
    EXPECT_EQ(room_.width(), push_sketch_size().x);
    EXPECT_EQ(room_.height(), push_sketch_size().y);
    EXPECT_GE(room_.min.x, 0);
    EXPECT_LE(room_.max.x, kWidth);
    for (const ImDrawVert& each : corners_) {
      EXPECT_GE(each.pos.x, room_.min.x - 1);
      EXPECT_LE(each.pos.x, room_.max.x + 1);
      EXPECT_GE(each.pos.y, room_.min.y - 1);
      EXPECT_LE(each.pos.y, room_.max.y + 1);
    }
    const auto below = find("below");
    ASSERT_TRUE(below);
    EXPECT_GE(below->min.y, room_.max.y - 1);
  }
}

// The arrow is longer than wide, and its head, which is widest, is in its front half.
TEST_F(APushSketch, HasAColouredArrowThatPointsTheWayOfThePushUnderWay) {
  for (int i = 0; i < 6; ++i) {
    SCOPED_TRACE(i);
    const int axis = i / 2;
    const bool second = i % 2 == 1;
    draw(test::omni(), axis, second ? AxisStage::pushing_back : AxisStage::pushing);
    ImVec2 way = push_arrow(test::omni(), axis)->direction;
    if (second) way = {-way.x, -way.y};
    const auto along = [&](const ImVec2& at) { return at.x * way.x + at.y * way.y; };
    const auto across = [&](const ImVec2& at) { return at.x * way.y - at.y * way.x; };
    std::vector<ImVec2> arrow;
    for (const ImDrawVert& each : corners_) {
      if (each.col == colour(current_palette().accent)) arrow.push_back(each.pos);
    }
    ASSERT_GE(arrow.size(), 3u);
    const auto [back, front] = std::ranges::minmax(arrow, {}, along);
    const auto [left, right] = std::ranges::minmax(arrow, {}, across);
    EXPECT_GT(along(front) - along(back), 2 * (across(right) - across(left)));
    for (const ImVec2& widest : {left, right}) {
      EXPECT_GT(along(widest), (along(front) + along(back)) / 2);
    }
    draw(test::omni(), axis, AxisStage::resting);
    for (const ImDrawVert& each : corners_) {
      EXPECT_NE(each.col, colour(current_palette().accent)) << "nothing pushes";
    }
  }
}

TEST_F(APushSketch, SaysWhereItIsSeenFromAndWhichWayTheBaseLies) {
  draw(test::omni(), 0, AxisStage::pushing);
  for (const char* word : {"from above", "x forward", "y left"}) EXPECT_TRUE(find(word)) << word;
  draw(test::omni(), 1, AxisStage::pushing);
  for (const char* word : {"from the side", "x forward", "z up"}) EXPECT_TRUE(find(word)) << word;
}

}  // namespace
}  // namespace limpid
