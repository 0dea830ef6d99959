#include "app/desktop/scene/transform_tool.h"

#include <thread>

#include "app/desktop/scene/document.h"
#include "tests/app/desktop/shell/whole_window.h"

namespace limpid {
namespace {

class ATransform : public WholeWindow {
 protected:
  void SetUp() override {
    WholeWindow::SetUp();
    if (!desktop) return;
    desktop->world.add_object({"mine", pose_at(Vec3(0.2, 0, 0.05)), Sphere{0.02}, {500}});
    frames(3);
    place_ = desktop->document.scene().objects.size() - 1;
    desktop->document.editor().select(place_);
    frames(3);
  }
  Vec3 at() const { return desktop->document.scene().objects[place_].pose.translation(); }
  ImVec2 middle() const {
    return {0.5f * static_cast<float>(width), 0.35f * static_cast<float>(height)};
  }
  std::size_t place_ = 0;
};

// Begun by a key the object follows the mouse without a button; a click puts it down for good.
TEST_F(ATransform, ByAKeyFollowsTheMouseUntilAClick) {
  const Vec3 before = at();
  point_at(middle());
  run("object.move");
  EXPECT_TRUE(desktop->transform.follows());
  point_at({middle().x + 60, middle().y});
  EXPECT_TRUE(desktop->transform.follows()) << "no button was pressed";
  const Vec3 moved = at();
  EXPECT_GT((moved - before).norm(), 0.005);
  click(ImVec2(middle().x + 60, middle().y));
  EXPECT_FALSE(desktop->transform.follows());
  point_at({middle().x + 120, middle().y});
  EXPECT_EQ(at(), moved);
  desktop->document.undo();
  frames(2);
  EXPECT_LT((at() - before).norm(), 1e-12) << "one step";
}

TEST_F(ATransform, ByAKeyIsGivenUpByTheOtherButton) {
  const Vec3 before = at();
  point_at(middle());
  run("object.move");
  point_at({middle().x + 60, middle().y});
  EXPECT_GT((at() - before).norm(), 0.005);
  std::this_thread::sleep_for(2 * UndoHistory<int>::kPause);  // the next change is another step
  point_at({middle().x + 90, middle().y});
  show_mouse_button(1, true);
  frames(1);
  show_mouse_button(1, false);
  frames(2);
  EXPECT_FALSE(desktop->transform.follows());
  EXPECT_LT((at() - before).norm(), 1e-12);
  desktop->document.undo();
  frames(2);
  EXPECT_EQ(desktop->document.scene().objects.size(), place_) << "what was given up is no step";
}

}  // namespace
}  // namespace limpid
