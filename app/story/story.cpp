#include "app/story/story.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/base/folders.h"
#include "app/run/fitted_gains.h"
#include "app/run/lane_settings.h"
#include "core/dynamics/arm.h"
#include "core/dynamics/inverse_kinematics.h"
#include "devices/files/config_file.h"
#include "devices/files/scene/scene_file.h"
#include "devices/files/session/hand_file.h"
#include "devices/files/text_file.h"
#include "devices/files/urdf_file.h"

namespace limpid {

namespace {

constexpr std::array<const char*, 4> kViews{"front", "top", "side", "iso"};
constexpr Range kMetres{-10, 10, false, "m"};

Camera::View view_in(const TomlTable& table, const char* key) {
  return static_cast<Camera::View>(table.need(table.choice(key, kViews), key));
}

constexpr std::size_t kAll = kMostLanes;  // in place of a lane

// Returns the settings in a list of "key = value", with their lines.
std::vector<std::pair<std::string, std::uint32_t>> settings_in(const TomlTable& step,
                                                               const char* key) {
  std::vector<std::pair<std::string, std::uint32_t>> all;
  const toml::node* node = step.find(key);
  if (node == nullptr) return all;
  const char* allowed = "a list of settings, for example [\"coupling.eta = 0.6\", ...]";
  const toml::array* list = node->as_array();
  if (list == nullptr) step.refuse(key, allowed);
  for (const toml::node& each : *list) {
    if (!each.is_string()) step.refuse(key, allowed);
    all.emplace_back(*each.value<std::string>(), each.source().begin.line);
  }
  return all;
}

void check(const std::string& setting, std::size_t lane, double time) {
  const std::string key = key_of_setting(setting);
  const ParameterInfo* info = find_parameter(key);
  if (info == nullptr) return;  // apply_setting has a better message
  if (lane != kAll) check_of_one_lane(key, "write this setting under set");
  if (!info->live && time > 0) {
    throw ParameterError(fmt::format("{}: may be set only in the first step", info->key));
  }
}

constexpr double kFastest = 3;  // of a hand; faster it is a slip of the pen [m/s]
constexpr Range kSeconds{0, 3600};
constexpr Range kHandMetres{-10, 10};
const char* const kAllowed =
    "a file, or points [[seconds after the step's beginning, x, y, z], ...] in metres";

// Reads a point: t, x, y, z.
std::array<double, 4> point_in(const TomlTable& step, const toml::node& node) {
  const toml::array* list = node.as_array();
  if (list == nullptr || list->size() != 4) step.refuse("hand", kAllowed);
  std::array<double, 4> point{};
  for (std::size_t i = 0; i < point.size(); ++i) {
    const Range& range = i == 0 ? kSeconds : kHandMetres;
    const auto x = list->get(i)->value<double>();
    if (!list->get(i)->is_number() || !(*x >= range.minimum && *x <= range.maximum)) {
      step.refuse("hand", fmt::format("{}; times from 0 to {} s, points from {} to {} m", kAllowed,
                                      kSeconds.maximum, kHandMetres.minimum, kHandMetres.maximum));
    }
    point[i] = *x;
  }
  return point;
}

// Finds a file beside the script or among the program's own. Errors: FileError if it is in neither.
std::filesystem::path file_named(const TomlTable& table, const char* key,
                                 const std::filesystem::path& folder, const char* kind,
                                 const std::string& name) {
  std::filesystem::path found = beside_or_own(folder, kind, name);
  if (!std::filesystem::exists(found)) {
    table.refuse(key, "a file in the folder of the script, or one of " +
                          (data_dir() / "assets" / kind).string());
  }
  return found;
}

namespace fs = std::filesystem;

constexpr std::size_t kLongestScript = 1 << 20;  // [bytes]
constexpr double kLongestStory = 3600;           // [s]
constexpr double kShortestStep = 0.1;            // [s]
constexpr std::ptrdiff_t kLongestCaption = 140;  // two lines of a small picture [letters]

std::vector<std::string> names_in(const TomlTable& step, const StorySettings& settings) {
  const auto said = names_said(step);
  const std::size_t runs = settings.now().size();
  if (said && said->size() != runs) {
    step.refuse("names", fmt::format("{} names, one for each run", runs));
  }
  return said ? *said : lane_names(settings.now());
}

std::string short_text(const TomlTable& table, const char* key, std::string text) {
  // Letters are counted by the bytes that begin them in UTF-8.
  const auto begins = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; };
  if (std::ranges::count_if(text, begins) > kLongestCaption) {
    table.refuse(key, fmt::format("at most {} letters", kLongestCaption));
  }
  return text;
}

// Reader of a story's file.
class Reader {
 public:
  Reader(const TomlTable& file, const std::string& where, const fs::path& folder)
      : file_(file), where_(where), folder_(folder) {}

  Story read() {
    file_.allow_only({"title", "device", "scene", "seconds", "step"});
    story_.title = short_text(file_, "title", file_.need(file_.text("title"), "title"));
    read_world();
    const double end =
        file_.need(file_.number("seconds", {0, kLongestStory, true, "s"}), "seconds");
    const std::vector<TomlTable> steps = file_.tables("step");
    if (steps.empty()) file_.refuse_missing("step");
    fit_settings(steps[0]);
    StoryHand hand(story_.plan.arm, where_, folder_);
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const double begins = begin_of(steps[i], i);
      const double ends = i + 1 < steps.size() ? begin_of(steps[i + 1], i + 1) : end;
      read_step(steps[i], begins, ends);
      hand.read(steps[i], begins, ends);
    }
    story_.plan.hand = hand.path();
    settings_.into(story_.plan);
    story_.plan.rows = static_cast<std::uint64_t>(std::llround(end / story_.plan.parameters.tick));
    return std::move(story_);
  }

 private:
  void read_world() {
    const auto file = [&](const char* key, const char* kind, const fs::path& otherwise) {
      const auto name = file_.text(key);
      return name ? file_named(file_, key, folder_, kind, *name) : otherwise;
    };
    RunPlan& plan = story_.plan;
    plan.arm = read_urdf(file("device", "devices", default_device()));
    plan.document = read_scene(file("scene", "scenes", default_scene()), plan.arm);
    plan.models = build_meshes(plan.document);
  }

  // Lets settings that no step says fit the arm.
  void fit_settings(const TomlTable& first) {
    StorySettings asked;
    asked.read(first, where_, 0);
    settings_ = StorySettings(fitted(story_.plan.arm, asked.now()[0]));
  }

  double begin_of(const TomlTable& step, std::size_t i) const {
    const double time = step.need(step.number("time", {0, kLongestStory, false, "s"}), "time");
    if (i == 0 && time != 0) step.refuse("time", "0 for the first step");
    return time;
  }

  void read_step(const TomlTable& step, double begins, double ends) {
    step.allow_only({"time", "caption", "mark", "names", "hand", "set", "first", "twin", "lane3",
                     "beside", "anew", "camera"});
    if (!(ends >= begins + kShortestStep)) {
      step.refuse("time", fmt::format("at least {} s before the next event, which is at {} s",
                                      kShortestStep, ends));
    }
    settings_.read(step, where_, begins);
    StoryStep& read = story_.steps.emplace_back();
    read.begins = begins;
    read.ends = ends;
    read.caption = short_text(step, "caption", step.need(step.text("caption"), "caption"));
    read.mark = short_text(step, "mark", step.text("mark").value_or(""));
    read.names = names_in(step, settings_);
    read.beside = flag_in(step, "beside", true);
    read.anew = flag_in(step, "anew", false);
    read.camera = camera_said(step, where_);
  }

  const TomlTable& file_;
  const std::string& where_;
  const fs::path& folder_;
  StorySettings settings_;
  Story story_;
};

}  // namespace

const char* view_word(Camera::View view) { return kViews[static_cast<std::size_t>(view)]; }

std::optional<StoryCamera> camera_said(const TomlTable& step, const std::string& where) {
  const toml::node* node = step.find("camera");
  if (node == nullptr) return std::nullopt;
  if (node->is_string()) return StoryCamera{view_in(step, "camera")};
  if (!node->is_table()) {
    step.refuse("camera", "a view, or { view = \"side\", target = [x, y, z], size = 0.2 }");
  }
  const TomlTable table(*node->as_table(), where, "step.camera");
  table.allow_only({"view", "target", "size"});
  const Vec3 target = table.need(table.vector("target", kMetres), "target");
  const double size = table.need(table.number("size", {0.01, 10, false, "m"}), "size");
  return StoryCamera{view_in(table, "view"),
                     Bounds(target - Vec3::Constant(size / 2), target + Vec3::Constant(size / 2))};
}

std::optional<std::vector<std::string>> names_said(const TomlTable& step) {
  const toml::node* node = step.find("names");
  if (node == nullptr) return std::nullopt;
  const toml::array* list = node->as_array();
  const bool good = list != nullptr && list->size() >= 2 && list->size() <= kMostLanes &&
                    list->is_homogeneous(toml::node_type::string);
  if (!good) step.refuse("names", "a word for each run, for example [\"left\", \"right\"]");
  std::vector<std::string> names;
  for (const toml::node& name : *list) names.push_back(*name.value<std::string>());
  return names;
}

bool flag_in(const TomlTable& step, const char* key, bool otherwise) {
  const toml::node* node = step.find(key);
  if (node == nullptr) return otherwise;
  const auto said = node->value_exact<bool>();
  if (!said) step.refuse(key, "true, false");
  return *said;
}

void StorySettings::read(const TomlTable& step, const std::string& where, double time) {
  constexpr std::size_t kThird = 2;
  if (time == 0 && step.find(lane_name(kThird).c_str()) != nullptr)
    now_.resize(kThird + 1, now_[0]);
  const std::vector<Parameters> before = now_;
  changes_.resize(now_.size());
  for (const auto& [key, lane] :
       {std::pair{"set", kAll}, {"first", kMainLane}, {"twin", kTwinLane}, {"lane3", kThird}}) {
    if (lane == kThird && now_.size() <= kThird && step.find(key) != nullptr) {
      step.refuse(key,
                  "this key in later steps only if the first step has it too; the first step then "
                  "starts the third run");
    }
    for (const auto& [setting, line] : settings_in(step, key)) {
      try {
        check(setting, lane, time);
        for (std::size_t i = 0; i < now_.size(); ++i) {
          if (lane == kAll || lane == i) apply_setting(now_[i], setting);
        }
      } catch (const ParameterError& error) {
        throw FileError(fmt::format("{}:{}: step.{}: {}", where, line, key, error.what()));
      }
    }
  }
  if (time == 0) {
    began_ = now_;
    return;
  }
  for (std::size_t lane = 0; lane < now_.size(); ++lane) {
    for (const ParameterInfo* info : differing(now_[lane], before[lane])) {
      changes_[lane].push_back(
          {time, fmt::format("{} = {}", info->key, parameter_text(now_[lane], *info))});
    }
  }
}

void StorySettings::into(RunPlan& plan) const {
  const auto rows = [&](std::size_t lane) {
    std::vector<SettingChange> changes;
    for (const Change& change : changes_[lane]) {
      const auto row = std::llround(change.time / began_[kMainLane].tick);
      changes.push_back({static_cast<std::uint64_t>(row), change.setting});
    }
    return changes;
  };
  plan.parameters = began_[kMainLane];
  plan.changes = rows(kMainLane);
  for (std::size_t i = 1; i < began_.size(); ++i) plan.beside.push_back({began_[i], rows(i)});
}

void StoryHand::read(const TomlTable& step, double begins, double ends) {
  const toml::node* node = step.find("hand");
  if (node == nullptr) {
    if (time_.empty()) step.refuse_missing("hand");
  } else if (node->is_string()) {
    read_file(step, *node->value<std::string>(), begins, ends);
  } else {
    read_points(step, begins, ends);
  }
}

void StoryHand::read_points(const TomlTable& step, double begins, double ends) {
  const toml::array* list = step.find("hand")->as_array();
  if (list == nullptr || list->empty()) step.refuse("hand", kAllowed);
  double before = -1;
  for (const toml::node& each : *list) {
    const auto [t, x, y, z] = point_in(step, each);
    const std::uint32_t line = each.source().begin.line;
    if (!(t > before && begins + t < ends)) {
      throw FileError(
          fmt::format("{}:{}: step.hand: the time {} s follows {} s; allowed: times that increase, "
                      "before the step ends at {} s",
                      where_, line, t, std::max(before, 0.0), ends - begins));
    }
    if (before < 0 && t > 0) {
      const Vec3 here = position_.empty() ? Vec3(x, y, z) : position_.back();
      add(begins, here, line);  // the hand stays until then
    }
    add(begins + t, {x, y, z}, line);
    before = t;
  }
}

void StoryHand::read_file(const TomlTable& step, const std::string& file, double begins,
                          double ends) {
  const HandPath path = read_hand(file_named(step, "hand", folder_, "hands", file));
  const std::uint32_t line = step.find("hand")->source().begin.line;
  for (std::size_t i = 0; i < path.time.size() && begins + path.time[i] < ends; ++i) {
    add(begins + path.time[i], path.position[i], line);
  }
}

void StoryHand::add(double time, const Vec3& point, std::uint32_t line) {
  const auto refuse = [&](const std::string& why) {
    throw FileError(
        fmt::format("{}:{}: step.hand: the point ({:.4f}, {:.4f}, {:.4f}) m at {:.3f} s {}", where_,
                    line, point.x(), point.y(), point.z(), time, why));
  };
  if (near_.size() == 0) near_ = rest_pose(arm_);
  auto x = inverse_kinematics(arm_, point, near_);
  if (!x) x = inverse_kinematics(arm_, point, rest_pose(arm_));
  if (!x) refuse(fmt::format("is out of reach of the arm {} within its joint limits", arm_.name));
  near_ = *x;
  if (!time_.empty()) {
    const double passed = time - time_.back(), way = (point - position_.back()).norm();
    if (way > kFastest * passed) {
      refuse(fmt::format("is {:.3f} m from the point {:.3f} s before; allowed: up to {} m/s", way,
                         passed, kFastest));
    }
  }
  time_.push_back(time);
  position_.push_back(point);
}

HandPath StoryHand::path() const { return hand_through(time_, position_, where_); }

const StoryStep& step_at(const std::vector<StoryStep>& steps, double time) {
  const auto next = std::ranges::find_if(
      steps, [time](const StoryStep& step) { return step.begins > time + 1e-9; });
  return next == steps.begin() ? steps.front() : *(next - 1);
}

StoryCamera camera_in(const std::vector<StoryStep>& steps, const StoryStep& step) {
  StoryCamera camera;
  for (const StoryStep& each : steps) {
    if (each.camera) camera = *each.camera;
    if (each.begins >= step.begins) break;
  }
  return camera;
}

Story parse_story(const std::string& text, const std::string& where, const fs::path& folder) {
  const toml::table table = parse_toml(text, where);
  return Reader(TomlTable(table, where, ""), where, folder).read();
}

Story read_story(const fs::path& file) {
  return parse_story(read_text(file, kLongestScript), file.string(), file.parent_path());
}

fs::path default_story() { return data_dir() / "assets/stories/first.toml"; }

}  // namespace limpid
