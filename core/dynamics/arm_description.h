// Description of an arm from its file: a chain of revolute and prismatic joints; fixed joints are
// already merged.
//
// Quantities in rad are, for slides, in units of travel, so that coordinates, velocities, torques
// and gains mean the same for both. 1 rad of a joint corresponds to 10 cm of a slide, and a slide's
// "torque" of 1 N m is a force of 10 N.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/math/sizes.h"

namespace limpid {

struct Model;  // a model to draw, not used here

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
  // Pull of a spring in every pose: -(spring x + offset) [N m/rad, N m].
  double spring = 0, offset = 0;
  // Torque that the motor bears for hours [N m], 0: not known; and the time constant with which it
  // warms up and cools [s].
  double continuous = 0, warming = 0;
};

struct Link {
  std::string name;
  double mass = 0;              // [kg]
  Vec3 com = Vec3::Zero();      // centre of mass in the link frame [m]
  Mat3 inertia = Mat3::Zero();  // about the centre of mass, axes of the link [kg m^2]
};

// A shape to draw, fixed to a link. `size`: edges of a box; (radius, length, -) of a cylinder along
// z; (radius, -, -) of a sphere; the scale of a mesh, negative where it mirrors. A stand-in
// replaces a shape that could not be read: a link with no other shape is drawn as a capsule.
struct Visual {
  enum class Shape { mesh, box, cylinder, sphere, stand_in };
  int link = -1;                   // index into links, -1 the base
  Pose origin = Pose::Identity();  // in the link frame
  Shape shape = Shape::mesh;
  std::string mesh = {};  // absolute path of a model; in glTF y is up, which is turned to z
  Vec3 size = Vec3::Ones();
  std::optional<Eigen::Vector4f> color = {};  // sRGB and opacity; of a mesh without its own
  std::shared_ptr<const Model> model = {};    // of the mesh, after it has been read
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
  std::string tip_link;         // link of the file whose origin is the tip
  Vec3 gravity{0, 0, -9.81};    // in the base's frame, as the arm stands [m/s^2]
  // Delay of the device that this arm was identified from: from a reading to its answering torque,
  // beyond the tick [s]. Empty: not identified, the numbers are the file's.
  std::optional<double> delay;
  // Readings of the device, by the file: step of its encoders [rad], and an assumed delay beyond
  // the tick [s]. 0: the file says nothing of it.
  double encoder_step = 0, assumed_delay = 0;
  std::vector<NamedFrame> frames;
  std::vector<Visual> visuals;
  std::string urdf;                   // the text that described it
  std::vector<std::string> warnings;  // defects of the text and their substitutes, for people

  int dof() const { return static_cast<int>(joints.size()); }
  bool slides(std::size_t joint) const { return joints[joint].kind == Joint::Kind::prismatic; }
  // All joints slide, so that a step of the encoders is a length.
  bool only_slides() const {
    for (std::size_t i = 0; i < joints.size(); ++i) {
      if (!slides(i)) return false;
    }
    return true;
  }
};

// Middle of each joint's limits, 0 where there are none [rad]. If the tip could not move in some
// direction there, as in an arm stretched out, joints are bent from it.
Eigen::VectorXd rest_pose(const ArmDescription& arm);
// Position of the tip in rest_pose() [m].
Vec3 rest_tip(const ArmDescription& arm);

}  // namespace limpid
