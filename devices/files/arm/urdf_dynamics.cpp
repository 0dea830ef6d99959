#include "devices/files/arm/urdf_dynamics.h"

#include <fmt/format.h>
#include <tinyxml.h>

#include <initializer_list>
#include <string_view>
#include <vector>

namespace limpid {
namespace {

TiXmlElement with_children(const TiXmlElement& from, std::initializer_list<std::string_view> kept) {
  TiXmlElement out(from.ValueStr());
  for (const auto* each = from.FirstAttribute(); each; each = each->Next()) {
    out.SetAttribute(each->Name(), each->Value());
  }
  for (const auto* child = from.FirstChildElement(); child; child = child->NextSiblingElement()) {
    for (const std::string_view name : kept) {
      if (child->ValueStr() == name) out.InsertEndChild(*child);
    }
  }
  return out;
}

void fill_in(TiXmlElement& element, const char* attribute) {
  if (element.Attribute(attribute) == nullptr) element.SetAttribute(attribute, "0");
}

// As exporters write them where nobody filled in the form.
bool says_nothing(const TiXmlElement& limit) {
  for (const char* name : {"lower", "upper", "effort", "velocity"}) {
    const char* text = limit.Attribute(name);
    if (text != nullptr && std::string_view(text).find_first_not_of("0.+- ") != std::string::npos) {
      return false;
    }
  }
  return true;
}

// What had to be guessed, by the names of the joints.
struct Guessed {
  std::vector<std::string> unlimited;  // limits of zeros: none
  std::vector<std::string> fixed;      // slides without limits: held still
};

TiXmlElement joint_of(const TiXmlElement& from, Guessed& guessed) {
  TiXmlElement joint =
      with_children(from, {"origin", "parent", "child", "axis", "limit", "dynamics", "mimic"});
  TiXmlElement* const limit = joint.FirstChildElement("limit");
  const char* type = joint.Attribute("type");
  const char* name = joint.Attribute("name");
  const bool turns = type != nullptr && std::string_view(type) == "revolute";
  if (limit != nullptr && turns && name != nullptr && says_nothing(*limit)) {
    joint.SetAttribute("type", "continuous");
    guessed.unlimited.push_back(name);
  }
  if (limit == nullptr && name != nullptr && type != nullptr &&
      std::string_view(type) == "prismatic") {
    joint.SetAttribute("type", "fixed");
    guessed.fixed.push_back(name);
  }
  if (limit != nullptr) {
    fill_in(*limit, "effort");
    fill_in(*limit, "velocity");
  }
  if (TiXmlElement* dynamics = joint.FirstChildElement("dynamics")) {
    fill_in(*dynamics, "damping");
    fill_in(*dynamics, "friction");
  }
  return joint;
}

}  // namespace

std::string urdf_dynamics(const TiXmlElement& robot, UrdfPlaces& places) {
  TiXmlElement out("robot");
  const char* name = robot.Attribute("name");
  out.SetAttribute("name", name != nullptr ? name : "arm");
  Guessed guessed;
  for (const auto* each = robot.FirstChildElement(); each; each = each->NextSiblingElement()) {
    if (each->ValueStr() == "link") out.InsertEndChild(with_children(*each, {"inertial"}));
    if (each->ValueStr() == "joint") out.InsertEndChild(joint_of(*each, guessed));
  }
  if (!guessed.unlimited.empty()) {
    places.warn(
        fmt::format("limits of zeros: {}; taken as none", fmt::join(guessed.unlimited, ", ")));
  }
  if (!guessed.fixed.empty()) {
    places.warn(fmt::format("slides without a <limit>: {}; held still; a <limit> lets them move",
                            fmt::join(guessed.fixed, ", ")));
  }
  TiXmlDocument document;
  document.InsertEndChild(out);
  TiXmlPrinter printer;
  printer.SetStreamPrinting();
  document.Accept(&printer);
  return printer.Str();
}

}  // namespace limpid
