// What can be touched, and with what: plain data, in the device base frame (x forward, y left,
// z up), SI.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/math/sizes.h"
#include "core/touch/material.h"

namespace limpid {

class TriangleMesh;

struct Plane {
  std::string name;
  Vec3 point = Vec3::Zero();    // on the surface [m]
  Vec3 normal = Vec3::UnitZ();  // unit, out of the material
  Material material{};
};

struct Sphere {
  std::string name;
  Vec3 center = Vec3::Zero();  // [m]
  double radius = 0.05;        // [m]
  Material material{};
};

struct Box {
  std::string name;
  Pose pose = Pose::Identity();     // of its centre
  Vec3 size = Vec3::Constant(0.1);  // full edge lengths [m]
  Material material{};
};

// A stiff stop of one joint, in joint space (the paper's proximal contact): the joint touches it
// when direction * (x2[joint] - angle) > 0.
struct JointContact {
  std::string name;
  int joint = 0;          // index, base first
  double angle = 0;       // [rad]
  double direction = 1;   // +1: touched from below, -1: from above
  double stiffness = 20;  // [N m/rad]
};

// A part of the arm that touches: a capsule (a point if both ends agree) fixed to a link.
struct Probe {
  std::string name;
  int link = 0;              // index of the moving link it sits on
  Vec3 from = Vec3::Zero();  // in the link frame [m]
  Vec3 to = Vec3::Zero();    // in the link frame [m]
  double radius = 0;         // [m]
};

// A model of triangles. Its points are stood() * (size() * p).
struct MeshObstacle {
  std::string name;
  std::string model;             // which one: the name that the scene's text has for its file
  Pose pose = Pose::Identity();  // [m]
  double scale = 1;
  double unit = 1;    // of the model's coordinates [m]
  bool y_up = false;  // the model's y axis points up, else its z axis
  Material material{};
  std::shared_ptr<const TriangleMesh> shape;  // the model's, built before it is touched

  double size() const { return unit * scale; }
  Pose stood() const {
    Pose out = pose;
    if (y_up) {
      out.linear().col(1) = pose.linear().col(2);
      out.linear().col(2) = -pose.linear().col(1);
    }
    return out;
  }
};

struct Scene {
  double tip_radius = 0;  // [m]; the tip is always a probe
  std::vector<Plane> planes;
  std::vector<Sphere> spheres;
  std::vector<Box> boxes;
  std::vector<MeshObstacle> meshes;
  std::vector<JointContact> joint_contacts;
  std::vector<Probe> probes;  // besides the tip
};

// Where something touches and how hard it pushes on the proxy.
struct ContactForce {
  Vec3 point = Vec3::Zero();  // [m]
  Vec3 force = Vec3::Zero();  // [N]
};

}  // namespace limpid
