// Editor of one object of every shape, drawn frame by frame and typed into.
#include "app/desktop/scene/scene_panel.h"

#include <numbers>

#include "app/desktop/widgets/modal.h"
#include "tests/app/plot/imgui_frames.h"
#include "tests/support/built_in.h"

namespace limpid {
namespace {

class ObjectFields : public ImGuiFrames {
 protected:
  ObjectFields() { ImGui::GetIO().DisplaySize = {800, 1600}; }

  void edit(Object object) {
    SceneDocument scene;
    object.name = "it";
    scene.scene.add(std::move(object));
    document_.open(arm_, std::move(scene), MeshModels(1), true);
    document_.editor().select(0);
    frames();
  }
  void frames(int count = 4) {
    for (int i = 0; i < count; ++i) {
      frame([&] {
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({400, 1600});
        ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoMove);
        panel_.draw(
            document_, arm_, false, [](std::string_view) {}, [](const Object&) {});
        ImGui::End();
      });
      document_.note_changes();
    }
  }
  void type(const char* label, const char* text) {
    frames();
    const auto place = noted_place("panel", label);
    ASSERT_TRUE(place) << label;
    show_mouse(*place);
    frames(1);
    for (int i = 0; i < 2; ++i) {
      show_mouse_button(0, true);
      frames(1);
      show_mouse_button(0, false);
      frames(1);
    }
    frames();
    ImGui::GetIO().AddInputCharactersUTF8(text);
    frames();
    for (const bool down : {true, false}) {
      show_key(GLFW_KEY_ENTER, down);
      frames();
    }
  }
  const Object& object() const { return document_.scene().objects.front(); }

  ArmDescription arm_ = test::omni();
  Settings settings_;
  Notices notices_;
  Document document_{settings_, notices_, [] { return std::string(); }};
  ScenePanel panel_;
};

// A panel that is only looked at changes nothing, whatever it shows.
TEST_F(ObjectFields, OfEveryShapeChangeNothingByThemselves) {
  for (const Shape& shape :
       {Shape(Plane{}), Shape(Sphere{0.02}), Shape(Box{{0.02, 0.03, 0.04}}),
        Shape(Cylinder{0.01, 0.05}), Shape(Capsule{0.01, 0.05}), Shape(JointStop{1, 0.7, -1})}) {
    Object one;
    one.shape = shape;
    one.pose = pose_at({0.1, 0.02, 0.03});
    edit(one);
    frames();
    EXPECT_FALSE(document_.editor().dirty()) << shape.index();
    EXPECT_EQ(object().shape, shape) << shape.index();
  }
}

TEST_F(ObjectFields, OfAStopTurnIt) {
  Object stop;
  stop.shape = JointStop{1, 0.7, -1};
  edit(stop);
  type("Angle", "-30");
  const auto& now = std::get<JointStop>(object().shape);
  EXPECT_NEAR(now.angle, -std::numbers::pi / 6, 1e-12);
  EXPECT_EQ(now.joint, 1);
  EXPECT_EQ(now.direction, -1);
  document_.undo();
  EXPECT_EQ(std::get<JointStop>(object().shape).angle, 0.7);
}

TEST_F(ObjectFields, OfAPlaneMoveAPointOfIt) {
  Object plane;
  plane.shape = Plane{};
  edit(plane);
  type("Point on it x, y, z [mm]", "12");
  EXPECT_EQ(object().pose.translation(), Vec3(0, 0.012, 0));
}

TEST_F(ObjectFields, OfABallMoveItsCentreAndSize) {
  Object ball;
  ball.shape = Sphere{0.02};
  edit(ball);
  type("Centre x, y, z [mm]", "-5");
  type("Radius", "7");
  EXPECT_EQ(object().pose.translation(), Vec3(0, -0.005, 0));
  EXPECT_NEAR(std::get<Sphere>(object().shape).radius, 0.007, 1e-12);
}

}  // namespace
}  // namespace limpid
