// Names, icons and outlines of objects, and objects that can be added.
#include "app/desktop/scene/object_signs.h"

#include <cmath>
#include <numbers>
#include <set>

#include "app/desktop/scene/scene_editor.h"
#include "app/style/palette.h"
#include "app/style/theme.h"
#include "tests/app/plot/imgui_frames.h"
#include "tests/support/drawn_ink.h"

namespace limpid {
namespace {

TEST(NewObjects, AreOneOfEachShapeAndFourThatMove) {
  std::set<std::string> labels, fixed;
  int moving = 0, first = 0;
  for (const NewObject& each : new_objects()) {
    EXPECT_TRUE(labels.insert(each.label).second) << each.label;
    EXPECT_FALSE(each.object.name.empty());
    first += each.first_that_moves;
    if (each.object.body) {
      ++moving;
      EXPECT_GT(each.object.body->mass, 0);
      EXPECT_GT(each.object.material.friction_static, each.object.material.friction_kinetic);
      EXPECT_NE(std::string(each.label).find("that moves"), std::string::npos);
    } else {
      fixed.insert(shape_name(each.object.shape));
      EXPECT_EQ(moving, 0) << "those that move come last";
    }
  }
  EXPECT_EQ(fixed,
            (std::set<std::string>{"sphere", "box", "cylinder", "capsule", "plane", "joint stop"}));
  EXPECT_EQ(moving, 4);
  EXPECT_EQ(first, 1);
  EXPECT_STREQ(shape_name(Mesh{}), "mesh");
}

// All vertices of a colour in the last frame.
std::vector<ImVec2> strokes(ImU32 wanted) {
  std::vector<ImVec2> all;
  const ImDrawData& data = *ImGui::GetDrawData();
  for (int n = 0; n < data.CmdListsCount; ++n) {
    for (const ImDrawVert& v : data.CmdLists[n]->VtxBuffer) {
      if (v.col == wanted) all.push_back(v.pos);
    }
  }
  return all;
}
ScreenRect box_of(const std::vector<ImVec2>& points) {
  ScreenRect box{{1e9f, 1e9f}, {-1e9f, -1e9f}};
  for (const ImVec2& p : points) {
    box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y)};
    box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y)};
  }
  return box;
}

class SignsOfObjects : public ImGuiFrames {
 protected:
  SignsOfObjects() {
    apply_theme(Theme::dark, 1);
    frame([] {});
    camera_.resize(400, 300);
    camera_.look(Camera::View::side);
    camera_.frame(Bounds(Vec3(-0.2, -0.1, -0.15), Vec3(0.2, 0.1, 0.15)));
    camera_.finish();
  }
  std::vector<ImVec2> outline(const Object& object) {
    frame([&] { draw_outline(object, camera_, view_, *ImGui::GetBackgroundDrawList()); });
    return strokes(colour(current_palette().accent));
  }
  ImVec2 seen(const Vec3& point) const {
    const Eigen::Vector2d p = *camera_.project(point);
    return {view_.min.x + static_cast<float>(p.x()), view_.min.y + static_cast<float>(p.y())};
  }
  // Expects the outline to reach from one place of the world to another one, by a few pixels.
  void expect_reach(const Object& object, const Vec3& half) {
    const ScreenRect box = box_of(outline(object));
    const Vec3 at = object.pose.translation();
    const ImVec2 low = seen(at + Vec3(-half.x(), 0, -half.z())),
                 high = seen(at + Vec3(half.x(), 0, half.z()));
    const std::string name = shape_name(object.shape);
    EXPECT_NEAR(box.min.x, low.x, 4) << name;
    EXPECT_NEAR(box.max.x, high.x, 4) << name;
    EXPECT_NEAR(box.min.y, high.y, 4) << name;
    EXPECT_NEAR(box.max.y, low.y, 4) << name;
  }
  Camera camera_;
  const ScreenRect view_{{50, 20}, {450, 320}};
};

TEST_F(SignsOfObjects, OutlineEachShapeWhereItIs) {
  const Pose place = pose_at(Vec3(0.05, 0, 0.02));
  expect_reach({.pose = place, .shape = Sphere{0.05}}, Vec3::Constant(0.05));
  expect_reach({.pose = place, .shape = Box{{0.1, 0.02, 0.06}}}, {0.05, 0, 0.03});
  expect_reach({.pose = place, .shape = Cylinder{0.03, 0.1}}, {0.03, 0, 0.05});
  expect_reach({.pose = place, .shape = Capsule{0.03, 0.08}}, {0.03, 0, 0.07});
  for (const Shape& shape : {Shape{Mesh{}}, Shape{JointStop{}}}) {
    EXPECT_TRUE(outline({.pose = place, .shape = shape}).empty()) << shape_name(shape);
  }
}

TEST_F(SignsOfObjects, OutlineABallByARingThatIsEmpty) {
  outline({.shape = Sphere{0.03}});
  const ImU32 ink = colour(current_palette().accent);
  const auto inked = [&](double part, double angle) {
    const Vec3 at = 0.03 * part * Vec3(std::cos(angle), 0, std::sin(angle));
    const ImVec2 place = seen(at);  // ImGui's lines go through the middle of pixels
    return test::inked({place.x + 0.5f, place.y + 0.5f}, [=](ImU32 rgba) { return rgba == ink; });
  };
  int rim = 0;
  for (double angle = 0; angle < 6.2; angle += 0.05) {
    rim += inked(1, angle);
    for (const double part : {0.4, 0.55, 0.7, 0.85}) {
      EXPECT_FALSE(inked(part, angle)) << part << " " << angle;
    }
  }
  EXPECT_GT(rim, 115) << "of 125 places on it";
}

TEST_F(SignsOfObjects, OutlineAPlaneByARingAndItsNormal) {
  const Object plane{.shape = Plane{Vec3::UnitX()}};
  const ScreenRect box = box_of(outline(plane));
  EXPECT_NEAR(box.max.x, seen(Vec3(0.03, 0, 0)).x, 4) << "along the normal";
  EXPECT_NEAR(box.min.x, seen(Vec3::Zero()).x, 4) << "the ring is seen from its edge";
  EXPECT_NEAR(box.min.y, seen(Vec3(0, 0, 0.03)).y, 4);
  EXPECT_NEAR(box.max.y, seen(Vec3(0, 0, -0.03)).y, 4);
}

TEST_F(SignsOfObjects, OutlineTheirPartsWithTheirPose) {
  Object object{.pose = pose_at(Vec3(-0.05, 0, 0)), .shape = Sphere{0.01}};
  object.parts = {{pose_at(Vec3(0.1, 0, 0)), Sphere{0.02}}};
  const ScreenRect box = box_of(outline(object));
  EXPECT_NEAR(box.min.x, seen(Vec3(-0.06, 0, 0)).x, 4);
  EXPECT_NEAR(box.max.x, seen(Vec3(0.07, 0, 0)).x, 4);
  object.pose.linear() = Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitY()).toRotationMatrix();
  const ScreenRect turned = box_of(outline(object));
  EXPECT_NEAR(turned.max.y, seen(Vec3(0, 0, -0.12)).y, 4) << "x points down";
}

TEST_F(SignsOfObjects, OutlineNothingBehindTheEye) {
  const Object behind{.pose = pose_at(camera_.eye() - 0.5 * camera_.forward()),
                      .shape = Box{Vec3::Constant(0.1)}};
  EXPECT_TRUE(outline(behind).empty());
}

TEST_F(SignsOfObjects, HaveIconsOfTheirShapesWithinTheirRoom) {
  constexpr ImU32 kInk = IM_COL32(1, 2, 3, 255);
  const ImVec2 middle{100, 80};
  constexpr float kHalf = 10;
  const auto icon = [&](const Shape& shape) {
    frame([&] {
      ImGui::SetNextWindowPos({0, 0});
      ImGui::SetNextWindowSize({300, 300});
      ImGui::Begin("icons");
      draw_icon(shape, middle, kHalf, kInk);
      ImGui::End();
    });
    return strokes(kInk);
  };
  std::set<std::string> pictures;
  for (const Shape& shape : {Shape{Plane{}}, Shape{Sphere{}}, Shape{Box{}}, Shape{Cylinder{}},
                             Shape{Capsule{}}, Shape{Mesh{}}, Shape{JointStop{}}}) {
    const auto points = icon(shape);
    const std::string name = shape_name(shape);
    ASSERT_FALSE(points.empty()) << name;
    const ScreenRect box = box_of(points);
    const float room = kHalf + 3;
    EXPECT_GE(box.min.x, middle.x - room) << name;
    EXPECT_LE(box.max.x, middle.x + room) << name;
    EXPECT_GE(box.min.y, middle.y - room) << name;
    EXPECT_LE(box.max.y, middle.y + room) << name;
    EXPECT_GT(box.width(), 0.8f * kHalf) << name;
    EXPECT_GT(box.height(), 1.2f * kHalf) << name;
    std::string picture;
    for (const ImVec2& p : points) picture += fmt::format("{:.1f} {:.1f},", p.x, p.y);
    EXPECT_TRUE(pictures.insert(picture).second) << name << " looks like another shape";
  }
  // Upright shapes are as wide to the left as to the right.
  for (const Shape& shape : {Shape{Plane{}}, Shape{Sphere{}}, Shape{Box{}}, Shape{Cylinder{}},
                             Shape{Capsule{}}, Shape{Mesh{}}}) {
    const ScreenRect box = box_of(icon(shape));
    EXPECT_NEAR(middle.x - box.min.x, box.max.x - middle.x, 1.5) << shape_name(shape);
  }
}

// Objects that can be added fit into a hand, and those that move weigh no more than it lifts.
TEST(NewObjects, HaveTheSizesOfThingsForAHand) {
  for (const NewObject& each : new_objects()) {
    const Bounds box = bounds_of(each.object, nullptr);
    if (box.isEmpty()) continue;
    EXPECT_GE(box.sizes().minCoeff(), 0.02) << each.label;
    EXPECT_LE(box.sizes().maxCoeff(), 0.08) << each.label;
    EXPECT_TRUE(each.object.color) << each.label << " is seen on a table";
    if (!each.object.body) continue;
    EXPECT_GE(each.object.body->mass, 0.01) << each.label;
    EXPECT_LE(each.object.body->mass, 0.05) << each.label;
    EXPECT_EQ(each.object.material.stiffness, 2000) << each.label << ": hard enough to be pushed";
  }
}

// A box has twelve edges, between the corners of its pose.
TEST_F(SignsOfObjects, OutlineAllEdgesOfABox) {
  Object box{.pose = pose_at(Vec3(0.03, 0.02, 0.01)), .shape = Box{{0.12, 0.06, 0.08}}};
  box.pose.linear() =
      (Eigen::AngleAxisd(0.4, Vec3::UnitX()) * Eigen::AngleAxisd(0.5, Vec3::UnitZ()))
          .toRotationMatrix();
  outline(box);
  const auto inked = [&](const Vec3& at) {
    const ImVec2 place = seen(box.pose * at);
    for (float x = -0.6f; x < 1.7f; x += 0.2f) {
      for (float y = -0.6f; y < 1.7f; y += 0.2f) {
        if (test::inked({place.x + x, place.y + y},
                        [](ImU32 ink) { return ink == colour(current_palette().accent); })) {
          return true;
        }
      }
    }
    return false;
  };
  const Vec3 half(0.06, 0.03, 0.04);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double a : {-1.0, 1.0}) {
      for (const double b : {-1.0, 1.0}) {
        for (const double part : {-0.7, 0.0, 0.7}) {
          Vec3 at;
          at[axis] = part;
          at[(axis + 1) % 3] = a;
          at[(axis + 2) % 3] = b;
          EXPECT_TRUE(inked(at.cwiseProduct(half)))
              << axis << ", " << a << ", " << b << ", " << part;
        }
      }
    }
  }
}

// A tube has two rings and four lines between them; a capsule has balls at its ends.
TEST_F(SignsOfObjects, OutlineTubesByRingsAndLines) {
  const Pose upright = pose_at(Vec3(0.02, 0, 0.01));
  const auto inked = [&](const Vec3& at) {
    const ImVec2 place = seen(upright * at);
    for (float x = -0.6f; x < 1.7f; x += 0.2f) {
      for (float y = -0.6f; y < 1.7f; y += 0.2f) {
        if (test::inked({place.x + x, place.y + y},
                        [](ImU32 ink) { return ink == colour(current_palette().accent); })) {
          return true;
        }
      }
    }
    return false;
  };
  for (const bool capsule : {false, true}) {
    outline({.pose = upright,
             .shape = capsule ? Shape{Capsule{0.03, 0.1}} : Shape{Cylinder{0.03, 0.1}}});
    for (const double z : {-0.04, 0.0, 0.04}) {
      for (const Vec3& side : {Vec3(0.03, 0, z), Vec3(-0.03, 0, z), Vec3(0, 0.03, z)}) {
        EXPECT_TRUE(inked(side)) << capsule << ": a line at " << side.transpose();
      }
      EXPECT_FALSE(inked({0.015, 0.026, z})) << capsule << ": no line at " << z;
    }
    for (const double end : {-0.05, 0.05}) {
      EXPECT_TRUE(inked({0.03 * std::cos(1.0), 0.03 * std::sin(1.0), end})) << "a ring";
      EXPECT_EQ(inked({0, 0, 1.6 * end}), capsule) << "a ball's rim";
    }
  }
}

}  // namespace
}  // namespace limpid
