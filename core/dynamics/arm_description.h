// An arm as its file gives it: a chain of revolute and prismatic joints. Fixed joints are already
// merged.
//
// All that is said of joints in rad is said of slides in units of travel, so that coordinates,
// velocities, torques and gains mean the same for both: where a joint has 1 rad, a slide has 10 cm,
// and its "torque" of 1 N m is a force of 10 N.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/math/sizes.h"

namespace limpid {

struct Model;  // a picture, of no interest here

inline constexpr double kSlideUnit = 0.1;  // travel of a slide per unit of its coordinate [m]

struct Joint {
  enum class Kind { revolute, prismatic };
  std::string name;
  Kind kind = Kind::revolute;
  Pose origin = Pose::Identity();  // joint frame in the frame of the previous link [m, rad]
  Vec3 axis = Vec3::UnitZ();       // unit, in the joint frame
  double lower = -std::numeric_limits<double>::infinity();  // [rad]
  double upper = std::numeric_limits<double>::infinity();   // [rad]
  double effort = 0;                                        // torque limit [N m]
  double damping = 0;                                       // viscous, b_d [N m s/rad]
  double friction = 0;                                      // Coulomb [N m]
  // What pulls at it in every pose: -(spring x + offset) [N m/rad, N m].
  double spring = 0, offset = 0;
};

struct Link {
  std::string name;
  double mass = 0;              // [kg]
  Vec3 com = Vec3::Zero();      // centre of mass in the link frame [m]
  Mat3 inertia = Mat3::Zero();  // about the centre of mass, axes of the link [kg m^2]
};

// What to draw: one shape fixed to a link. `size` is the box's edges, (radius, length, -) of a
// cylinder along z, (radius, -, -) of a sphere, or the scale of a mesh, negative where it mirrors.
// A stand-in is what could not be read: a link of which nothing else is seen is drawn as a capsule.
struct Visual {
  enum class Shape { mesh, box, cylinder, sphere, stand_in };
  int link = -1;                   // index into links, -1 the base
  Pose origin = Pose::Identity();  // in the link frame
  Shape shape = Shape::mesh;
  std::string mesh = {};  // absolute path of a model; glTF ones have y up, which is turned to z
  Vec3 size = Vec3::Ones();
  std::optional<Eigen::Vector4f> color = {};  // sRGB and opacity; of a mesh without its own
  std::shared_ptr<const Model> model = {};    // of the mesh, once somebody has read it
};

// A named frame of the file: every URDF link, also those merged through fixed joints.
struct NamedFrame {
  std::string name;
  int link = -1;                   // -1: does not move
  Pose origin = Pose::Identity();  // in the frame of `link`
};

struct ArmDescription {
  std::string name;
  std::vector<Joint> joints;    // n, base first
  std::vector<Link> links;      // n, link i is moved by joint i; its frame is that of joint i
  Pose tip = Pose::Identity();  // in the last link's frame
  std::string tip_link;         // the file's link that it is the origin of
  Vec3 gravity{0, 0, -9.81};    // in the base's frame, as the arm stands [m/s^2]
  // Of the device that this arm was identified from, from a reading to the torque that answers it,
  // beyond the tick [s]. An arm without it was not identified: its numbers are its file's.
  std::optional<double> delay;
  std::vector<NamedFrame> frames;
  std::vector<Visual> visuals;
  std::string urdf;                   // the text it came from
  std::vector<std::string> warnings;  // what the text lacks, and what took its place, for people

  int dof() const { return static_cast<int>(joints.size()); }
  bool slides(std::size_t joint) const { return joints[joint].kind == Joint::Kind::prismatic; }
};

// The middle of each joint's limits, 0 where there are none; bent from there where that leaves the
// tip a direction in which it cannot move, as an arm stretched out has [rad].
Eigen::VectorXd rest_pose(const ArmDescription& arm);
// Where the tip is then [m].
Vec3 rest_tip(const ArmDescription& arm);

}  // namespace limpid
