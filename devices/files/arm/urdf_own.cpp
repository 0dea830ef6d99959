#include "devices/files/arm/urdf_own.h"

#include <fmt/format.h>
#include <tinyxml.h>

#include <algorithm>

#include "devices/files/arm/urdf_numbers.h"
#include "devices/files/file_error.h"

namespace limpid {
namespace {

constexpr double kMostGravity = 30;     // [m/s^2]
constexpr double kStiffest = 1e4;       // [N m/rad]
constexpr double kLongestDelay = 1;     // [s]
constexpr double kLargestOffset = 1e3;  // [N m]

class Own {
 public:
  Own(const TiXmlElement& element, const UrdfPlaces& places) : element_(element), places_(places) {}

  [[noreturn]] void refuse(const std::string& why) const {
    throw FileError(one_line(
        fmt::format("{}:{}: <{}> {}", places_.where, element_.Row(), element_.ValueStr(), why)));
  }
  // From `least` to `most`; nothing where it is not said.
  std::optional<double> number(const char* name, double least, double most,
                               const char* unit) const {
    const char* text = element_.Attribute(name);
    if (text == nullptr) return std::nullopt;
    const auto found = numbers_in<1>(text);
    if (!found || !((*found)[0] >= least && (*found)[0] <= most)) {
      refuse(fmt::format("{} \"{}\"; allowed: {} to {} {}", name, text, least, most, unit));
    }
    return (*found)[0];
  }
  std::optional<Vec3> gravity() const {
    const char* text = element_.Attribute("gravity");
    if (text == nullptr) return std::nullopt;
    const auto found = numbers_in<3>(text);
    if (!found || found->norm() > kMostGravity) {
      refuse(fmt::format("gravity \"{}\"; needed: X Y Z in m/s^2, {} at most", text, kMostGravity));
    }
    return Vec3(*found);
  }

 private:
  const TiXmlElement& element_;
  const UrdfPlaces& places_;
};

void read_spring(const TiXmlElement& element, const UrdfPlaces& places, ArmDescription& arm) {
  const Own own(element, places);
  const char* name = element.Attribute("joint");
  if (name == nullptr || !places.joint_lines.contains(name)) {
    own.refuse(
        fmt::format("joint \"{}\"; needed: a joint of this robot", name == nullptr ? "" : name));
  }
  const double stiffness = own.number("stiffness", -kStiffest, kStiffest, "N m/rad").value_or(0);
  const double offset = own.number("offset", -kLargestOffset, kLargestOffset, "N m").value_or(0);
  const auto joint = std::ranges::find(arm.joints, name, &Joint::name);
  if (joint == arm.joints.end()) return;
  const double unit = joint->kind == Joint::Kind::prismatic ? kSlideUnit : 1;
  joint->spring = stiffness * unit * unit;
  joint->offset = offset * unit;
}

}  // namespace

std::string own_tip(const TiXmlElement& robot) {
  std::string tip;
  for (auto* own = robot.FirstChildElement("limpid"); own;
       own = own->NextSiblingElement("limpid")) {
    if (const char* link = own->Attribute("tip")) tip = link;
  }
  return tip;
}

void read_own(const TiXmlElement& robot, const UrdfPlaces& places, ArmDescription& arm) {
  for (auto* own = robot.FirstChildElement("limpid"); own;
       own = own->NextSiblingElement("limpid")) {
    const Own element(*own, places);
    if (const auto gravity = element.gravity()) arm.gravity = *gravity;
    if (const auto delay = element.number("delay", 0, kLongestDelay, "s")) arm.delay = delay;
    for (auto* spring = own->FirstChildElement("spring"); spring;
         spring = spring->NextSiblingElement("spring")) {
      read_spring(*spring, places, arm);
    }
  }
}

}  // namespace limpid
