#include "app/desktop/scene/body_editor.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "app/desktop/scene/scene_panel.h"
#include "app/desktop/widgets/modal.h"
#include "app/desktop/widgets/widgets.h"
#include "app/run/body_report.h"
#include "app/style/sliders.h"
#include "app/style/theme.h"
#include "core/touch/mass_properties.h"
#include "devices/files/scene/body_file.h"
#include "devices/files/scene/scene_fields.h"

namespace limpid {
namespace {

using Kind = BodyJoint::Kind;
using namespace scene_limits;

constexpr double kWood = 600;  // density of a new body [kg/m^3]
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Lets choose among the bodies that `allowed` takes, and the world with its empty name.
template <class Allowed>
bool choose_body(const char* label, std::string& name, const Scene& scene, const char* help,
                 Allowed allowed) {
  bool changed = false;
  caption(label, help);
  ImGui::PushID(label);
  if (ImGui::BeginCombo("##body", name.empty() ? "the world" : name.c_str())) {
    const auto choice = [&](const std::string& each, const char* shown) {
      if (!allowed(each) || !ImGui::Selectable(shown, each == name)) return;
      name = each;
      changed = true;
    };
    choice("", "the world");
    for (const Object& object : scene.objects) {
      if (object.body) choice(object.name, object.name.c_str());
    }
    ImGui::EndCombo();
  }
  ImGui::PopID();
  tooltip(help);
  return changed;
}

bool may_hang_on(const Scene& scene, std::size_t place, const std::string& name) {
  Scene tried = scene;
  Object& object = tried.objects[place];
  if (!object.body) object.body = Body{};
  if (!object.body->joint) object.body->joint = BodyJoint{};
  object.body->joint->to = name;
  return !joint_leads_round(tried, place);
}

bool choose_kind(Body& body) {
  constexpr const char* kKinds = "nothing, it is free\0a slider\0a hinge\0a ball joint\0";
  int kind = body.joint ? 1 + static_cast<int>(body.joint->kind) : 0;
  caption(kJointFields[0].caption, kJointFields[0].meaning);
  if (!ImGui::Combo("##kind", &kind, kKinds)) return false;
  if (kind == 0) {
    body.joint.reset();
    return true;
  }
  BodyJoint joint = body.joint.value_or(BodyJoint{});
  if (static_cast<int>(joint.kind) != kind - 1) {
    // Values along the joint begin anew, as metres are no radians.
    BodyJoint fresh;
    fresh.to = joint.to;
    fresh.axis = joint.axis;
    fresh.point = joint.point;
    joint = fresh;
  }
  joint.kind = static_cast<Kind>(kind - 1);
  body.joint = joint;
  return true;
}

std::string_view edit_limits(BodyJoint& joint) {
  std::string_view what;
  bool limited = std::isfinite(joint.low) || std::isfinite(joint.high);
  if (ImGui::Checkbox("has stops", &limited)) {
    const double room = turns(joint) ? 0.5 : 0.01;
    joint.low = limited ? -room : -kInfinity;
    joint.high = limited ? room : kInfinity;
    what = "stops";
  }
  tooltip("Limits of the joint's motion on both sides. 0 is the joint's position at the start.");
  if (!limited) return what;
  constexpr double kApart = 1e-4;  // least distance of the stops [m or rad]
  const double far = 100;
  double low = std::max(joint.low, -far), high = std::min(joint.high, far);
  const FieldInfo from{{-far, high - kApart, false, kTravel.unit},
                       "from",
                       "From",
                       "From",
                       "The end stop in the negative direction of the axis."};
  const FieldInfo to{{low + kApart, far, false, kTravel.unit},
                     "to",
                     "To",
                     "To",
                     "The end stop in the positive direction of the axis."};
  if (edit_value(from, low, 0, turns(joint))) {
    joint.low = low;
    what = from.key;
  }
  if (edit_value(to, high, 0, turns(joint))) {
    joint.high = high;
    what = to.key;
  }
  const auto stops = edit_fields(kStopFields, joint, turns(joint));
  return stops.empty() ? what : stops;
}

std::string_view edit_force(JointForce& force, bool turns) {
  std::string_view what = edit_fields(kForceFields, force, turns);
  if (const auto detent = edit_fields(kDetentFields, force, turns); !detent.empty()) what = detent;
  if (!force.travel.empty()) {
    read_out("force against displacement", fmt::format("{} points", force.travel.size()), {},
             "The scene's file sets these points. This force is added to the forces of spring and "
             "detent.");
  }
  return what;
}

std::string_view edit_joint(Body& body, const Scene& scene, std::size_t place) {
  std::string_view what;
  if (choose_kind(body)) what = "joint";
  if (!body.joint) return what;
  BodyJoint& joint = *body.joint;
  if (choose_body(kJointFields[1].caption, joint.to, scene, kJointFields[1].meaning,
                  [&](const std::string& name) { return may_hang_on(scene, place, name); })) {
    what = "to";
  }
  if (has_axis(joint) && drag3("Axis x, y, z", joint.axis, 0.01, -1, 1, "%.3f",
                               "The object slides along this axis or turns about this axis. The "
                               "axis is given in the world's directions, as it is at the start.")) {
    what = "axis";
  }
  Vec3 point = 1e3 * joint.point;
  if (turns(joint) &&
      drag3("Joint at x, y, z [mm]", point, 0.25, 1e3 * kPosition.minimum, 1e3 * kPosition.maximum,
            "%.1f", "Measured from the object's middle, along the object's axes.")) {
    joint.point = 1e-3 * point;
    what = "point";
  }
  const auto take = [&](std::string_view key) {
    if (!key.empty()) what = key;
  };
  take(edit_fields(kJointFields, joint, turns(joint)));
  if (!has_axis(joint)) return what;
  take(edit_limits(joint));
  take(edit_force(joint.force, turns(joint)));
  return what;
}

bool edit_spring(BodySpring& spring, const Scene& scene, std::string_view& what) {
  const auto body = [](const std::string& name) { return !name.empty(); };
  if (choose_body(
          "From", spring.between[0], scene, "The object at the first end of the spring.",
          [&](const std::string& name) { return body(name) && name != spring.between[1]; })) {
    what = "from";
  }
  if (choose_body("To", spring.between[1], scene,
                  "The object, or the world, at the second end of the spring.",
                  [&](const std::string& name) { return name != spring.between[0]; })) {
    what = "to";
  }
  constexpr std::array kEnds{"Second end x, y, z [mm]", "First end x, y, z [mm]"};
  for (std::size_t i = 0; i < 2; ++i) {
    Vec3 point = 1e3 * spring.points[i];
    if (drag3(kEnds[1 - i], point, 0.25, 1e3 * kPosition.minimum, 1e3 * kPosition.maximum, "%.1f",
              i == 0 ? "Place of the spring on the first object, from that object's middle, along "
                       "that object's axes."
                     : "Place of the spring on the second object, from that object's middle. In "
                       "the world: from the arm's base.")) {
      spring.points[i] = 1e-3 * point;
      what = i == 0 ? "first point" : "second point";
    }
  }
  if (const auto key = edit_fields(kSpringFields, spring); !key.empty()) what = key;
  return !what.empty();
}

void draw_spring(Document& document, std::size_t place) {
  BodySpring spring = document.scene().springs[place];
  const std::string& to = spring.between[1];
  const std::string label =
      fmt::format("{} to {}##spring{}", spring.between[0], to.empty() ? "the world" : to, place);
  ImGui::PushID(static_cast<int>(place));
  if (ImGui::TreeNode("##spring", "%s", label.substr(0, label.find("##")).c_str())) {
    std::string_view what;
    const bool changed = edit_spring(spring, document.scene(), what);
    const bool remove = ImGui::Button("Remove spring", {-1, 0});
    tooltip("Ctrl+Z brings the spring back.");
    if (remove) {
      if (document.may_edit()) document.editor().remove_spring(place);
    } else if (changed && document.may_edit()) {
      document.editor().set_spring(place, spring, std::string(what));
    }
    ImGui::TreePop();
  }
  ImGui::PopID();
}

// Returns a spring from the selected body, else the first one, to its place in the world.
BodySpring new_spring(const SceneEditor& editor) {
  const Object* body = editor.selected_object();
  if (body == nullptr || !body->body) {
    body = &*std::ranges::find_if(editor.scene().objects,
                                  [](const Object& object) { return object.body.has_value(); });
  }
  return {.between = {body->name, ""}, .points = {Vec3::Zero(), body->pose.translation()}};
}

bool noted_checkbox(const char* label, bool& on) {
  const bool changed = ImGui::Checkbox(label, &on);
  note_place(label);
  return changed;
}

// Edits centre of mass and inertia, where they are not those of a solid.
std::string_view edit_moments(Object& object) {
  std::string_view what;
  Body& body = *object.body;
  bool own = body.center.has_value();
  if (noted_checkbox("a centre of mass of its own", own)) {
    body.center = own ? std::optional(mass_properties(object).center) : std::nullopt;
    what = "own center";
  }
  tooltip("Off: the object has the centre of mass of a solid with the same shape and parts.");
  if (body.center) {
    Vec3 center = 1e3 * *body.center;
    if (drag3("Centre of mass x, y, z [mm]", center, 0.1, 1e3 * kPosition.minimum,
              1e3 * kPosition.maximum, "%.2f",
              "Measured from the object's middle, along the object's axes.")) {
      body.center = 1e-3 * center;
      what = "center";
    }
  }
  own = body.inertia.has_value();
  if (noted_checkbox("moments of inertia of its own", own)) {
    body.inertia =
        own ? std::optional<Vec3>(mass_properties(object).inertia.diagonal()) : std::nullopt;
    what = "own inertia";
  }
  tooltip("Off: the object has the moments of inertia of a solid with the same shape and parts.");
  if (!body.inertia) return what;
  constexpr double kShown = 1e7;  // g cm^2 in a kg m^2
  Vec3 shown = kShown * *body.inertia;
  const double pace = std::max(1e-4, 0.005 * shown.maxCoeff());
  if (drag3("Inertia about x, y, z [g cm\xC2\xB2]", shown, pace, 1e-4, kShown * kInertia.maximum,
            "%.5g", "About axes through the centre of mass, parallel to the object's axes.")) {
    body.inertia = shown / kShown;
    what = "inertia";
  }
  if (!possible_inertia(*body.inertia)) {
    read_out("inertia", "no body has this inertia",
             "None of the three moments of inertia may be more than the sum of the other two.");
  }
  return what;
}

}  // namespace

std::string edit_body(Object& object, const Scene& scene, std::size_t place) {
  if (has_shape<Plane>(object) || has_shape<JointStop>(object)) return {};
  std::string what;
  bool moves = object.body.has_value();
  if (ImGui::Checkbox("moves", &moves)) {
    object.body.reset();
    if (moves) object.body = Body{.mass = kMass.hold(kWood * volume(object), Body{}.mass)};
    return "moves";
  }
  tooltip("The object can be pushed, and falls. At first the object has the mass of wood.");
  if (!moves) return what;
  Body& body = *object.body;
  what = edit_fields(std::array{kBodyMass}, body);
  if (const auto key = edit_fields(kBodyFields, body); !key.empty()) what = key;
  if (const auto moments = edit_moments(object); !moments.empty()) what = moments;
  if (const auto joint = edit_joint(body, scene, place); !joint.empty()) {
    what = "joint " + std::string(joint);  // a body has a key "stiffness" too
  }
  return what;
}

void draw_springs(Document& document) {
  if (count_bodies(document.scene()) == 0) return;
  Vec3 gravity = document.scene().gravity;
  if (drag3("Gravity x, y, z [m/s\xC2\xB2]", gravity, 0.05, kGravity.minimum, kGravity.maximum,
            "%.2f",
            "Gravity on everything that moves: on Earth 9.81, on the Moon 1.62, downwards.") &&
      document.may_edit()) {
    document.editor().set_gravity(gravity);
  }
  heading("Springs");
  for (std::size_t i = 0; i < document.scene().springs.size(); ++i) draw_spring(document, i);
  if (ImGui::Button("Add spring", {-1, 0}) && document.may_edit()) {
    document.add_spring(new_spring(document.editor()));
  }
  tooltip("Adds a spring that pulls the selected object back to the place where it is now.");
}

}  // namespace limpid
