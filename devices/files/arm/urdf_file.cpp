#include "devices/files/arm/urdf_file.h"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <tinyxml.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>

#include "devices/files/arm/urdf_chain.h"
#include "devices/files/arm/urdf_dynamics.h"
#include "devices/files/arm/urdf_own.h"
#include "devices/files/arm/urdf_path.h"
#include "devices/files/arm/urdf_turns.h"
#include "devices/files/arm/urdf_visuals.h"
#include "devices/files/arm/xacro.h"
#include "devices/files/file_error.h"

namespace limpid {
namespace {

constexpr int kDeepestXml = 100;

// While it lives, urdfdom's complaints come here and not to the terminal.
class Complaints : public console_bridge::OutputHandler {
 public:
  Complaints() : before_(console_bridge::getOutputHandler()) {
    console_bridge::useOutputHandler(this);
  }
  ~Complaints() override { console_bridge::useOutputHandler(before_); }
  Complaints(const Complaints&) = delete;
  Complaints& operator=(const Complaints&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && all_.size() < 300) {
      all_ += (all_.empty() ? "" : "; ") + text;
    }
  }

  bool none() const { return all_.empty(); }

  std::string one_line() const {
    std::string line = none() ? "not a robot description" : all_;
    std::replace(line.begin(), line.end(), '\n', ' ');
    return line;
  }

 private:
  console_bridge::OutputHandler* before_;
  std::string all_;
};

// The XML parser recurses, so a file of nothing but opening tags would overflow the stack.
void check_depth(const std::string& text, const std::string& where) {
  int depth = 0;
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1)) {
    if (text.compare(at, 4, "<!--") == 0) {
      at = text.find("-->", at);
      if (at == std::string::npos) return;
      continue;
    }
    const char next = at + 1 < text.size() ? text[at + 1] : '\0';
    if (next == '!' || next == '?') continue;
    const auto end = text.find('>', at);
    if (next == '/') {
      --depth;
    } else if (end != std::string::npos && text[end - 1] != '/') {
      ++depth;
    }
    if (depth > kDeepestXml) throw FileError(fmt::format("{}: XML nested too deep", where));
  }
}

// Of the whole document, and what is in it.
void parse_xml(TiXmlDocument& document, const std::string& text, UrdfPlaces& places) {
  document.Parse(text.c_str());
  if (document.Error()) {
    throw FileError(fmt::format("{}:{}: not XML: {}", places.where,
                                std::max(document.ErrorRow(), 1), document.ErrorDesc()));
  }
  const TiXmlElement* robot = document.RootElement();
  if (robot == nullptr || robot->ValueStr() != "robot") {
    places.refuse("not URDF: the outermost element is not <robot>");
  }
  for (auto* each = robot->FirstChildElement(); each; each = each->NextSiblingElement()) {
    const char* name = each->Attribute("name");
    if (name == nullptr) continue;
    if (each->ValueStr() == "joint") places.joint_lines[name] = each->Row();
    if (each->ValueStr() == "link") places.link_lines[name] = each->Row();
  }
}

// "FILE:LINE" of the element that a complaint names, "FILE" if it names none.
std::string place_named_in(const std::string& complaint, const UrdfPlaces& places) {
  for (const auto* lines : {&places.link_lines, &places.joint_lines}) {
    for (const auto& [name, line] : *lines) {
      if (complaint.find('[' + name + ']') == std::string::npos &&
          complaint.find('\'' + name + '\'') == std::string::npos) {
        continue;
      }
      return fmt::format("{}:{}", places.where, line);
    }
  }
  return places.where;
}

// So that a recording, which has the text alone, has the same arm.
std::string with_tip(const std::string& text, const std::string& tip) {
  TiXmlElement own("limpid");
  own.SetAttribute("tip", tip);
  TiXmlPrinter printer;
  printer.SetStreamPrinting();
  own.Accept(&printer);
  const std::size_t end = text.rfind("</robot");
  return end == std::string::npos ? text : text.substr(0, end) + printer.Str() + text.substr(end);
}

urdf::ModelInterfaceSharedPtr parse_dynamics(const TiXmlElement& robot, UrdfPlaces& places) {
  const Complaints complaints;
  const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(urdf_dynamics(robot, places));
  // It drops an inertia that it cannot read and goes on; so whatever it complains of is refused.
  if (!model || !model->getRoot() || !complaints.none()) {
    const std::string what = complaints.one_line();
    throw FileError(fmt::format("{}: {}", place_named_in(what, places), what));
  }
  set_turns(robot, *model);
  return model;
}

}  // namespace

ArmDescription read_urdf(const std::filesystem::path& file, const std::string& tip) {
  return parse_urdf(urdf_text(file), file.string(), std::filesystem::absolute(file).parent_path(),
                    tip);
}

ArmDescription parse_urdf(const std::string& text, const std::string& where,
                          const std::filesystem::path& base_dir, const std::string& tip) {
  check_depth(text, where);
  UrdfPlaces places{where, {}, {}, {}};
  TiXmlDocument document;
  parse_xml(document, text, places);
  const TiXmlElement& robot = *document.RootElement();
  const urdf::ModelInterfaceSharedPtr model = parse_dynamics(robot, places);
  MeshFinder meshes(base_dir);
  const LinkShapes visuals = urdf_visuals(robot, meshes, places);
  const std::string own = own_tip(robot);
  ArmDescription arm =
      chain_of(*model, way_to_tip(*model, tip.empty() ? own : tip, places), visuals, places);
  read_own(robot, places, arm);
  arm.urdf = tip.empty() || tip == own ? text : with_tip(text, tip);
  arm.warnings = places.warnings;
  return arm;
}

}  // namespace limpid
