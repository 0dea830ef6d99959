#include "app/desktop/scene/object_signs.h"

#include <cmath>
#include <numbers>

#include "app/style/theme.h"

namespace limpid {
namespace {

class Pen {
 public:
  Pen(const Camera& camera, ScreenRect view, ImDrawList& list)
      : camera_(camera), view_(view), list_(list) {}

  void line(const Vec3& from, const Vec3& to) {
    const auto a = camera_.project(from), b = camera_.project(to);
    if (!a || !b) return;
    const auto at = [&](const Eigen::Vector2d& p) {
      return ImVec2(view_.min.x + static_cast<float>(p.x()),
                    view_.min.y + static_cast<float>(p.y()));
    };
    list_.AddLine(at(*a), at(*b), colour(current_palette().accent), 1.6f * current_scale());
  }

  void circle(const Vec3& middle, const Vec3& u, const Vec3& v) {
    constexpr int kCorners = 64;
    Vec3 before = middle + u;
    for (int i = 1; i <= kCorners; ++i) {
      const double angle = 2 * std::numbers::pi * i / kCorners;
      const Vec3 next = middle + std::cos(angle) * u + std::sin(angle) * v;
      line(before, next);
      before = next;
    }
  }

 private:
  const Camera& camera_;
  ScreenRect view_;
  ImDrawList& list_;
};

void outline(const Plane& plane, const Pose& pose, const Camera&, Pen& pen) {
  const Vec3 u = plane.normal.unitOrthogonal();
  const Vec3 v = plane.normal.cross(u);
  pen.circle(pose.translation(), 0.03 * u, 0.03 * v);
  pen.line(pose.translation(), pose.translation() + 0.03 * plane.normal);
}

void outline(const Sphere& sphere, const Pose& pose, const Camera& camera, Pen& pen) {
  pen.circle(pose.translation(), sphere.radius * camera.right(), sphere.radius * camera.up());
}

void outline(const Box& box, const Pose& pose, const Camera&, Pen& pen) {
  const auto corner = [&](int i) {
    const Vec3 sign(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
    return Vec3(pose * sign.cwiseProduct(box.size));
  };
  for (int i = 0; i < 8; ++i) {
    for (const int bit : {1, 2, 4}) {
      if ((i & bit) == 0) pen.line(corner(i), corner(i | bit));
    }
  }
}

// Draws a tube, the common part of cylinder and capsule: two rings and four lines between them.
void outline_tube(double radius, double length, const Pose& pose, Pen& pen) {
  const Vec3 u = radius * pose.linear().col(0), v = radius * pose.linear().col(1);
  const Vec3 up = length / 2 * pose.linear().col(2), middle = pose.translation();
  pen.circle(middle + up, u, v);
  pen.circle(middle - up, u, v);
  for (const Vec3& side : {u, v, Vec3(-u), Vec3(-v)}) {
    pen.line(middle + side + up, middle + side - up);
  }
}

void outline(const Cylinder& cylinder, const Pose& pose, const Camera&, Pen& pen) {
  outline_tube(cylinder.radius, cylinder.length, pose, pen);
}

void outline(const Capsule& capsule, const Pose& pose, const Camera& camera, Pen& pen) {
  outline_tube(capsule.radius, capsule.length, pose, pen);
  for (const double end : {-0.5, 0.5}) {
    const Vec3 middle = pose.translation() + end * capsule.length * pose.linear().col(2);
    pen.circle(middle, capsule.radius * camera.right(), capsule.radius * camera.up());
  }
}

void outline(const Mesh&, const Pose&, const Camera&, Pen&) {}
void outline(const JointStop&, const Pose&, const Camera&, Pen&) {}

// Picture in a list, of half the width r around its middle.
struct Icon {
  ImDrawList* draw;
  ImVec2 middle;
  float r;
  ImU32 ink;
  float thick;
};

void icon(const Plane&, const Icon& i) {
  const auto [x, y] = i.middle;
  i.draw->AddLine({x - i.r, y + 0.5f * i.r}, {x + i.r, y + 0.5f * i.r}, i.ink, 1.6f * i.thick);
  i.draw->AddLine({x, y + 0.4f * i.r}, {x, y - i.r}, i.ink, i.thick);
}

void icon(const Sphere&, const Icon& i) { i.draw->AddCircle(i.middle, i.r, i.ink, 20, i.thick); }

void icon(const Box&, const Icon& i) {
  const auto [x, y] = i.middle;
  i.draw->AddRect({x - i.r, y - i.r}, {x + i.r, y + i.r}, i.ink, 0, 0, i.thick);
}

void icon(const Cylinder&, const Icon& i) {
  const auto [x, y] = i.middle;
  const float r = 0.75f * i.r;
  for (int corner = 0; corner < 16; ++corner) {
    const float angle = static_cast<float>(corner) * std::numbers::pi_v<float> / 8;
    i.draw->PathLineTo({x + r * std::cos(angle), y + (0.3f * std::sin(angle) - 0.7f) * i.r});
  }
  i.draw->PathStroke(i.ink, ImDrawFlags_Closed, i.thick);
  i.draw->AddLine({x - r, y - 0.7f * i.r}, {x - r, y + 0.7f * i.r}, i.ink, i.thick);
  i.draw->AddLine({x + r, y - 0.7f * i.r}, {x + r, y + 0.7f * i.r}, i.ink, i.thick);
  i.draw->AddLine({x - r, y + 0.7f * i.r}, {x + r, y + 0.7f * i.r}, i.ink, i.thick);
}

void icon(const Capsule&, const Icon& i) {
  const auto [x, y] = i.middle;
  const float r = 0.5f * i.r;
  i.draw->AddRect({x - r, y - i.r}, {x + r, y + i.r}, i.ink, r, 0, i.thick);
}

void icon(const Mesh&, const Icon& i) {
  const auto [x, y] = i.middle;
  const float r = i.r;
  i.draw->AddTriangle({x - r, y + r}, {x + r, y + r}, {x, y - r}, i.ink, i.thick);
  i.draw->AddTriangle({x - 0.5f * r, y}, {x + 0.5f * r, y}, {x, y + r}, i.ink, i.thick);
}

void icon(const JointStop&, const Icon& i) {
  const auto [x, y] = i.middle;
  i.draw->PathArcTo({x - i.r, y + i.r}, 1.8f * i.r, -1.57f, 0, 12);
  i.draw->PathStroke(i.ink, 0, i.thick);
}

const char* name(const Plane&) { return "plane"; }
const char* name(const Sphere&) { return "sphere"; }
const char* name(const Box&) { return "box"; }
const char* name(const Cylinder&) { return "cylinder"; }
const char* name(const Capsule&) { return "capsule"; }
const char* name(const Mesh&) { return "mesh"; }
const char* name(const JointStop&) { return "joint stop"; }

// Colour of a new object that is fixed, so that it is seen on a table.
const Vec3 kFixed(0.45, 0.55, 0.68);

// Returns a body that moves, of wood as a rule; hard enough to be pushed.
Object moving(const char* name, Shape shape, double mass) {
  return {.name = name,
          .shape = std::move(shape),
          .material = {.stiffness = 2000, .friction_static = 0.4, .friction_kinetic = 0.3},
          .body = Body{.mass = mass},
          .color = Vec3(0.80, 0.60, 0.38)};
}

}  // namespace

const char* shape_name(const Shape& shape) {
  return std::visit([](const auto& s) { return name(s); }, shape);
}

std::vector<NewObject> new_objects() {
  return {
      {"Ball", {.name = "ball", .shape = Sphere{.radius = 0.02}, .color = kFixed}},
      {"Block", {.name = "block", .shape = Box{.size = Vec3::Constant(0.04)}, .color = kFixed}},
      {"Cylinder",
       {.name = "cylinder", .shape = Cylinder{.radius = 0.02, .length = 0.04}, .color = kFixed}},
      {"Capsule",
       {.name = "capsule", .shape = Capsule{.radius = 0.01, .length = 0.04}, .color = kFixed}},
      {"Plane", {.name = "plane", .shape = Plane{}}},
      {"Joint stop",
       {.name = "stop",
        .shape = JointStop{.angle = 0.6},
        .material = {JointStop::kUsualStiffness}}},
      {"Ball that moves", moving("ball", Sphere{.radius = 0.02}, 0.02), true},
      {"Block that moves", moving("block", Box{.size = Vec3::Constant(0.03)}, 0.05)},
      {"Cylinder that moves", moving("roller", Cylinder{.radius = 0.015, .length = 0.03}, 0.02)},
      {"Capsule that moves", moving("pill", Capsule{.radius = 0.01, .length = 0.03}, 0.01)}};
}

void draw_icon(const Shape& shape, ImVec2 middle, float r, ImU32 ink) {
  const Icon each{ImGui::GetWindowDrawList(), middle, r, ink, 1.4f * current_scale()};
  std::visit([&](const auto& s) { icon(s, each); }, shape);
}

void draw_outline(const Object& object, const Camera& camera, ScreenRect view, ImDrawList& list) {
  list.PushClipRect(view.min, view.max, true);
  Pen pen(camera, view, list);
  std::visit([&](const auto& shape) { outline(shape, object.pose, camera, pen); }, object.shape);
  for (const BodyPart& part : object.parts) {
    const Pose pose = object.pose * part.pose;
    std::visit([&](const auto& shape) { outline(shape, pose, camera, pen); }, part.shape);
  }
  list.PopClipRect();
}

}  // namespace limpid
