// Values in a URDF: numbers, rotations, dynamics, missing data, Limpid's own elements.
#pragma once

#include <Eigen/Core>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/dynamics/arm_description.h"

class TiXmlElement;

namespace urdf {
class ModelInterface;
}

namespace limpid {

template <int N>
using Numbers = Eigen::Matrix<double, N, 1>;

// N finite numbers separated by white space; nothing if the text is anything else. Null is an empty
// text.
template <int N>
std::optional<Numbers<N>> numbers_in(const char* text) {
  Numbers<N> out;
  const char* at = text == nullptr ? "" : text;
  const char* const end = at + std::strlen(at);
  const auto skip = [&] {
    while (at != end && std::isspace(static_cast<unsigned char>(*at))) ++at;
  };
  for (double& x : out) {
    skip();
    if (at != end && *at == '+') ++at;
    const auto read = std::from_chars(at, end, x);
    if (read.ec != std::errc() || !std::isfinite(x)) return std::nullopt;
    at = read.ptr;
  }
  skip();
  return at == end ? std::optional(out) : std::nullopt;
}

// Returns why the lengths of an <origin> are refused; empty if they are not.
std::string refused_origin(const Vec3& xyz);

// Lines of joints and links in a URDF, and what is wrong there.
struct UrdfPlaces {
  std::string where;
  std::map<std::string, int> joint_lines;
  std::map<std::string, int> link_lines;
  std::vector<std::string> warnings;  // a line each for people

  // Refuse a URDF. Errors: FileError, always.
  [[noreturn]] void refuse(const std::string& why) const;
  [[noreturn]] void refuse_joint(const std::string& name, const std::string& why) const;
  [[noreturn]] void refuse_link(const std::string& name, const std::string& why) const;
  // Warn of faults that an arm can do without, or with a guess.
  void warn(const std::string& what);
  void warn_joint(const std::string& name, const std::string& what);
  void warn_link(const std::string& name, const std::string& what);
};

// The links with their inertia and the joints, as a URDF of its own, so that nothing else can
// trouble its reader. Fills in what the format asks for and real files leave out: limits of zeros
// are taken as none, and slides without limits are held still, with a warning.
std::string urdf_dynamics(const TiXmlElement& robot, UrdfPlaces& places);

// Sets the rotations of joints and centres of mass once more, the same to the last bit on every
// processor. urdfdom computes them with the system's mathematical library (see
// core/math/elementary.h).
void set_turns(const TiXmlElement& robot, urdf::ModelInterface& model);

// Completes the inertias of links that only count as frames, so that M is positive definite in
// every pose: each link has to store energy when its joint moves. A link without inertia of its own
// gets a thousandth of what hangs on it. Errors: FileError for an arm, or an end of it, without any
// inertia, and for inertias of no body.
void complete_inertias(ArmDescription& arm, UrdfPlaces& places);

// Completes efforts of 0, which say nothing: each becomes twice the torque that holds the arm
// stretched out level.
void complete_efforts(ArmDescription& arm, UrdfPlaces& places);

// Limpid's own elements in a URDF, <limpid> of the robot:
//
//     <limpid tip="LINK" gravity="0 0 -9.81" delay="0.002">
//       <spring joint="JOINT" stiffness="0.12" offset="0.01"/>
//       <warmth joint="JOINT" continuous="0.17" time="60"/>
//       <readings step="4.19e-4" delay="0.001"/>
//     </limpid>
//
// gravity [m/s^2] in the base's frame, as the arm stands; delay [s] of the device that the arm was
// identified from. Springs in N m/rad and N m, of slides in N/m and N: each pulls its joint by
// -(stiffness x + offset). Warmth: the torque that the joint's motor bears for hours, in N m, of
// slides in N, at most its effort; and the time constant with which it warms up and cools [s].
// Readings: the step of the device's encoders in rad, of an arm that only slides in m; and the
// delay beyond the tick that is assumed of the device [s]. The last one holds where something is
// said twice.
//
// own_tip() returns the link named as the tip; empty: none.
std::string own_tip(const TiXmlElement& robot);

// Reads everything else of <limpid> into `arm`. Springs and warmth of joints outside of the chain
// have no effect. Errors: FileError for what is no number or out of range, and for joints that the
// robot does not have.
void read_own(const TiXmlElement& robot, UrdfPlaces& places, ArmDescription& arm);

}  // namespace limpid
