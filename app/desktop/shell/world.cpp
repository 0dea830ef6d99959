#include "app/desktop/shell/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "app/base/dated_file.h"
#include "app/base/folders.h"
#include "app/desktop/shell/desktop.h"
#include "app/run/fitted_gains.h"
#include "app/run/own_world.h"
#include "core/base/model_kinds.h"
#include "core/dynamics/arm.h"
#include "core/dynamics/farthest_tip.h"
#include "core/dynamics/inverse_kinematics.h"
#include "devices/files/scene/scene_document.h"
#include "devices/files/scene/scene_file.h"
#include "devices/files/text_file.h"
#include "devices/files/urdf_file.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kSaid = 3;  // warnings that fit beside the picture
constexpr auto kBetweenWorlds = std::chrono::milliseconds(33);

// Returns whether two arms have the same limits, which the loop takes only when it opens.
bool same_limits(const ArmDescription& one, const ArmDescription& other) {
  const auto same = [](const Joint& a, const Joint& b) {
    return a.effort == b.effort && a.continuous == b.continuous && a.warming == b.warming &&
           a.lower == b.lower && a.upper == b.upper;
  };
  return one.delay == other.delay && std::ranges::equal(one.joints, other.joints, same);
}

// Kinds of files in the order of opening: earlier ones change the world that later ones go into.
enum class DropKind : std::uint8_t { arm, scene, model, session, sweep, hand, unknown };

DropKind drop_kind(const fs::path& file) {
  std::error_code none;
  const std::string suffix = small_suffix(file);
  if (sweep_table_at(file)) return DropKind::sweep;
  if (fs::is_directory(file, none)) return DropKind::unknown;
  if (suffix == ".urdf" || suffix == ".xacro") return DropKind::arm;
  if (suffix == ".toml") return DropKind::scene;
  if (model_kind(file) != nullptr) return DropKind::model;
  if (suffix == ".h5") return DropKind::session;
  if (suffix == ".csv") return DropKind::hand;
  return DropKind::unknown;
}

std::string why_not_opened(const std::vector<fs::path>& files) {
  std::vector<std::string> names;
  names.reserve(files.size());
  for (const fs::path& file : files) names.push_back(file.filename().string());
  constexpr std::size_t kMost = 4;
  std::string text = fmt::format(
      "{}",
      fmt::join(names.begin(),
                names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), kMost)), ", "));
  if (names.size() > kMost) text += fmt::format(" and {} more", names.size() - kMost);
  return fmt::format(
      "{}: not opened. Drop models ({}), scenes (.toml), recordings (.h5), a sweep's folder or "
      "table, a hand's path (.csv) or an arm (.urdf) here.",
      text, model_suffixes());
}

}  // namespace

void World::open_given(const std::string& device, const std::string& tip,
                       const std::string& scene) {
  device_file_ = device.empty() ? default_device().string() : device;
  device_tip_ = tip;
  ArmDescription arm = load_arm(device_file_, tip, consent(device_file_)).arm;
  const fs::path file = scene.empty() ? default_scene(arm) : fs::absolute(scene);
  SceneDocument whole = read_scene(file, arm);
  if (std::ranges::none_of(whole.scene.objects, has_shape<Mesh>)) {
    d_.document.set_file(file.string());
    return open(std::move(arm), std::move(whole), {});
  }
  // Large models come in while the window is there already. Saving the scene without them must not
  // write over its own file.
  std::erase_if(whole.scene.objects, has_shape<Mesh>);
  whole.models.clear();
  whole.toml.clear();
  d_.document.set_file(default_scene(arm).string());
  open(std::move(arm), std::move(whole), {});
  first_scene_ = file.string();
  load_scene(file);
}

// Loads the scene for the arm that is there at its turn.
void World::load_scene(const fs::path& file) {
  d_.document.loader().open_scene(file, [this] { return d_.live.stage().arm(); });
}

void World::open_last(const std::string& device, const std::string& tip, const std::string& scene,
                      bool fixed) {
  std::string arm = device, end = tip, world = scene;
  expanded_ = device;  // a file on the command line may be expanded
  if (device.empty()) std::tie(arm, end) = last_arm();
  const ArmDescription first =
      read_urdf(arm.empty() ? default_device().string() : arm, end, consent(arm));
  if (fixed) d_.tuning.keep_as_they_are_for(first);
  if (scene.empty() && (device.empty() || suits_default_world(first))) world = d_.settings.scene;
  try {
    open_given(arm, end, world);
  } catch (const std::exception& e) {
    if (!scene.empty() || world.empty()) throw;
    open_given(arm, end, "");
    d_.notices.say(e.what(), true);
  }
  if (!arm.empty()) say_about_arm();
}

void World::open(ArmDescription arm, SceneDocument document, MeshModels models,
                 std::unique_ptr<Device> device, bool saved) {
  d_.tuning.end_break();
  Tuning::Suited suited = d_.tuning.suited(arm, device ? &device->traits() : nullptr);
  d_.live.open(std::move(arm), std::move(document), models, suited.lanes[kMainLane],
               d_.settings.plot_length, std::move(device));
  d_.tuning.take(std::move(suited));
  take_stage(std::move(models), saved);
}

// Takes the stage's scene as the one to edit.
void World::take_stage(MeshModels models, bool saved) {
  const Stage& stage = d_.live.stage();
  if (!d_.playback.on()) {
    d_.shown.reset_view();
    d_.shown.camera.finish();
  }
  d_.tuning.analyze_anew();
  d_.document.open(stage.arm(), stage.document(), std::move(models), saved);
  shown_ = d_.document.editor().version();
  touched_ = shown_.world;
}

void World::open_arm(const fs::path& file, const std::string& tip) {
  if (d_.live.recording()) {
    return d_.notices.say("Stop the recording (R) before you open another arm.", true);
  }
  if (d_.live.loop().device_in_place()) {
    return d_.notices.say(
        "A real device is used instead of the virtual arm. Choose the virtual arm first.", true);
  }
  const fs::path whole = fs::absolute(file).lexically_normal();
  d_.document.loader().open_arm(whole, tip, consent(whole));
}

Xacro World::consent(const fs::path& file) const {
  return !expanded_.empty() && file == expanded_ ? Xacro::expand : Xacro::refuse;
}

void World::ask_about(const XacroToExpand& arm) {
  xacro_ = arm;
  d_.dialog.open("expand xacro");
}

void World::expand_xacro() {
  expanded_ = xacro_->file.string();
  const bool known = expanded_ == d_.settings.device;  // file of the last time, with its tip
  open_arm(expanded_, known ? d_.settings.device_tip : std::string());
}

bool World::built_in_arm() const { return device_file_ == default_device(); }

// Returns the arm of the last time; the built-in one if its file is gone or spoilt.
std::pair<std::string, std::string> World::last_arm() {
  try {
    if (!d_.settings.device.empty()) read_urdf(d_.settings.device, d_.settings.device_tip);
    return {d_.settings.device, d_.settings.device_tip};
  } catch (const XacroToExpand& arm) {
    ask_about(arm);
    return {};
  } catch (const std::exception& e) {
    d_.notices.say(e.what(), true);
    d_.settings.device.clear();
    d_.settings.device_tip.clear();
    return {};
  }
}

void World::accept(LoadedArm& loaded) {
  const auto take = [this, loaded] { take_arm(loaded); };
  if (scene_for(loaded.arm)) return take();
  d_.document.leave(take);
}

// Returns the present scene for the arm, if both arms are of like size.
std::optional<SceneEditor::World> World::scene_for(const ArmDescription& arm) const {
  const double now = reach(arm), before = reach(d_.live.stage().arm());
  constexpr double kAlike = 1.5;
  if (now > kAlike * before || before > kAlike * now) return std::nullopt;
  return d_.document.scene_for(arm);
}

void World::take_arm(const LoadedArm& loaded) {
  d_.playback.close();
  if (auto scene = scene_for(loaded.arm)) {
    open(loaded.arm, std::move(scene->document), std::move(scene->models), nullptr,
         !d_.document.editor().dirty());
  } else {
    const fs::path file = default_scene(loaded.arm);
    SceneDocument document = read_scene(file, loaded.arm);
    MeshModels models = build_meshes(document);
    open(loaded.arm, std::move(document), std::move(models));
    d_.document.set_file(file.string());
    d_.settings.scene.clear();
  }
  const bool built_in = loaded.file == default_device();
  device_file_ = loaded.file.string();
  device_tip_ = loaded.tip;
  d_.settings.device = built_in ? "" : device_file_;
  d_.settings.device_tip = loaded.tip;
  if (!built_in) remember_recent(d_.settings, device_file_);
  say_about_arm();
}

void World::say_about_arm() {
  const ArmDescription& arm = d_.live.stage().arm();
  std::string text =
      fmt::format("Arm: {}, {} joint{} to {}, reach {:.2g} m.", arm.name, arm.dof(),
                  arm.dof() == 1 ? "" : "s", arm.tip_link, farthest_tip(arm).distance);
  if (!fit_text(fitted(arm)).empty()) text += " Gains are fitted to it.";
  d_.notices.say(text);
  for (std::size_t i = 0; i < std::min(kSaid, arm.warnings.size()); ++i) {
    d_.notices.say(arm.warnings[i]);
  }
  if (arm.warnings.size() > kSaid) {
    d_.notices.say(fmt::format("{} more warnings. To see them: limpid check {}",
                               arm.warnings.size() - kSaid,
                               fs::path(device_file_).filename().string()));
  }
}

void World::open_device(std::unique_ptr<Device> device) {
  d_.devices.plugged();
  const DeviceTraits& traits = device->traits();
  const ArmDescription& present = d_.live.stage().arm();
  if (DeviceSlot::guides(traits)) {
    const SceneEditor& editor = d_.document.editor();
    if (d_.live.loop().device_in_place()) {
      open(present, editor.document(), editor.models(), nullptr, !editor.dirty());
    }
    return d_.live.loop().plug(std::move(device));
  }
  const bool in_place = d_.live.loop().device_in_place();
  const TakenArm taken = d_.devices.hub().arm_for(traits);
  d_.notices.say(taken.why, !taken.known);
  if (!in_place) virtual_arm_ = present;
  const ArmDescription& arm = taken.arm;
  const bool same_arm = in_place && arm.urdf == present.urdf;
  const bool warmed_beside = d_.live.loop().warmth_memory()->added(arm.dof());
  if (same_arm && same_limits(arm, present) && !warmed_beside) {
    return d_.live.loop().plug(std::move(device));
  }
  d_.playback.close();
  if (!same_arm) return change_arm(arm, std::move(device));
  const SceneEditor& editor = d_.document.editor();
  open(arm, editor.document(), editor.models(), std::move(device), !editor.dirty());
}

void World::close_device(const std::function<void()>& then) {
  if (!d_.live.loop().device_in_place()) {
    d_.live.loop().plug(nullptr);
    return then();
  }
  const auto leave = [this, then] {
    if (virtual_arm_again()) then();
  };
  if (d_.document.waiting() != nullptr) return d_.document.leave(leave);
  leave();
}

// Puts the virtual arm back: as its file has it, else as it was, else as the waiting scene had it.
// Returns false, and the device stays, if none of these can be opened.
bool World::virtual_arm_again() {
  std::vector<ArmDescription> arms;
  try {
    arms.push_back(read_urdf(device_file_, device_tip_, consent(device_file_)));
  } catch (const std::exception& e) {
    d_.notices.say(fmt::format("{} The previous arm is still in use.", e.what()), true);
  }
  if (virtual_arm_) arms.push_back(*virtual_arm_);
  if (const SetAside* waiting = d_.document.waiting()) arms.push_back(waiting->arm);
  std::string why;
  for (const ArmDescription& arm : arms) {
    try {
      if (d_.document.waiting() != nullptr) {
        take_up_set_aside(arm);
      } else {
        change_arm(arm, nullptr);
      }
      return true;
    } catch (const std::exception& e) {
      why = e.what();
    }
  }
  d_.notices.say(
      fmt::format("The device stays in use, because the virtual arm cannot be opened: {}", why),
      true);
  return false;
}

// Changes the arm. If arm or scene are refused, everything stays as it is.
void World::change_arm(const ArmDescription& arm, std::unique_ptr<Device> device) {
  if (auto scene = d_.document.scene_for(arm)) {
    return open(arm, std::move(scene->document), std::move(scene->models), std::move(device),
                !d_.document.editor().dirty());
  }
  SetAside present = d_.document.to_set_aside();
  const std::filesystem::path file = scene_of_device(arm);
  open(arm, read_scene(file, arm), {}, std::move(device));
  d_.document.set_aside(std::move(present));
  d_.document.set_file(file.string());
}

// Brings back the scene that a device's own scene has replaced, with its changes. The scene goes on
// waiting if this arm cannot have it.
void World::take_up_set_aside(const ArmDescription& arm) {
  const SetAside& waiting = *d_.document.waiting();
  auto scene = Document::scene_for(arm, waiting);
  if (!scene) {
    throw std::runtime_error(
        fmt::format("the scene that was open before, {}, is made for a different arm than {}",
                    fs::path(waiting.file).filename().string(), arm.name));
  }
  open(arm, std::move(scene->document), std::move(scene->models), nullptr, !waiting.unsaved);
  d_.document.set_file(waiting.file);
  d_.document.end_waiting();
}

World::Place World::place() const {
  return {d_.live.stage().arm(), device_file_,
          device_tip_,           d_.live.loop().device_in_place(),
          d_.document.file(),    d_.document.editor().version().world};
}

void World::go_to(const Place& place) {
  const bool with_device = d_.live.loop().device_in_place();
  if (with_device != place.with_device ||
      (with_device && place.arm.urdf != d_.live.stage().arm().urdf)) {
    if (!place.file.empty()) load_scene(place.file);
    return;
  }
  SceneDocument document = place.world->document;
  MeshModels models = place.world->models;
  if (with_device) {
    d_.cut_force();
    d_.live.open_beside(std::move(document), models, d_.settings.parameters(),
                        d_.settings.plot_length);
    take_stage(std::move(models), true);
  } else {
    open(place.arm, std::move(document), std::move(models));
    device_file_ = place.device_file;
    device_tip_ = place.device_tip;
  }
  d_.document.set_file(place.file);
}

std::string World::why_fixed() const {
  if (d_.live.recording()) {
    return "Stop the recording (R) before you change the scene, because the scene is part of the "
           "recording.";
  }
  return d_.playback.on() ? "This scene belongs to a recording. Go back to live (Backspace) to "
                            "change your own scene."
                          : "";
}

// Leaves the scene, after the user was asked about unsaved changes.
void World::leave_for_scene(std::function<void()> then) {
  if (d_.live.recording()) {
    d_.notices.say("Stop the recording (R) before you open another scene.", true);
    return;
  }
  d_.document.leave([this, then = std::move(then)] {
    d_.playback.close();
    if (!d_.document.loader().opening_arm()) d_.document.loader().cancel();
    first_scene_.clear();
    then();
  });
}

void World::open_scene(const fs::path& file) {
  leave_for_scene([this, file = fs::absolute(file).lexically_normal()] { load_scene(file); });
}

void World::new_scene() {
  leave_for_scene([this] {
    LoadedScene fresh;
    for (int i = 1; fresh.file.empty() || fs::exists(fresh.file); ++i) {
      fresh.file = scenes_dir() / (i == 1 ? "untitled.toml" : fmt::format("untitled-{}.toml", i));
    }
    fresh.document.title = "Untitled";
    fresh.document.scene.tip_radius = 0.004;
    fresh.document.scene.add(
        {.name = "table top", .pose = pose_at({0.2, 0, -0.04}), .shape = Plane{}});
    fresh.models.resize(1);
    fresh.urdf = d_.live.stage().arm().urdf;
    first_scene_ = fresh.file.string();  // not opened at the next start while no file has it
    accept(fresh);
  });
}

void World::add_model(const fs::path& file) {
  if (d_.document.may_edit()) d_.document.loader().add_model(file);
}

void World::take_loaded() {
  if (d_.live.recording()) return;  // loaded files wait
  try {
    if (auto loaded = d_.document.loader().take()) {
      std::visit([this](auto& what) { accept(what); }, *loaded);
    }
  } catch (const XacroToExpand& arm) {
    ask_about(arm);
  } catch (const TipsToChoose& choice) {
    tips_ = choice;
    d_.dialog.open("arm tip");
  } catch (const std::exception& e) {
    d_.notices.say(e.what(), true);
  }
}

void World::accept(LoadedScene& loaded) {
  // A device has brought its arm meanwhile: the scene's joints and links have to be that arm's.
  if (loaded.urdf != d_.live.stage().arm().urdf) return load_scene(loaded.file);
  d_.tuning.end_break();
  if (d_.live.loop().device_in_place()) {
    d_.cut_force();
    d_.live.open_beside(std::move(loaded.document), loaded.models, d_.settings.parameters(),
                        d_.settings.plot_length);
    take_stage(std::move(loaded.models), true);
  } else {
    open(d_.live.stage().arm(), std::move(loaded.document), std::move(loaded.models));
  }
  const std::string file = loaded.file.string();
  if (file == std::exchange(first_scene_, "")) {
    d_.document.set_file(file);
  } else if (file != d_.document.file()) {
    d_.document.remember_file(file);
    remember_recent(d_.settings, file);
  }
  const std::string& title = d_.live.stage().document().title;
  d_.notices.say(fmt::format("Scene: {}", title.empty() ? loaded.file.filename().string() : title));
  for (const std::string& warning : loaded.warnings) d_.notices.say(warning);
}

void World::accept(LoadedModel& loaded) { d_.document.add_model(std::move(loaded), workplace()); }

// Returns the present places of the arm, its tips and other objects.
Workplace World::workplace() const {
  const Stage& stage = d_.live.stage();
  const ArmDescription& arm = stage.arm();
  Workplace at;
  at.base = arm.joints.front().origin.translation();
  at.reach = reach(arm);
  at.rest = rest_tip(arm);
  const RowLayout& layout = d_.live.loop().layout();
  at.tips = {stage.rows().tip(layout.in(d_.live.row(), Column::device_position)),
             stage.rows().tip(layout.in(d_.live.row(), Column::proxy_position))};
  const SceneEditor& editor = d_.document.editor();
  const std::vector<Object>& objects = editor.scene().objects;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Bounds box = bounds_of(objects[i], editor.models()[i].get());
    if (!box.isEmpty()) at.taken.push_back(box);
  }
  return at;
}

void World::add_object(Object object) { d_.document.add_object(std::move(object), workplace()); }

void World::show_scene() {
  const SceneEditor::Version& now = d_.document.editor().version();
  if (now.world == shown_.world && now.selected == shown_.selected) return;
  try {
    d_.live.stage().show(now.world->document, now.world->models, now.selected);
  } catch (const std::exception& e) {
    d_.notices.say(e.what(), true);
  }
  shown_ = now;
}

// Gives changes of the scene to the loop, seldom enough for a drag not to keep it busy.
void World::hand_scene_over(bool at_once) {
  const auto now = std::chrono::steady_clock::now();
  if (d_.document.editor().version().world == touched_ || d_.live.recording()) return;
  if (!at_once && now - touched_since_ < kBetweenWorlds) return;
  take_up(d_.document.editor());
  touched_ = d_.document.editor().version().world;
  touched_since_ = now;
}

// Takes up another number of bodies by opening another loop, at rest, as rows have room for so many
// only.
void World::take_up(const SceneEditor& editor) {
  const int bodies = count_bodies(editor.scene());
  if (bodies == d_.live.loop().layout().bodies()) return d_.live.touch(editor.scene());
  if (d_.live.loop().device_in_place()) {
    d_.notices.say("Choose the virtual arm before you add or remove objects that move.", true);
    return;
  }
  try {
    d_.live.open(ArmDescription(d_.live.stage().arm()), editor.document(), editor.models(),
                 d_.settings.parameters(), d_.settings.plot_length, nullptr);
  } catch (const std::exception& e) {
    d_.notices.say(e.what(), true);
  }
  shown_ = {};  // the new stage does not know the selection
}

void World::toggle_recording() {
  d_.live.loop().recording() ? d_.live.stop_recording() : record({});
}

void World::record(const fs::path& file, bool replaces) {
  if (!d_.live.may_record()) return;
  try {
    start_recording(file, replaces);
  } catch (const std::exception& e) {
    d_.notices.say(e.what(), true);
  }
}

void World::start_recording(fs::path file, bool replaces) {
  d_.playback.close();
  if (file.empty()) file = dated_file(sessions_dir(), "session", "h5");
  RunPlan plan;
  plan.arm = d_.live.stage().arm();
  plan.document = d_.document.editor().document();
  plan.document.toml = d_.document.toml();
  const LiveLoop& loop = d_.live.loop();
  plan.hand.source = loop.device_in_place() ? loop.device_source() : "mouse";
  plan.parameters = d_.live.loop().taken(d_.settings.parameters());
  const std::size_t lanes = d_.live.loop().device_in_place() ? 1 : d_.settings.lanes.count;
  for (std::size_t i = 1; i < lanes; ++i) {
    plan.beside.push_back({d_.settings.lanes.parameters[i], {}});
  }
  hand_scene_over(true);
  if (plan.layout().bodies() != d_.live.loop().layout().bodies()) {
    d_.notices.say(
        "Limpid cannot record: objects that move were added or removed while a real device was "
        "in use. Choose the virtual arm, then record.",
        true);
    return;
  }
  d_.live.record(plan, file, replaces);
}

void World::open_files(const std::vector<fs::path>& files) {
  std::vector<fs::path> sorted = files, unknown;
  std::ranges::stable_sort(sorted, {}, drop_kind);
  for (const fs::path& file : sorted) {
    try {
      switch (drop_kind(file)) {
        case DropKind::arm: open_arm(file); break;
        case DropKind::scene: open_scene(file); break;
        case DropKind::model: add_model(file); break;
        case DropKind::session: d_.playback.open(file); break;
        case DropKind::sweep: open_sweep(*sweep_table_at(file)); break;
        case DropKind::hand: run_hand(file); break;
        case DropKind::unknown: unknown.push_back(file); break;
      }
    } catch (const std::exception& e) {
      d_.notices.say(e.what(), true);
    }
  }
  if (!unknown.empty()) d_.notices.say(why_not_opened(unknown), true);
}

void World::open_sweep(const fs::path& table) {
  std::error_code none;
  d_.sweep.open(fs::weakly_canonical(table, none));
  d_.dialog.open("sweep");
}

// Runs a hand's path as fast as possible in the present world, and plays the result.
void World::run_hand(const fs::path& file) {
  RunPlan plan;
  plan.arm = d_.live.stage().arm();
  plan.document = d_.document.editor().document();
  plan.document.toml = d_.document.toml();
  plan.models = d_.document.editor().models();
  plan.parameters = d_.settings.parameters();
  d_.playback.run_hand(file, std::move(plan));
}

void World::hand_over(bool at_once) {
  show_scene();
  hand_scene_over(at_once);
}

}  // namespace limpid
