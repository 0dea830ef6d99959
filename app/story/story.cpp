#include "app/story/story.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/base/assets.h"
#include "app/run/twin_settings.h"
#include "app/story/camera_words.h"
#include "app/story/story_hand.h"
#include "app/story/story_settings.h"
#include "devices/files/arm/urdf_file.h"
#include "devices/files/file_error.h"
#include "devices/files/scene/scene_file.h"
#include "devices/files/text_file.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestScript = 1 << 20;  // [bytes]
constexpr double kLongestStory = 3600;           // [s]
constexpr double kShortestStep = 0.1;            // [s]
constexpr std::size_t kLongestCaption = 140;     // two lines of a small picture [bytes]

std::array<std::string, 2> names_in(const TomlTable& step, const StorySettings& settings) {
  const auto said = names_said(step);
  return said ? *said : twin_names(settings.now(kMainLane), settings.now(kTwinLane));
}

std::string short_text(const TomlTable& table, const char* key, std::string text) {
  if (text.size() > kLongestCaption) {
    table.refuse(key, fmt::format("at most {} bytes of text", kLongestCaption));
  }
  return text;
}

// The story while it is read.
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
      return name ? beside_or_own(folder_, kind, *name) : otherwise;
    };
    RunPlan& plan = story_.plan;
    plan.arm = read_urdf(file("device", "devices", default_device()));
    plan.document = read_scene(file("scene", "scenes", default_scene()), plan.arm);
    plan.models = build_meshes(plan.document);
  }

  double begin_of(const TomlTable& step, std::size_t i) const {
    const double time = step.need(step.number("time", {0, kLongestStory, false, "s"}), "time");
    if (i == 0 && time != 0) step.refuse("time", "0 for the first step");
    return time;
  }

  void read_step(const TomlTable& step, double begins, double ends) {
    step.allow_only({"time", "caption", "mark", "names", "hand", "set", "first", "twin", "beside",
                     "anew", "camera"});
    if (!(ends >= begins + kShortestStep)) {
      step.refuse("time", fmt::format("at least {} s before what comes next, which is at {} s",
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
