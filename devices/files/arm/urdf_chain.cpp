#include "devices/files/arm/urdf_chain.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "devices/files/file_error.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& where, const std::map<std::string, int>& lines,
                         const char* kind, const std::string& name, const std::string& why) {
  const auto line = lines.find(name);
  throw FileError(fmt::format("{}{}: {} '{}': {}", where,
                              line == lines.end() ? "" : fmt::format(":{}", line->second), kind,
                              name, why));
}

Vec3 vector(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

Pose pose(const urdf::Pose& p) {
  Pose out = Pose::Identity();
  out.translation() = vector(p.position);
  const auto& q = p.rotation;
  out.linear() = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
  return out;
}

Mat3 point_inertia(double mass, const Vec3& r) {
  return mass * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
}

// Adds a body to `link`; `at` is its frame in the link's.
void merge(Link& link, const urdf::Inertial& body, const Pose& at) {
  const Pose in_link = at * pose(body.origin);
  Mat3 inertia;
  inertia << body.ixx, body.ixy, body.ixz,  //
      body.ixy, body.iyy, body.iyz,         //
      body.ixz, body.iyz, body.izz;
  const double mass = link.mass + body.mass;
  const Vec3 com =
      mass > 0 ? Vec3((link.mass * link.com + body.mass * in_link.translation()) / mass) : link.com;
  link.inertia += point_inertia(link.mass, link.com - com) +
                  in_link.linear() * inertia * in_link.linear().transpose() +
                  point_inertia(body.mass, in_link.translation() - com);
  link.mass = mass;
  link.com = com;
}

const char* kind_of(const urdf::Joint& joint) {
  switch (joint.type) {
    case urdf::Joint::PRISMATIC: return "prismatic";
    case urdf::Joint::FLOATING: return "floating";
    case urdf::Joint::PLANAR: return "planar";
    default: return "of unknown kind";
  }
}

double limit_of(const urdf::Joint& joint, double urdf::JointLimits::*field, double otherwise) {
  return joint.limits ? (*joint.limits).*field : otherwise;
}

class Chain {
 public:
  Chain(const UrdfPlaces& places, const fs::path& base_dir)
      : places_(places), base_dir_(base_dir) {}

  ArmDescription follow(const urdf::ModelInterface& model) {
    arm_.name = model.getName();
    urdf::LinkConstSharedPtr link = model.getRoot();
    for (;;) {
      add_link(*link);
      if (link->child_joints.empty()) break;
      if (link->child_joints.size() > 1) {
        places_.refuse_link(link->name, fmt::format("{} joints hang on it; needed: one, a chain",
                                                    link->child_joints.size()));
      }
      const urdf::Joint& joint = *link->child_joints.front();
      pass_joint(joint);
      link = model.getLink(joint.child_link_name);
    }
    if (arm_.joints.empty()) {
      throw FileError(
          fmt::format("{}: no joint that moves; needed: 1 to {}", places_.where, kMaxDof));
    }
    arm_.tip = here_;
    for (std::size_t i = 0; i < arm_.links.size(); ++i) check_inertia(i);
    return std::move(arm_);
  }

 private:
  int moving() const { return arm_.dof() - 1; }

  void add_link(const urdf::Link& link) {
    arm_.frames.push_back({link.name, moving(), here_});
    if (link.inertial) add_inertial(link);
    for (const auto& visual : link.visual_array) add_visual(link, *visual);
  }

  void add_inertial(const urdf::Link& link) {
    const urdf::Inertial& body = *link.inertial;
    for (const double x :
         {body.mass, body.ixx, body.ixy, body.ixz, body.iyy, body.iyz, body.izz,
          body.origin.position.x, body.origin.position.y, body.origin.position.z}) {
      if (!std::isfinite(x)) places_.refuse_link(link.name, "inertial: a number is not finite");
    }
    if (body.mass < 0) {
      places_.refuse_link(link.name, fmt::format("mass {} kg; needed: 0 or more", body.mass));
    }
    if (moving() >= 0) merge(arm_.links.back(), body, here_);
  }

  void pass_joint(const urdf::Joint& joint) {
    const Pose origin = here_ * pose(joint.parent_to_joint_origin_transform);
    if (!origin.matrix().allFinite()) {
      places_.refuse_joint(joint.name, "origin: a number is not finite");
    }
    if (joint.type == urdf::Joint::FIXED) {
      here_ = origin;
      return;
    }
    if (joint.type != urdf::Joint::REVOLUTE && joint.type != urdf::Joint::CONTINUOUS) {
      places_.refuse_joint(joint.name,
                           fmt::format("{}; allowed: revolute, continuous, fixed", kind_of(joint)));
    }
    if (joint.mimic) places_.refuse_joint(joint.name, "mimics another joint; not supported");
    if (arm_.dof() == kMaxDof) {
      places_.refuse_joint(joint.name, fmt::format("one too many; at most {}", kMaxDof));
    }
    arm_.joints.push_back(moving_joint(joint, origin));
    arm_.links.push_back({joint.child_link_name});
    here_ = Pose::Identity();
  }

  Joint moving_joint(const urdf::Joint& joint, const Pose& origin) const {
    Joint out;
    out.name = joint.name;
    out.origin = origin;
    const Vec3 axis = vector(joint.axis);
    if (!axis.allFinite() || !(axis.norm() > 1e-9)) {
      places_.refuse_joint(joint.name, "axis is zero or not finite; needed: a direction");
    }
    out.axis = axis.normalized();
    if (joint.type == urdf::Joint::REVOLUTE) {
      out.lower = limit_of(joint, &urdf::JointLimits::lower, 0);
      out.upper = limit_of(joint, &urdf::JointLimits::upper, 0);
      if (!(out.lower < out.upper) || !std::isfinite(out.upper - out.lower)) {
        places_.refuse_joint(joint.name,
                             fmt::format("limits from {} to {} rad; needed: finite, lower below "
                                         "upper",
                                         out.lower, out.upper));
      }
    }
    out.effort = limit_of(joint, &urdf::JointLimits::effort, 0);
    if (!(out.effort > 0 && std::isfinite(out.effort))) {
      places_.refuse_joint(
          joint.name, fmt::format("effort {} N m in <limit>; needed: more than 0", out.effort));
    }
    if (joint.dynamics) {
      out.damping = at_least_zero(joint.name, "damping", joint.dynamics->damping);
      out.friction = at_least_zero(joint.name, "friction", joint.dynamics->friction);
    }
    return out;
  }

  double at_least_zero(const std::string& joint, const char* what, double x) const {
    if (x >= 0 && std::isfinite(x)) return x;
    places_.refuse_joint(joint, fmt::format("{} {}; needed: 0 or more", what, x));
  }

  // With a positive semidefinite inertia, and some of it about the link's own joint, every link
  // stores energy as soon as its joint turns; so M is positive definite in every pose.
  void check_inertia(std::size_t i) const {
    const Link& link = arm_.links[i];
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(link.inertia, Eigen::EigenvaluesOnly);
    const double largest = link.inertia.cwiseAbs().maxCoeff();
    if (solver.eigenvalues().minCoeff() < -1e-9 * largest) {
      places_.refuse_link(link.name, "inertia is not that of any body (a negative moment)");
    }
    const Vec3& axis = arm_.joints[i].axis;
    const double about_joint = axis.dot((link.inertia + point_inertia(link.mass, link.com)) * axis);
    if (!(about_joint > 0 && std::isfinite(about_joint))) {
      places_.refuse_link(link.name,
                          fmt::format("inertia {} kg m^2 about joint '{}'; needed: more than 0 "
                                      "(its <inertial> or that of links fixed to it)",
                                      about_joint, arm_.joints[i].name));
    }
  }

  void add_visual(const urdf::Link& link, const urdf::Visual& visual) {
    if (!visual.geometry) return;
    Visual out;
    out.link = moving();
    out.origin = here_ * pose(visual.origin);
    const urdf::Geometry& shape = *visual.geometry;
    if (shape.type == urdf::Geometry::BOX) {
      out.shape = Visual::Shape::box;
      out.size = vector(static_cast<const urdf::Box&>(shape).dim);
    } else if (shape.type == urdf::Geometry::CYLINDER) {
      const auto& cylinder = static_cast<const urdf::Cylinder&>(shape);
      out.shape = Visual::Shape::cylinder;
      out.size = Vec3(cylinder.radius, cylinder.length, 1);
    } else if (shape.type == urdf::Geometry::SPHERE) {
      out.shape = Visual::Shape::sphere;
      out.size = Vec3(static_cast<const urdf::Sphere&>(shape).radius, 1, 1);
    } else {
      const auto& mesh = static_cast<const urdf::Mesh&>(shape);
      out.size = vector(mesh.scale);
      out.mesh = mesh_path(link, mesh.filename);
      if (out.mesh.empty()) return;
    }
    if (!out.origin.matrix().allFinite() || !out.size.allFinite() || out.size.minCoeff() <= 0) {
      places_.refuse_link(link.name, "visual: sizes and origin must be finite, sizes above 0");
    }
    arm_.visuals.push_back(out);
  }

  // Empty for a mesh that is left out.
  std::string mesh_path(const urdf::Link& link, const std::string& name) const {
    if (name.find("://") != std::string::npos) {
      places_.refuse_link(link.name, fmt::format("mesh '{}': package and other addresses are not "
                                                 "resolved; needed: a path from the URDF's folder",
                                                 name));
    }
    const fs::path file = name;
    if (file.extension() != ".glb" && file.extension() != ".gltf") {
      places_.refuse_link(link.name,
                          fmt::format("mesh '{}': not glTF; needed: .glb or .gltf", name));
    }
    const fs::path absolute = fs::absolute(base_dir_ / file).lexically_normal();
    std::error_code error;
    const bool there = fs::is_regular_file(absolute, error);
    if (base_dir_.empty() && (file.is_relative() || !there)) return {};
    if (!there) {
      places_.refuse_link(link.name, fmt::format("mesh '{}': no such file", absolute.string()));
    }
    return absolute.string();
  }

  const UrdfPlaces& places_;
  const fs::path& base_dir_;
  ArmDescription arm_;
  Pose here_ = Pose::Identity();  // the link being looked at, in the frame of the moving one
};

}  // namespace

void UrdfPlaces::refuse_joint(const std::string& name, const std::string& why) const {
  refuse(where, joint_lines, "joint", name, why);
}

void UrdfPlaces::refuse_link(const std::string& name, const std::string& why) const {
  refuse(where, link_lines, "link", name, why);
}

ArmDescription chain_of(const urdf::ModelInterface& model, const UrdfPlaces& places,
                        const fs::path& base_dir) {
  return Chain(places, base_dir).follow(model);
}

}  // namespace limpid
