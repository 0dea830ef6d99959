#include "devices/files/urdf_file.h"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <tinyxml.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <mutex>

#include "core/base/utf8.h"
#include "devices/files/text_file.h"
#include "devices/files/urdf_chain.h"
#include "devices/files/urdf_path.h"
#include "devices/files/urdf_source.h"
#include "devices/files/urdf_values.h"
#include "devices/files/urdf_visuals.h"

namespace limpid {

namespace {

constexpr std::size_t kMostLinks = 5000;  // urdfdom destroys a long chain of links recursively

// Collects urdfdom's complaints while it lives, in place of the terminal. The program has one place
// for them: whoever else reads an arm meanwhile waits.
class Complaints : public console_bridge::OutputHandler {
 public:
  Complaints() : only_one_(mutex()), before_(console_bridge::getOutputHandler()) {
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
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }

  std::lock_guard<std::mutex> only_one_;
  console_bridge::OutputHandler* before_;
  std::string all_;
};

// Parses the whole document, and finds the lines of its joints and links.
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
  if (places.link_lines.size() > kMostLinks) {
    places.refuse(
        fmt::format("{} links; allowed: at most {}", places.link_lines.size(), kMostLinks));
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

// `text` with its tip named inside, so that a recording, which has the text alone, has the same
// arm.
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
  // urdfdom drops an inertia that it cannot read and goes on; therefore any complaint is refused.
  if (!model || !model->getRoot() || !complaints.none()) {
    const std::string what = complaints.one_line();
    throw FileError(fmt::format("{}: {}", place_named_in(what, places), what));
  }
  set_turns(robot, *model);
  return model;
}

}  // namespace

ArmDescription read_urdf(const std::filesystem::path& file, const std::string& tip, Xacro xacro) {
  return parse_urdf(urdf_text(file, xacro), file.string(),
                    std::filesystem::absolute(file).parent_path(), tip);
}

ArmDescription parse_urdf(const std::string& bytes, const std::string& where,
                          const std::filesystem::path& base_dir, const std::string& tip) {
  const std::string text = utf8_of(bytes);
  check_xml(text, where);
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
