#include "devices/files/urdf_values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml.h>
#include <urdf_model/model.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string_view>
#include <vector>

#include "core/tick/parameters.h"
#include "devices/files/rpy.h"
#include "devices/files/text_file.h"
#include "devices/files/urdf_chain.h"

namespace limpid {

namespace {

std::string at(const std::string& where, const std::map<std::string, int>& lines, const char* kind,
               const std::string& name, const std::string& what) {
  const auto line = lines.find(name);
  return one_line(fmt::format("{}{}: {} '{}': {}", where,
                              line == lines.end() ? "" : fmt::format(":{}", line->second), kind,
                              name, what));
}

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

// Returns whether all limits are missing or zero, as exporters write them if nobody filled in the
// form.
bool says_nothing(const TiXmlElement& limit) {
  for (const char* name : {"lower", "upper", "effort", "velocity"}) {
    const char* text = limit.Attribute(name);
    if (text != nullptr && std::string_view(text).find_first_not_of("0.+- ") != std::string::npos) {
      return false;
    }
  }
  return true;
}

// Names of joints whose limits had to be guessed.
struct Guessed {
  std::vector<std::string> unlimited;  // limits of zeros, taken as none
  std::vector<std::string> fixed;      // slides without limits, held still
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

void set_turn(const TiXmlElement& of, urdf::Rotation& rotation) {
  const TiXmlElement* origin = of.FirstChildElement("origin");
  const char* rpy = origin != nullptr ? origin->Attribute("rpy") : nullptr;
  if (rpy == nullptr) return;
  const auto angles = numbers_in<3>(rpy);
  if (!angles) return;
  const Eigen::Quaterniond q = turn(*angles);
  rotation.setFromQuaternion(q.x(), q.y(), q.z(), q.w());
}

constexpr double kLeastShare = 1e-6;   // least own inertia of a link, as a part of what hangs on it
constexpr double kGuess = 1e-3;        // part of what hangs on it that a link gets else
constexpr double kGravity = 9.81;      // [m/s^2]
constexpr double kLeastEffort = 0.01;  // [N m]

// Inertia about a joint; for a slide, mass along it in the same units [kg m^2].
double resistance(const Joint& joint, const Link& link) {
  if (slides(joint)) return link.mass * kSlideUnit * kSlideUnit;
  return joint.axis.dot(about_origin(link) * joint.axis);
}

// The largest resistance() of a body in any orientation [kg m^2].
double most_resistance(const Joint& joint, const Link& body) {
  if (slides(joint)) return resistance(joint, body);
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(about_origin(body), Eigen::EigenvaluesOnly);
  return solver.eigenvalues().maxCoeff();
}

void check_body(const Link& link, const UrdfPlaces& places) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(link.inertia, Eigen::EigenvaluesOnly);
  const double largest = link.inertia.cwiseAbs().maxCoeff();
  if (solver.eigenvalues().minCoeff() < -1e-9 * largest) {
    places.refuse_link(link.name, "the inertia is impossible (a negative moment)");
  }
}

// Link i with all that hangs on it, joints at zero, in its frame.
Link outer(const ArmDescription& arm, std::size_t i) {
  Link all;
  Pose at = Pose::Identity();
  for (std::size_t j = i; j < arm.links.size(); ++j) {
    if (j > i) at = at * arm.joints[j].origin;
    merge(all, arm.links[j], at);
  }
  return all;
}

std::string list(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

constexpr double kFarthest = 1e6;          // of an origin, along each axis [m]
constexpr double kMostGravity = 30;        // [m/s^2]
constexpr double kStiffest = 1e4;          // [N m/rad]
constexpr double kLongestDelay = 1;        // [s]
constexpr double kLargestOffset = 1e3;     // [N m]
constexpr double kLeastContinuous = 1e-3;  // part of a joint's effort
constexpr double kShortestWarming = 0.1;   // [s]
constexpr double kLongestWarming = 1e5;    // [s]

class Own {
 public:
  Own(const TiXmlElement& element, const UrdfPlaces& places) : element_(element), places_(places) {}

  [[noreturn]] void refuse(const std::string& why) const {
    throw FileError(one_line(
        fmt::format("{}:{}: <{}> {}", places_.where, element_.Row(), element_.ValueStr(), why)));
  }
  // A number from `least` to `most`; nothing if the attribute is missing.
  std::optional<double> number(const char* name, double least, double most,
                               const char* unit) const {
    const char* text = element_.Attribute(name);
    if (text == nullptr) return std::nullopt;
    const auto found = numbers_in<1>(text);
    if (!found || !((*found)[0] >= least && (*found)[0] <= most)) {
      refuse(fmt::format("{} \"{}\"; allowed: {:.6g} to {:.6g} {}", name, text, least, most, unit));
    }
    return (*found)[0];
  }
  std::optional<Vec3> gravity() const {
    const char* text = element_.Attribute("gravity");
    if (text == nullptr) return std::nullopt;
    const auto found = numbers_in<3>(text);
    if (!found || found->norm() > kMostGravity) {
      refuse(fmt::format("gravity \"{}\"; needed: X Y Z in m/s^2, with a length of at most {}",
                         text, kMostGravity));
    }
    return Vec3(*found);
  }

 private:
  const TiXmlElement& element_;
  const UrdfPlaces& places_;
};

// The name of the joint that an element is about, one of the robot's.
std::string joint_named(const Own& own, const TiXmlElement& element, const UrdfPlaces& places) {
  const char* name = element.Attribute("joint");
  if (name == nullptr || !places.joint_lines.contains(name)) {
    own.refuse(
        fmt::format("joint \"{}\"; needed: a joint of this robot", name == nullptr ? "" : name));
  }
  return name;
}

void read_warmth(const TiXmlElement& element, const UrdfPlaces& places, ArmDescription& arm) {
  const Own own(element, places);
  const auto joint = std::ranges::find(arm.joints, joint_named(own, element, places), &Joint::name);
  if (joint == arm.joints.end()) return;
  const bool slides = joint->kind == Joint::Kind::prismatic;
  const double unit = slides ? kSlideUnit : 1, effort = joint->effort / unit;
  const auto continuous =
      own.number("continuous", kLeastContinuous * effort, effort, slides ? "N" : "N m");
  const auto time = own.number("time", kShortestWarming, kLongestWarming, "s");
  if (!continuous || !time)
    own.refuse("has no attribute continuous or no attribute time; needed: both");
  joint->continuous = *continuous * unit;
  joint->warming = *time;
}

void read_readings(const TiXmlElement& element, const UrdfPlaces& places, ArmDescription& arm) {
  const Own own(element, places);
  const bool slides = arm.only_slides();
  const double unit = slides ? kSlideUnit : 1;
  if (const auto step = own.number("step", 0, kMostEncoderStep * unit, slides ? "m" : "rad")) {
    arm.encoder_step = *step / unit;
  }
  if (const auto delay = own.number("delay", 0, kLongestDelay, "s")) arm.assumed_delay = *delay;
}

void read_spring(const TiXmlElement& element, const UrdfPlaces& places, ArmDescription& arm) {
  const Own own(element, places);
  const std::string name = joint_named(own, element, places);
  const double stiffness = own.number("stiffness", -kStiffest, kStiffest, "N m/rad").value_or(0);
  const double offset = own.number("offset", -kLargestOffset, kLargestOffset, "N m").value_or(0);
  const auto joint = std::ranges::find(arm.joints, name, &Joint::name);
  if (joint == arm.joints.end()) return;
  const double unit = joint->kind == Joint::Kind::prismatic ? kSlideUnit : 1;
  joint->spring = stiffness * unit * unit;
  joint->offset = offset * unit;
}

}  // namespace

std::string refused_origin(const Vec3& xyz) {
  if ((xyz.array().abs() <= kFarthest).all()) return {};
  return fmt::format("origin xyz \"{} {} {}\"; allowed: {} to {} m along each axis", xyz.x(),
                     xyz.y(), xyz.z(), -kFarthest, kFarthest);
}

void UrdfPlaces::refuse(const std::string& why) const {
  throw FileError(fmt::format("{}: {}", where, why));
}

void UrdfPlaces::refuse_joint(const std::string& name, const std::string& why) const {
  throw FileError(at(where, joint_lines, "joint", name, why));
}

void UrdfPlaces::refuse_link(const std::string& name, const std::string& why) const {
  throw FileError(at(where, link_lines, "link", name, why));
}

void UrdfPlaces::warn(const std::string& what) {
  warnings.push_back(one_line(fmt::format("{}: {}", where, what)));
}

void UrdfPlaces::warn_joint(const std::string& name, const std::string& what) {
  warnings.push_back(at(where, joint_lines, "joint", name, what));
}

void UrdfPlaces::warn_link(const std::string& name, const std::string& what) {
  warnings.push_back(at(where, link_lines, "link", name, what));
}

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
    places.warn(fmt::format("all values in <limit> are zero: {}; Limpid assumes no limits",
                            fmt::join(guessed.unlimited, ", ")));
  }
  if (!guessed.fixed.empty()) {
    places.warn(
        fmt::format("sliding joints without a <limit>: {}; these joints are held still; with a "
                    "<limit> they can move",
                    fmt::join(guessed.fixed, ", ")));
  }
  TiXmlDocument document;
  document.InsertEndChild(out);
  TiXmlPrinter printer;
  printer.SetStreamPrinting();
  document.Accept(&printer);
  return printer.Str();
}

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

void complete_inertias(ArmDescription& arm, UrdfPlaces& places) {
  for (const Link& link : arm.links) check_body(link, places);
  if (const Link all = outer(arm, 0); !(all.mass > 0) && !(all.inertia.norm() > 0)) {
    places.refuse(
        "no link that moves has an <inertial>; needed: mass and inertia of each link, for example "
        "from CAD or a data sheet");
  }
  std::vector<std::string> guessed;
  for (std::size_t i = arm.links.size(); i-- > 0;) {
    Link& link = arm.links[i];
    const Joint& joint = arm.joints[i];
    const Link all = outer(arm, i);
    const double most = most_resistance(joint, all);
    if (resistance(joint, link) > kLeastShare * most) continue;
    if (!(most > 0 && std::isfinite(most))) {
      places.refuse_link(
          link.name,
          fmt::format("inertia {:.3g} kg m^2 about joint '{}', and no link after this joint has an "
                      "inertia; needed: more than 0 (in the <inertial> of this link or of links "
                      "fixed to it), or a tip before this joint (--tip LINK)",
                      resistance(joint, link), joint.name));
    }
    const double least = kGuess * most;
    if (slides(joint)) {
      link.mass += kGuess * all.mass;
    } else {
      link.inertia += least * Mat3::Identity();
    }
    guessed.push_back(fmt::format("'{}' ({:.2g})", link.name, least));
  }
  if (guessed.empty()) return;
  std::ranges::reverse(guessed);
  places.warn(
      fmt::format("links without inertia, or with nearly none: {}; Limpid assumes a thousandth of "
                  "the inertia that each link carries [kg m^2]; write the true mass and inertia, "
                  "in kg and kg m^2, in <inertial>",
                  list(guessed)));
}

void complete_efforts(ArmDescription& arm, UrdfPlaces& places) {
  std::vector<std::string> guessed;
  double weight = 0, moment = 0;  // of all beyond the joint, stretched out [N, N m]
  for (std::size_t i = arm.joints.size(); i-- > 0;) {
    Joint& joint = arm.joints[i];
    const Link& link = arm.links[i];
    if (i + 1 < arm.joints.size()) {
      moment += weight * arm.joints[i + 1].origin.translation().norm();
    }
    moment += kGravity * link.mass * link.com.norm();
    weight += kGravity * link.mass;
    if (joint.effort != 0) continue;
    joint.effort = std::max(kLeastEffort, 2 * (slides(joint) ? weight * kSlideUnit : moment));
    guessed.push_back(slides(joint)
                          ? fmt::format("'{}' ({:.2g} N)", joint.name, joint.effort / kSlideUnit)
                          : fmt::format("'{}' ({:.2g} N m)", joint.name, joint.effort));
  }
  if (guessed.empty()) return;
  std::ranges::reverse(guessed);
  places.warn(fmt::format(
      "no effort in <limit>: {}; Limpid assumes twice the torque that holds the stretched arm",
      list(guessed)));
}

std::string own_tip(const TiXmlElement& robot) {
  std::string tip;
  for (auto* own = robot.FirstChildElement("limpid"); own;
       own = own->NextSiblingElement("limpid")) {
    if (const char* link = own->Attribute("tip")) tip = link;
  }
  return tip;
}

// Warns of attributes and elements in one of Limpid's own that it does not know.
void warn_of_unknown(const TiXmlElement& own, const std::vector<std::string>& known,
                     UrdfPlaces& places) {
  const auto warn = [&](const char* kind, const std::string& name) {
    if (std::ranges::find(known, name) != known.end()) return;
    places.warn(
        fmt::format("line {}: <{}> has {} '{}', which Limpid does not know and ignores; known: {}",
                    own.Row(), own.ValueStr(), kind, name, fmt::join(known, ", ")));
  };
  for (auto* each = own.FirstAttribute(); each != nullptr; each = each->Next())
    warn("the attribute", each->NameTStr());
  for (auto* each = own.FirstChildElement(); each != nullptr; each = each->NextSiblingElement())
    warn("the element", each->ValueStr());
}

void read_own(const TiXmlElement& robot, UrdfPlaces& places, ArmDescription& arm) {
  for (auto* own = robot.FirstChildElement("limpid"); own;
       own = own->NextSiblingElement("limpid")) {
    const Own element(*own, places);
    warn_of_unknown(*own, {"tip", "gravity", "delay", "spring", "warmth", "readings"}, places);
    if (const auto gravity = element.gravity()) arm.gravity = *gravity;
    if (const auto delay = element.number("delay", 0, kLongestDelay, "s")) arm.delay = delay;
    const auto each = [&](const char* name, const std::vector<std::string>& known, auto read) {
      for (auto* one = own->FirstChildElement(name); one; one = one->NextSiblingElement(name)) {
        warn_of_unknown(*one, known, places);
        read(*one, places, arm);
      }
    };
    each("spring", {"joint", "stiffness", "offset"}, read_spring);
    each("warmth", {"joint", "continuous", "time"}, read_warmth);
    each("readings", {"joint", "step", "delay"}, read_readings);
  }
}

}  // namespace limpid
