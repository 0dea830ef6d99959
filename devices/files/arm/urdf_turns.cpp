#include "devices/files/arm/urdf_turns.h"

#include <tinyxml.h>

#include "devices/files/arm/urdf_numbers.h"
#include "devices/files/rpy.h"

namespace limpid {
namespace {

void set_turn(const TiXmlElement& of, urdf::Rotation& rotation) {
  const TiXmlElement* origin = of.FirstChildElement("origin");
  const char* rpy = origin != nullptr ? origin->Attribute("rpy") : nullptr;
  if (rpy == nullptr) return;
  const auto angles = numbers_in<3>(rpy);
  if (!angles) return;
  const Eigen::Quaterniond q = turn(*angles);
  rotation.setFromQuaternion(q.x(), q.y(), q.z(), q.w());
}

}  // namespace

void set_turns(const TiXmlElement& robot, urdf::ModelInterface& model) {
  for (const auto* each = robot.FirstChildElement(); each; each = each->NextSiblingElement()) {
    const char* name = each->Attribute("name");
    if (name == nullptr) continue;
    if (each->ValueStr() == "joint") {
      const auto joint = model.joints_.find(name);
      if (joint == model.joints_.end()) continue;
      set_turn(*each, joint->second->parent_to_joint_origin_transform.rotation);
    } else if (const TiXmlElement* body = each->FirstChildElement("inertial")) {
      const auto link = model.links_.find(name);
      if (link == model.links_.end() || !link->second->inertial) continue;
      set_turn(*body, link->second->inertial->origin.rotation);
    }
  }
}

}  // namespace limpid
