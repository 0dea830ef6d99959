// A scene: objects with shapes at poses, of materials, some of them bodies that move. Plain data,
// in the device base frame (x forward, y left, z up), SI.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/math/sizes.h"
#include "core/touch/body.h"

namespace limpid {

// Forces of a surface. The paper's contacts are pure stiffness (section 4.1); friction and damping
// are further parts of its f2, under every law.
struct Material {
  double stiffness = 600;       // [N/m]
  double damping = 0;           // while being pressed in or let out [N s/m]
  double friction_static = 0;   // largest tangential force that sticks, over the normal one [-]
  double friction_kinetic = 0;  // tangential force while slipping, over the normal one [-]
};

class TriangleMesh;

// A half-space below a plane; a pose shifts it and does not turn it.
struct Plane {
  Vec3 normal = Vec3::UnitZ();  // unit, out of the material
  friend bool operator==(const Plane&, const Plane&) = default;
};

struct Sphere {
  double radius = 0.05;  // [m]
  friend bool operator==(const Sphere&, const Sphere&) = default;
};

struct Box {
  Vec3 size = Vec3::Constant(0.1);  // full edge lengths [m]
  friend bool operator==(const Box&, const Box&) = default;
};

// A cylinder around the z axis, its middle at the origin.
struct Cylinder {
  double radius = 0.02;  // [m]
  double length = 0.05;  // from face to face [m]
  friend bool operator==(const Cylinder&, const Cylinder&) = default;
};

// A capsule along the z axis: a cylinder between two half balls.
struct Capsule {
  double radius = 0.02;  // [m]
  double length = 0.05;  // between the balls' centres [m]
  friend bool operator==(const Capsule&, const Capsule&) = default;
};

// A model of triangles. Its points are stood(pose) * (size() * p).
struct Mesh {
  std::string model{};  // name of its file in the scene's text
  double scale = 1;
  double unit = 1;                                  // of the model's coordinates [m]
  bool y_up = false;                                // the model's y axis points up, else its z axis
  std::shared_ptr<const TriangleMesh> triangles{};  // the model's, built before it is touched

  double size() const { return unit * scale; }
  Pose stood(const Pose& pose) const {
    Pose out = pose;
    if (y_up) {
      out.linear().col(1) = pose.linear().col(2);
      out.linear().col(2) = -pose.linear().col(1);
    }
    return out;
  }
  friend bool operator==(const Mesh&, const Mesh&) = default;
};

// A stiff stop of one joint, in joint space (the paper's proximal contact): the joint touches it
// when direction * (x2[joint] - angle) > 0. It has no place in space; its object's pose is not
// used.
struct JointStop {
  static constexpr double kUsualStiffness = 20;  // [N m/rad]

  int joint = 0;         // index, base first
  double angle = 0;      // [rad]
  double direction = 1;  // +1: touched from below, -1: from above
  friend bool operator==(const JointStop&, const JointStop&) = default;
};

using Shape = std::variant<Plane, Sphere, Box, Cylinder, Capsule, Mesh, JointStop>;
inline constexpr std::size_t kShapes = std::variant_size_v<Shape>;

// A part of a body made of several shapes, in the body's frame.
struct BodyPart {
  Pose pose = Pose::Identity();  // [m]
  Shape shape{};                 // Sphere, Box, Cylinder or Capsule
  std::optional<Vec3> color{};   // else the body's
};

struct Object {
  std::string name{};
  Pose pose = Pose::Identity();  // [m]; of a body the start
  Shape shape{};
  Material material{};  // of a joint's stop only the stiffness, in [N m/rad]
  // Set for an object that moves. Its shape is then a Sphere, Box, Cylinder, Capsule or Mesh. Other
  // bodies and fixed objects meet the convex hull of a mesh, the tip the mesh itself.
  std::optional<Body> body{};
  std::vector<BodyPart> parts{};  // of a body, besides its shape
  // Red, green and blue as on a screen, 0 to 1, for objects without a model; used only for drawing.
  std::optional<Vec3> color{};
};

template <class S>
bool has_shape(const Object& object) {
  return std::holds_alternative<S>(object.shape);
}
// True if the object has a place in space, with a stiffness in [N/m].
inline bool has_surface(const Object& object) { return !has_shape<JointStop>(object); }

// A part of the arm that touches: a capsule (a point if both ends agree) fixed to a link.
struct Probe {
  std::string name;
  int link = 0;              // index of the moving link it sits on
  Vec3 from = Vec3::Zero();  // in the link frame [m]
  Vec3 to = Vec3::Zero();    // in the link frame [m]
  double radius = 0;         // [m]
};

struct Scene {
  double tip_radius = 0;  // [m]; the tip is always a probe
  // Fixed objects first, by shape in the order of Shape; then bodies, in the order of adding. A
  // file keeps no other order, and contacts follow it.
  std::vector<Object> objects;
  std::vector<Probe> probes;  // besides the tip
  Vec3 gravity{0, 0, -9.81};  // of bodies [m/s^2]
  std::vector<BodySpring> springs;

  // Inserts an object behind others of its shape, or behind all if it moves; returns its index.
  std::size_t add(Object object);
};

// A pose that only shifts [m].
Pose pose_at(const Vec3& position);

// Number of objects that move.
int count_bodies(const Scene& scene);
// Names of the objects that move, in their order; without a name the number: "object 2".
std::vector<std::string> body_names(const Scene& scene);
// Stiffness of the stiffest surface; 0 without any [N/m].
double stiffest_surface(const Scene& scene);
// True if some object has friction or damping.
bool has_rubbing_surfaces(const Scene& scene);
void set_surface_stiffness(Scene& scene, double stiffness);

// A contact's place and force on the proxy.
struct ContactForce {
  Vec3 point = Vec3::Zero();  // [m]
  Vec3 force = Vec3::Zero();  // [N]
};

}  // namespace limpid
