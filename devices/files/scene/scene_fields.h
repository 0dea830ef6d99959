// Fields of what a scene's file describes, for reader, writer, editor and axes of sweeps.
#pragma once

#include <array>

#include "core/base/field.h"
#include "core/touch/scene.h"
#include "devices/files/scene/scene_document.h"

namespace limpid {

inline constexpr std::array kMaterialFields{
    Field<Material>("stiffness", "Stiffness", &Material::stiffness, scene_limits::kStiffness,
                    "With a larger value the object pushes back harder. Double click to type, "
                    "right click for the default value. The coupling limits how stiff a surface "
                    "can feel.",
                    {1, 1e4, true}, {.needed = true}),
    Field<Material>("damping", "Damping", &Material::damping, scene_limits::kDamping,
                    "Damping while the surface is pressed or released; at 0 the surface returns "
                    "all energy. Only the predictive coupling renders this damping, up to a limit "
                    "that depends on the tick.",
                    {0, 20}),
    Field<Material>("friction_static", "Friction, sticking", &Material::friction_static,
                    scene_limits::kFriction,
                    "Largest friction force while the tip sticks, divided by the pressing force. "
                    "Rendered by the predictive coupling.",
                    {0, 1}),
    Field<Material>("friction_kinetic", "Friction, slipping", &Material::friction_kinetic,
                    scene_limits::kFriction,
                    "Friction force while the tip slips, divided by the pressing force. Rendered "
                    "by the predictive coupling.",
                    {0, 1}),
};

// A stop of a joint has the stiffness alone, in other numbers.
inline constexpr Field<Material> kStopStiffness("stiffness", "Stiffness", &Material::stiffness,
                                                scene_limits::kJointStiffness,
                                                kMaterialFields[0].meaning, {0.1, 1e3, true},
                                                {.needed = true});

inline constexpr Field<Body> kBodyMass("mass", "Mass", &Body::mass, scene_limits::kMass,
                                       "Mass of the object, up to 100 kg.");
inline constexpr std::array kBodyFields{
    Field<Body>("magnet", "a magnet picks it up", &Body::magnet, scene_limits::kShare,
                "The magnet at the tip can hold this object. Key H, or the device's first button, "
                "switches the magnet on and off."),
    Field<Body>("restitution", "Bounce", &Body::restitution, scene_limits::kShare,
                "The part of its speed that the object keeps after a collision. 0: the object does "
                "not bounce.",
                {0, 1}),
    Field<Body>("contact_stiffness", "Contact stiffness", &Body::contact_stiffness,
                scene_limits::kStiffness,
                "Stiffness in contacts with other objects. The tip feels the stiffness above."),
    Field<Body>("center", "Centre of mass", &Body::center, scene_limits::kPosition,
                "Distance from the object's middle, along the object's own axes."),
    Field<Body>("inertia", "Inertia", &Body::inertia, scene_limits::kInertia,
                "Moments of inertia about axes through the centre of mass, parallel to the "
                "object's own axes."),
};

inline constexpr bool turns(const BodyJoint& joint) {
  return joint.kind != BodyJoint::Kind::slider;
}
inline constexpr bool has_axis(const BodyJoint& joint) {
  return joint.kind != BodyJoint::Kind::ball;
}
inline constexpr std::array kJointKinds{"slider", "hinge", "ball"};
// The kind comes first: it says which others there are. Not here: axis, limits, travel.
inline constexpr std::array kJointFields{
    Field<BodyJoint>("kind", "Hangs on", choice<BodyJoint, &BodyJoint::kind>(kJointKinds), {0, 2},
                     "A slider moves along a line, a hinge turns about one axis, a ball joint "
                     "turns about all axes.",
                     {}, {.needed = true}),
    Field<BodyJoint>("to", "of", &BodyJoint::to, {},
                     "The object, or the world, to which the joint's other half is fixed."),
    Field<BodyJoint>("point", "Joint at", &BodyJoint::point, scene_limits::kPosition,
                     "Distance from the object's middle, along the object's own axes.", {},
                     {.when = turns}),
    Field<BodyJoint>("damping", "Damping", &BodyJoint::damping, scene_limits::kJointDamping,
                     "Force that brakes the joint, in proportion to the joint's speed."),
    Field<BodyJoint>("friction", "Dry friction", &BodyJoint::friction, scene_limits::kJointForce,
                     "Smallest force that moves the joint."),
};
inline constexpr std::array kStopFields{
    Field<BodyJoint>("stop_stiffness", "Stops' stiffness", &BodyJoint::stop_stiffness,
                     scene_limits::kStopsStiffness,
                     "With a larger value an end stop pushes back harder.", {}, {.when = has_axis}),
    Field<BodyJoint>("stop_restitution", "Stops' bounce", &BodyJoint::stop_restitution,
                     scene_limits::kShare,
                     "The part of its speed that the joint keeps when it hits a stop.", {0, 1},
                     {.when = has_axis}),
};
inline constexpr std::array kForceFields{
    Field<JointForce>("spring", "Spring", &JointForce::spring, scene_limits::kJointSpring,
                      "A spring that pulls the joint towards its rest position."),
    Field<JointForce>(
        "rest", "Rest", &JointForce::rest, scene_limits::kTravel,
        "Position where the spring has no force; 0: the joint's position at the start."),
};
// Keys of the table `detent`.
inline constexpr std::array kDetentFields{
    Field<JointForce>("force", "Detent", &JointForce::detent_force, scene_limits::kJointForce,
                      "Largest force with which a notch (detent) holds the joint. 0: the joint has "
                      "no notches.",
                      {}, {.needed = true}),
    Field<JointForce>("period", "Detent's period", &JointForce::detent_period,
                      scene_limits::kPeriod,
                      "Distance from one notch (detent) to the next; on a hinge, the angle. The "
                      "joint clicks into each notch.",
                      {}, {.needed = true}),
};

inline constexpr std::array kSpringFields{
    Field<BodySpring>("length", "Length", &BodySpring::length, scene_limits::kSpringLength,
                      "Length of the spring without force."),
    Field<BodySpring>("stiffness", "Stiffness", &BodySpring::stiffness,
                      scene_limits::kSpringStiffness, "Force per metre of extension."),
    Field<BodySpring>("damping", "Damping", &BodySpring::damping, scene_limits::kDamping,
                      "Damping force while the spring's length changes."),
    Field<BodySpring>("breaks_at", "Breaks at", &BodySpring::breaks_at, scene_limits::kBreaking,
                      "The pulling force at which the spring breaks; 0: the spring never breaks."),
};

// Sizes of a shape.
inline constexpr std::array kSphereFields{Field<Sphere>("radius", "Radius", &Sphere::radius,
                                                        scene_limits::kLength, "Radius of the ball",
                                                        {}, {.needed = true})};
inline constexpr std::array kBoxFields{Field<Box>("size", "Size", &Box::size, scene_limits::kLength,
                                                  "Full length of each edge", {},
                                                  {.needed = true})};
inline constexpr std::array kCylinderFields{
    Field<Cylinder>("radius", "Radius", &Cylinder::radius, scene_limits::kLength,
                    "Radius of its round faces", {}, {.needed = true}),
    Field<Cylinder>("length", "Length", &Cylinder::length, scene_limits::kLength,
                    "Distance from face to face", {}, {.needed = true})};
inline constexpr std::array kCapsuleFields{
    Field<Capsule>("radius", "Radius", &Capsule::radius, scene_limits::kLength,
                   "Radius of its round ends", {}, {.needed = true}),
    Field<Capsule>("length", "Length", &Capsule::length, scene_limits::kLength,
                   "Distance between the centres of its round ends", {}, {.needed = true})};
inline constexpr std::array kMeshFields{
    Field<Mesh>("scale", "Scale", &Mesh::scale, scene_limits::kScale,
                "1: the model has the size that is given in its file.")};

inline constexpr std::array kSides{"above", "below"};
inline constexpr std::array kJointStopFields{
    Field<JointStop>("angle", "Angle", &JointStop::angle, scene_limits::kAngle,
                     "Joint angle of the stop", {}, {.needed = true}),
    Field<JointStop>(
        "side", "Side",
        Choice<JointStop>{
            kSides,
            [](const JointStop& stop) -> std::uint8_t { return stop.direction > 0 ? 0 : 1; },
            [](JointStop& stop, std::uint8_t side) { stop.direction = side == 0 ? 1 : -1; }},
        {0, 1}, "The side from which the stop is touched.", {}, {.needed = true})};

constexpr const auto& fields_of(const Sphere&) { return kSphereFields; }
constexpr const auto& fields_of(const Box&) { return kBoxFields; }
constexpr const auto& fields_of(const Cylinder&) { return kCylinderFields; }
constexpr const auto& fields_of(const Capsule&) { return kCapsuleFields; }
constexpr const auto& fields_of(const Mesh&) { return kMeshFields; }
constexpr std::array<Field<Plane>, 0> fields_of(const Plane&) { return {}; }
constexpr const auto& fields_of(const JointStop&) { return kJointStopFields; }

// Holds the sizes of a shape within what a file may say.
inline void hold_size(Shape& shape) {
  std::visit([](auto& s) { hold_fields(fields_of(s), s); }, shape);
}

// A material that everybody knows, as a hand feels it through a device.
struct UsualMaterial {
  const char* name;
  Material material;
};

// Stiffness and damping of a contact with a fingertip or a small tool, not of the bulk; friction
// against skin or plastic, dry.
inline constexpr std::array kUsualMaterials{
    UsualMaterial{"foam", {100, 2, 0.6, 0.5}},        UsualMaterial{"felt", {150, 1, 0.7, 0.6}},
    UsualMaterial{"skin", {300, 3, 0.8, 0.6}},        UsualMaterial{"rubber", {500, 2, 1.0, 0.9}},
    UsualMaterial{"plastic", {1200, 0.5, 0.3, 0.25}}, UsualMaterial{"wood", {1500, 0, 0.4, 0.3}},
    UsualMaterial{"glass", {4000, 0, 0.1, 0.08}},     UsualMaterial{"brass", {5000, 0, 0.25, 0.2}},
    UsualMaterial{"ice", {3000, 0, 0.03, 0.02}}};

// The usual material with these values; null if there is none.
inline const UsualMaterial* usual_material(const Material& material) {
  for (const UsualMaterial& each : kUsualMaterials) {
    if (std::ranges::all_of(kMaterialFields, [&](const Field<Material>& field) {
          return number_of(field, each.material) == number_of(field, material);
        }))
      return &each;
  }
  return nullptr;
}

}  // namespace limpid
