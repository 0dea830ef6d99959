// What a URDF says in numbers: attributes, turns, what moves an arm, what is missing and what is
// Limpid's own.
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

// N finite numbers with spaces between, and nothing else; nothing where it is anything else. Null
// is an empty text.
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

// Where joints and links stand in a URDF, and what was found wrong there.
struct UrdfPlaces {
  std::string where;
  std::map<std::string, int> joint_lines;
  std::map<std::string, int> link_lines;
  std::vector<std::string> warnings;  // a line each for people

  // Errors: FileError, always.
  [[noreturn]] void refuse(const std::string& why) const;
  [[noreturn]] void refuse_joint(const std::string& name, const std::string& why) const;
  [[noreturn]] void refuse_link(const std::string& name, const std::string& why) const;
  // What an arm can do without, or with a guess.
  void warn(const std::string& what);
  void warn_joint(const std::string& name, const std::string& what);
  void warn_link(const std::string& name, const std::string& what);
};

// The part of a URDF that moves an arm.

// Links with their inertia and joints, as a URDF of its own: whatever else there is cannot trouble
// its reader. What the format asks for and real files leave out is filled in: limits of nothing but
// zeros are none, and slides without limits are held still, with a warning.
std::string urdf_dynamics(const TiXmlElement& robot, UrdfPlaces& places);

// Rotations of a URDF, the same to the last bit on every processor.

// urdfdom asks the system's mathematical library for them (see core/math/elementary.h): those of
// joints and of centres of mass are put into the model once more.
void set_turns(const TiXmlElement& robot, urdf::ModelInterface& model);

// What a URDF may leave out and an arm cannot do without: masses that only count as frames, efforts
// of 0.

// Every link stores energy as soon as its joint moves, so that M is positive definite in every
// pose: a link without inertia of its own gets a thousandth of what hangs on it.
// Errors: FileError for an arm, or an end of it, without any, and for inertias of no body.
void complete_inertias(ArmDescription& arm, UrdfPlaces& places);

// An effort of 0 says nothing: it becomes twice what holds the arm stretched out level.
void complete_efforts(ArmDescription& arm, UrdfPlaces& places);

// What a URDF says of an arm beyond its format, in elements <limpid> of the robot:
//
//     <limpid tip="LINK" gravity="0 0 -9.81" delay="0.002">
//       <spring joint="JOINT" stiffness="0.12" offset="0.01"/>
//     </limpid>
//
// gravity [m/s^2] in the base's frame, as the arm stands; delay [s] of the device that the arm was
// identified from; springs in N m/rad and N m, of slides in N/m and N: the joint is pulled by
// -(stiffness x + offset). Of what is said twice the last one holds.

// The link that it names as its tip; empty: none.
std::string own_tip(const TiXmlElement& robot);

// Everything else. Springs of joints that are not in the chain pull at nothing. Errors: FileError
// for what is no number or out of range, and joints that the robot does not have.
void read_own(const TiXmlElement& robot, const UrdfPlaces& places, ArmDescription& arm);

}  // namespace limpid
