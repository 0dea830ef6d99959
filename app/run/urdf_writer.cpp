#include "app/run/urdf_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/base/markup.h"
#include "devices/files/rpy.h"

namespace limpid {
namespace {

// Makes a text fit for a comment, which ends at its first two hyphens.
std::string as_comment(std::string text) {
  for (std::size_t at; (at = text.find("--")) != std::string::npos;) text.insert(at + 1, " ");
  return text;
}

std::string numbers(const Vec3& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }

std::string origin(const Pose& pose) {
  return fmt::format(R"(<origin xyz="{}" rpy="{}"/>)", numbers(pose.translation()),
                     numbers(rpy_of(pose.linear())));
}

std::string shape(const Visual& visual) {
  const Vec3& s = visual.size;
  switch (visual.shape) {
    case Visual::Shape::box: return fmt::format(R"(<box size="{}"/>)", numbers(s));
    case Visual::Shape::cylinder:
      return fmt::format(R"(<cylinder radius="{}" length="{}"/>)", s.x(), s.y());
    case Visual::Shape::sphere: return fmt::format(R"(<sphere radius="{}"/>)", s.x());
    case Visual::Shape::mesh:
    case Visual::Shape::stand_in: break;
  }
  return fmt::format(R"(<mesh filename="{}" scale="{}"/>)", escaped(visual.mesh), numbers(s));
}

std::string visuals(const ArmDescription& arm, int link) {
  std::string out;
  for (const Visual& visual : arm.visuals) {
    if (visual.link != link || visual.shape == Visual::Shape::stand_in) continue;
    out += fmt::format("    <visual>\n      {}\n      <geometry>{}</geometry>\n    </visual>\n",
                       origin(visual.origin), shape(visual));
  }
  return out;
}

std::string inertial(const Link& link) {
  const Mat3& I = link.inertia;
  return fmt::format(
      "    <inertial>\n      <origin xyz=\"{}\" rpy=\"0 0 0\"/>\n      <mass value=\"{}\"/>\n"
      "      <inertia ixx=\"{}\" ixy=\"{}\" ixz=\"{}\" iyy=\"{}\" iyz=\"{}\" izz=\"{}\"/>\n"
      "    </inertial>\n",
      numbers(link.com), link.mass, I(0, 0), I(0, 1), I(0, 2), I(1, 1), I(1, 2), I(2, 2));
}

// Writes a joint. A slide's numbers are in units of its travel; the file's are in metres and
// newtons.
std::string joint_text(const Joint& joint, const std::string& parent, const std::string& child) {
  const bool slides = joint.kind == Joint::Kind::prismatic;
  const double unit = slides ? kSlideUnit : 1;
  const bool limited = std::isfinite(joint.lower) && std::isfinite(joint.upper);
  const std::string range =
      limited ? fmt::format(R"(lower="{}" upper="{}" )", joint.lower * unit, joint.upper * unit)
              : "";
  return fmt::format(
      "  <joint name=\"{}\" type=\"{}\">\n    {}\n    <parent link=\"{}\"/>\n"
      "    <child link=\"{}\"/>\n    <axis xyz=\"{}\"/>\n"
      "    <limit {}effort=\"{}\" velocity=\"10\"/>\n"
      "    <dynamics damping=\"{}\" friction=\"{}\"/>\n  </joint>\n",
      escaped(joint.name),
      slides    ? "prismatic"
      : limited ? "revolute"
                : "continuous",
      origin(joint.origin), parent, child, numbers(joint.axis), range, joint.effort / unit,
      joint.damping / (unit * unit), joint.friction / unit);
}

// Writes values that the format has no words for, see urdf_own.h.
std::string own(const ArmDescription& arm) {
  std::string springs;
  for (const Joint& joint : arm.joints) {
    if (joint.spring == 0 && joint.offset == 0) continue;
    const double unit = joint.kind == Joint::Kind::prismatic ? kSlideUnit : 1;
    springs += fmt::format("    <spring joint=\"{}\" stiffness=\"{}\" offset=\"{}\"/>\n",
                           escaped(joint.name), joint.spring / (unit * unit), joint.offset / unit);
  }
  std::string warmths;
  for (const Joint& joint : arm.joints) {
    if (!(joint.continuous > 0)) continue;
    const double unit = joint.kind == Joint::Kind::prismatic ? kSlideUnit : 1;
    warmths += fmt::format("    <warmth joint=\"{}\" continuous=\"{}\" time=\"{}\"/>\n",
                           escaped(joint.name), std::min(joint.continuous, joint.effort) / unit,
                           joint.warming);
  }
  std::string readings;
  if (arm.encoder_step > 0 || arm.assumed_delay > 0) {
    readings =
        fmt::format("    <readings step=\"{}\" delay=\"{}\"/>\n",
                    arm.encoder_step * (arm.only_slides() ? kSlideUnit : 1), arm.assumed_delay);
  }
  const std::string delay = arm.delay ? fmt::format(" delay=\"{}\"", *arm.delay) : "";
  return fmt::format("  <limpid gravity=\"{}\"{}>\n{}{}{}  </limpid>\n", numbers(arm.gravity),
                     delay, springs, warmths, readings);
}

}  // namespace

std::string urdf_text(const ArmDescription& arm, const std::string& remark) {
  std::string parent = "base";
  std::string out = fmt::format(
      "<?xml version=\"1.0\"?>\n<!-- {} -->\n<robot name=\"{}\">\n  <link name=\"base\">\n{}"
      "  </link>\n",
      as_comment(remark), escaped(arm.name), visuals(arm, -1));
  for (std::size_t i = 0; i < arm.joints.size(); ++i) {
    std::string child = escaped(arm.links[i].name);
    if (child == "base" || child == "tip") child += "_link";
    out += joint_text(arm.joints[i], parent, child);
    out += fmt::format("  <link name=\"{}\">\n{}{}  </link>\n", child, inertial(arm.links[i]),
                       visuals(arm, static_cast<int>(i)));
    parent = child;
  }
  out += fmt::format(
      "  <joint name=\"to_tip\" type=\"fixed\">\n    {}\n    <parent link=\"{}\"/>\n"
      "    <child link=\"tip\"/>\n  </joint>\n  <link name=\"tip\"/>\n",
      origin(arm.tip), parent);
  return out + own(arm) + "</robot>\n";
}

}  // namespace limpid
