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

namespace limpid {
namespace {

using Kind = BodyJoint::Kind;
using namespace scene_limits;

constexpr double kWood = 600;  // density of a new body [kg/m^3]
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Units in which numbers along a joint are shown: mm for slides, degrees for turns.
struct JointUnit {
  double of_one;  // shown number for one m or rad
  const char* format;
  const char* force;
  const char* stiffness;
  const char* damping;
};
JointUnit unit_of(Kind kind) {
  if (kind == Kind::slider) return {1e3, "%.2f mm", "%.3g N", "%.6g N/m", "%.4g N s/m"};
  return {180 / std::numbers::pi, "%.1f\xC2\xB0", "%.3g N m", "%.6g N m/rad", "%.4g N m s/rad"};
}

// Returns a drag's step as a part of the value.
double pace(double value, double least) { return std::max(least, 0.005 * std::abs(value)); }

bool drag_scaled(const char* label, double& value, double per_one, const Range& range,
                 const char* format, const char* help) {
  double shown = per_one * value;
  const double least = range.exclusive_minimum ? 1e-6 : range.minimum;
  if (!drag_number(label, shown, pace(shown, 0.01), per_one * least,
                   per_one * std::min(range.maximum, 1e9), format, help)) {
    return false;
  }
  value = shown / per_one;
  return true;
}

bool share_slider(const char* label, double& value, const char* help) {
  const ParameterInfo info{.key = label,
                           .label = label,
                           .field = &Parameters::eta,
                           .unit = "-",
                           .minimum = 0,
                           .maximum = 1,
                           .slider_minimum = 0,
                           .slider_maximum = 1,
                           .logarithmic = false,
                           .live = true,
                           .meaning = ""};
  const bool changed = value_slider(info, value, 0);
  tooltip(help);
  return changed;
}

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
  caption("Hangs on", "A slider moves along a line, a hinge turns, a ball joint turns any way.");
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

std::string_view edit_limits(BodyJoint& joint, const JointUnit& unit) {
  std::string_view what;
  bool limited = std::isfinite(joint.low) || std::isfinite(joint.high);
  if (ImGui::Checkbox("has stops", &limited)) {
    const double room = joint.kind == Kind::slider ? 0.01 : 0.5;
    joint.low = limited ? -room : -kInfinity;
    joint.high = limited ? room : kInfinity;
    what = "stops";
  }
  tooltip("Where its way ends on both sides; 0 is where it starts.");
  if (!limited) return what;
  constexpr double kLeast = 1e-4;  // distance of the stops [m or rad]
  const double far = 100;
  double low = std::max(joint.low, -far), high = std::min(joint.high, far);
  if (drag_scaled("From", low, unit.of_one, {-far, high - kLeast}, unit.format,
                  "The stop on the side against the axis.")) {
    joint.low = low;
    what = "from";
  }
  if (drag_scaled("To", high, unit.of_one, {low + kLeast, far}, unit.format,
                  "The stop on the side of the axis.")) {
    joint.high = high;
    what = "to";
  }
  if (drag_scaled("Stops' stiffness", joint.stop_stiffness, 1, kStiffness, unit.stiffness,
                  "How hard a stop pushes back.")) {
    what = "stop stiffness";
  }
  if (share_slider("Stops' bounce", joint.stop_restitution,
                   "The part of its speed that it keeps when it hits a stop.")) {
    what = "stop restitution";
  }
  return what;
}

std::string_view edit_force(JointForce& force, const JointUnit& unit) {
  std::string_view what;
  if (drag_scaled("Spring", force.spring, 1, kJointSpring, unit.stiffness,
                  "Pulls it towards its place of rest.")) {
    what = "spring";
  }
  if (drag_scaled("Rest", force.rest, unit.of_one, kTravel, unit.format,
                  "Where the spring pulls nothing; 0 is where it starts.")) {
    what = "rest";
  }
  if (drag_scaled("Detent", force.detent_force, 1, kJointForce, unit.force,
                  "The largest force of steps that it clicks into; 0: it does not click.")) {
    what = "detent";
  }
  if (drag_scaled("Detent's period", force.detent_period, unit.of_one, kPeriod, unit.format,
                  "From one step to the next.")) {
    what = "detent period";
  }
  if (!force.travel.empty()) {
    read_out("force over travel", fmt::format("{} points", force.travel.size()), {},
             "From the scene's file; it adds to spring and detent.");
  }
  return what;
}

std::string_view edit_joint(Body& body, const Scene& scene, std::size_t place) {
  std::string_view what;
  if (choose_kind(body)) what = "joint";
  if (!body.joint) return what;
  BodyJoint& joint = *body.joint;
  const JointUnit unit = unit_of(joint.kind);
  if (choose_body("of", joint.to, scene, "What the joint's other half is fixed to.",
                  [&](const std::string& name) { return may_hang_on(scene, place, name); })) {
    what = "to";
  }
  if (joint.kind != Kind::ball && drag3("Axis x, y, z", joint.axis, 0.01, -1, 1, "%.3f",
                                        "Along it, or about it; in the world, at the start.")) {
    what = "axis";
  }
  Vec3 point = 1e3 * joint.point;
  if (joint.kind != Kind::slider &&
      drag3("Joint at x, y, z [mm]", point, 0.25, 1e3 * kPosition.minimum, 1e3 * kPosition.maximum,
            "%.1f", "From the object's own middle, along its own axes.")) {
    joint.point = 1e-3 * point;
    what = "point";
  }
  if (drag_scaled("Damping", joint.damping, 1, kDamping, unit.damping,
                  "What it takes up, by how fast the joint moves.")) {
    what = "joint damping";
  }
  if (drag_scaled("Dry friction", joint.friction, 1, kJointForce, unit.force,
                  "What it takes to move the joint at all.")) {
    what = "joint friction";
  }
  if (joint.kind == Kind::ball) return what;
  if (const auto stops = edit_limits(joint, unit); !stops.empty()) what = stops;
  if (const auto force = edit_force(joint.force, unit); !force.empty()) what = force;
  return what;
}

bool edit_spring(BodySpring& spring, const Scene& scene, std::string_view& what) {
  const auto body = [](const std::string& name) { return !name.empty(); };
  if (choose_body(
          "From", spring.between[0], scene, "One of its ends.",
          [&](const std::string& name) { return body(name) && name != spring.between[1]; })) {
    what = "from";
  }
  if (choose_body("To", spring.between[1], scene, "Its other end.",
                  [&](const std::string& name) { return name != spring.between[0]; })) {
    what = "to";
  }
  constexpr std::array kEnds{"Holds there x, y, z [mm]", "Holds here x, y, z [mm]"};
  for (std::size_t i = 0; i < 2; ++i) {
    Vec3 point = 1e3 * spring.points[i];
    if (drag3(kEnds[1 - i], point, 0.25, 1e3 * kPosition.minimum, 1e3 * kPosition.maximum, "%.1f",
              i == 0 ? "Where it holds the first one, from that one's middle, along its own axes."
                     : "The same of the second one; of the world from the arm's base.")) {
      spring.points[i] = 1e-3 * point;
      what = i == 0 ? "first point" : "second point";
    }
  }
  if (drag_scaled("Length", spring.length, 1e3, kSpringLength, "%.1f mm",
                  "While it pulls nothing.")) {
    what = "length";
  }
  if (drag_scaled("Stiffness", spring.stiffness, 1, kJointSpring, "%.6g N/m", "Per metre.")) {
    what = "stiffness";
  }
  if (drag_scaled("Damping", spring.damping, 1, kDamping, "%.4g N s/m",
                  "While its length changes.")) {
    what = "damping";
  }
  double breaks = std::isfinite(spring.breaks_at) ? spring.breaks_at : 0;
  if (drag_scaled("Breaks at", breaks, 1, {0, 1e6}, breaks > 0 ? "%.4g N" : "never",
                  "The pull that tears it; 0: it never does.")) {
    spring.breaks_at = breaks > 0 ? breaks : kInfinity;
    what = "breaks at";
  }
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
    tooltip("Ctrl+Z brings it back.");
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
  tooltip("Otherwise that of a solid of its shape and its parts.");
  if (body.center) {
    Vec3 center = 1e3 * *body.center;
    if (drag3("Centre of mass x, y, z [mm]", center, 0.1, 1e3 * kPosition.minimum,
              1e3 * kPosition.maximum, "%.2f",
              "From the object's own middle, along its own axes.")) {
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
  tooltip("Otherwise those of a solid of its shape and its parts.");
  if (!body.inertia) return what;
  constexpr double kShown = 1e7;  // g cm^2 in a kg m^2
  Vec3 shown = kShown * *body.inertia;
  if (drag3("Inertia about x, y, z [g cm\xC2\xB2]", shown, pace(shown.maxCoeff(), 1e-4), 1e-4,
            kShown * kInertia.maximum, "%.5g",
            "About axes through the centre of mass, along the object's own.")) {
    body.inertia = shown / kShown;
    what = "inertia";
  }
  if (!possible_inertia(*body.inertia)) {
    read_out("inertia", "no body has it",
             "None of the three may be more than the other two together.");
  }
  return what;
}

}  // namespace

std::string_view edit_body(Object& object, const Scene& scene, std::size_t place) {
  if (has_shape<Plane>(object) || has_shape<JointStop>(object)) return {};
  std::string_view what;
  bool moves = object.body.has_value();
  if (ImGui::Checkbox("moves", &moves)) {
    object.body.reset();
    if (moves) object.body = Body{.mass = kMass.hold(kWood * volume(object), Body{}.mass)};
    return "moves";
  }
  tooltip("It can be pushed, and falls. It begins with the mass of wood.");
  if (!moves) return what;
  Body& body = *object.body;
  if (drag_scaled("Mass", body.mass, 1e3, kMass, "%.4g g", "Up to 100 kg.")) what = "mass";
  if (ImGui::Checkbox("a magnet picks it up", &body.magnet)) what = "magnet";
  tooltip("While the device's button, or its key, is held and the tip is at it.");
  if (share_slider("Bounce", body.restitution,
                   "The part of its speed that it keeps when it hits something. 0: none.")) {
    what = "restitution";
  }
  if (drag_scaled("Contact stiffness", body.contact_stiffness, 1, kStiffness, "%.6g N/m",
                  "Against other objects; what the tip feels is the stiffness above.")) {
    what = "contact stiffness";
  }
  if (const auto moments = edit_moments(object); !moments.empty()) what = moments;
  if (const auto joint = edit_joint(body, scene, place); !joint.empty()) what = joint;
  return what;
}

void draw_springs(Document& document) {
  if (count_bodies(document.scene()) == 0) return;
  Vec3 gravity = document.scene().gravity;
  if (drag3("Gravity x, y, z [m/s\xC2\xB2]", gravity, 0.05, kGravity.minimum, kGravity.maximum,
            "%.2f", "Of what moves. On the Moon it is 1.62, here 9.81, downwards.") &&
      document.may_edit()) {
    document.editor().set_gravity(gravity);
  }
  heading("Springs");
  for (std::size_t i = 0; i < document.scene().springs.size(); ++i) draw_spring(document, i);
  if (ImGui::Button("Add spring", {-1, 0}) && document.may_edit()) {
    document.add_spring(new_spring(document.editor()));
  }
  tooltip("From the selected object that moves to where it is now.");
}

}  // namespace limpid
