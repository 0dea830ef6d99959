// Fields of a body, drawn frame by frame, clicked on and typed into.
#include "app/desktop/scene/body_editor.h"

#include "app/desktop/scene/parts_editor.h"
#include "app/desktop/widgets/modal.h"
#include "tests/app/plot/imgui_frames.h"
#include "tests/support/drawn_text.h"

namespace limpid {
namespace {

class BodyFields : public ImGuiFrames {
 protected:
  BodyFields() {
    object_.name = "die";
    object_.shape = Box{Vec3::Constant(0.03)};
    object_.body = Body{};
    scene_.add(object_);
  }

  void frames(int count = 4) {
    for (int i = 0; i < count; ++i) {
      frame([&] {
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({400, 1200});
        ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoMove);
        const std::string body(edit_body(object_, scene_, 0)),
            part = parts_.edit(object_), own = edit_color(object_.color, "") ? "color" : "";
        for (const std::string& what : {body, part, own}) {
          if (!what.empty()) changed_.push_back(what);
        }
        ImGui::End();
      });
    }
  }
  void click(const char* label, int times = 1) {
    frames();
    const auto place = noted_place("panel", label);
    ASSERT_TRUE(place) << label;
    show_mouse(*place);
    frames(1);
    for (int i = 0; i < times; ++i) {
      show_mouse_button(0, true);
      frames(1);
      show_mouse_button(0, false);
      frames(1);
    }
    frames();
  }
  // Types into the middle one of three fields, or the only one.
  void type(const char* label, const char* text) {
    click(label, 2);
    ImGui::GetIO().AddInputCharactersUTF8(text);
    frames();
    for (const bool down : {true, false}) {
      show_key(GLFW_KEY_ENTER, down);
      frames();
    }
  }

  // Counts the fields for the red of a colour.
  int red_fields() {
    frames();
    int count = 0;
    for (const test::DrawnText& each : test::drawn_texts()) count += each.text.starts_with("R:");
    return count;
  }

  Object object_;
  Scene scene_;
  PartsEditor parts_;
  std::vector<std::string> changed_;
};

TEST_F(BodyFields, AddChangeAndRemoveParts) {
  ImGui::GetIO().DisplaySize = {800, 1200};
  click("Add part");
  click("Add part");
  ASSERT_EQ(object_.parts.size(), 2u);
  EXPECT_EQ(changed_, (std::vector<std::string>{"part 1 added", "part 2 added"}));
  EXPECT_TRUE(std::holds_alternative<Sphere>(object_.parts[1].shape));
  click("part 2");  // opens it
  type("Position x, y, z [mm]", "12.5");
  EXPECT_EQ(object_.parts[1].pose.translation(), Vec3(0, 0.0125, 0));
  EXPECT_EQ(changed_.back(), "part 2 place");
  type("Radius", "7");
  EXPECT_NEAR(std::get<Sphere>(object_.parts[1].shape).radius, 0.007, 1e-12);
  type("Radius", "1e9");  // no file may hold it
  EXPECT_NEAR(std::get<Sphere>(object_.parts[1].shape).radius, 0.007, 1e-12);
  type("Rotation roll, pitch, yaw [\xC2\xB0]", "90");
  EXPECT_NEAR(object_.parts[1].pose.linear()(2, 0), -1, 1e-12);
  EXPECT_EQ(object_.parts[0].pose.translation(), Vec3(Vec3::Zero()));
  click("Remove part");
  ASSERT_EQ(object_.parts.size(), 1u);
  EXPECT_EQ(changed_.back(), "part 2 of 2 removed");
}

TEST_F(BodyFields, BeginWithTheMomentsOfASolidAndTakeOthers) {
  ImGui::GetIO().DisplaySize = {800, 1200};
  click("a centre of mass of its own");
  ASSERT_TRUE(object_.body->center);
  EXPECT_LT(object_.body->center->norm(), 1e-15);
  type("Centre of mass x, y, z [mm]", "-3");
  EXPECT_NEAR(object_.body->center->y(), -0.003, 1e-15);
  EXPECT_EQ(changed_.back(), "center");
  click("moments of inertia of its own");
  ASSERT_TRUE(object_.body->inertia);
  const double solid = 0.05 / 6 * 9e-4;
  EXPECT_NEAR(object_.body->inertia->x(), solid, 1e-12);
  type("Inertia about x, y, z [g cm\xC2\xB2]", "90");
  EXPECT_NEAR(object_.body->inertia->y(), 9e-6, 1e-15);
  EXPECT_NEAR(object_.body->inertia->x(), solid, 1e-12);
  click("moments of inertia of its own");
  click("a centre of mass of its own");
  EXPECT_FALSE(object_.body->inertia);
  EXPECT_FALSE(object_.body->center);
}

TEST_F(BodyFields, GiveAColourAndTakeItAway) {
  ImGui::GetIO().DisplaySize = {800, 1200};
  EXPECT_EQ(red_fields(), 0);
  click("a colour of its own");
  ASSERT_TRUE(object_.color);
  EXPECT_EQ(changed_.back(), "color");
  EXPECT_EQ(red_fields(), 1);
  click("a colour of its own");
  EXPECT_FALSE(object_.color);
  EXPECT_EQ(red_fields(), 0);
  EXPECT_EQ(changed_.size(), 2u) << "drawing changes nothing";
}

}  // namespace
}  // namespace limpid
