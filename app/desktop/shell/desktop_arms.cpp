// What the desktop does with arms.
#include <fmt/format.h>

#include "app/base/folders.h"
#include "app/desktop/base/passivity_break.h"
#include "app/desktop/shell/desktop.h"
#include "app/run/fitted_gains.h"
#include "app/run/own_world.h"
#include "core/dynamics/farthest_tip.h"
#include "core/dynamics/inverse_kinematics.h"
#include "devices/files/scene/scene_file.h"
#include "devices/files/urdf_file.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kSaid = 3;  // warnings that fit beside the picture

}  // namespace

void Desktop::open_arm(const fs::path& file, const std::string& tip) {
  if (desk_.recording()) {
    return notices_.say("Stop the recording (R) before opening another arm.", true);
  }
  if (desk_.loop().device_in_place()) {
    return notices_.say("A real device is in the arm's place. Choose the virtual arm first.", true);
  }
  const fs::path whole = fs::absolute(file).lexically_normal();
  document_.loader().open_arm(whole, tip, consent(whole));
}

Xacro Desktop::consent(const fs::path& file) const {
  return !expanded_.empty() && file == expanded_ ? Xacro::expand : Xacro::refuse;
}

void Desktop::ask_about(const XacroToExpand& arm) {
  xacro_ = arm;
  open_dialog(Dialog::expand_xacro);
}

void Desktop::expand_xacro() {
  expanded_ = xacro_->file.string();
  const bool known = expanded_ == settings_.device;  // that of the last time, with its tip
  open_arm(expanded_, known ? settings_.device_tip : std::string());
}

void Desktop::use_built_in_arm() { open_arm(default_device()); }

bool Desktop::built_in_arm() const { return device_file_ == default_device(); }

// Of the last time; the built-in one if its file is gone or spoilt.
std::pair<std::string, std::string> Desktop::last_arm() {
  try {
    if (!settings_.device.empty()) read_urdf(settings_.device, settings_.device_tip);
    return {settings_.device, settings_.device_tip};
  } catch (const XacroToExpand& arm) {
    ask_about(arm);
    return {};
  } catch (const std::exception& e) {
    notices_.say(e.what(), true);
    settings_.device.clear();
    settings_.device_tip.clear();
    return {};
  }
}

void Desktop::accept(LoadedArm& loaded) {
  const auto take = [this, loaded] { take_arm(loaded); };
  if (scene_for(loaded.arm)) return take();
  document_.leave(take);
}

// The present one, as far as it is of the arm's size.
std::optional<SceneEditor::World> Desktop::scene_for(const ArmDescription& arm) const {
  const double now = reach(arm), before = reach(desk_.stage().arm());
  constexpr double kAlike = 1.5;
  if (now > kAlike * before || before > kAlike * now) return std::nullopt;
  return document_.scene_for(arm);
}

void Desktop::take_arm(const LoadedArm& loaded) {
  playback_.close();
  if (auto scene = scene_for(loaded.arm)) {
    open(loaded.arm, std::move(scene->document), std::move(scene->models), nullptr,
         !document_.editor().dirty());
  } else {
    const fs::path file = default_scene(loaded.arm);
    SceneDocument document = read_scene(file, loaded.arm);
    MeshModels models = build_meshes(document);
    open(loaded.arm, std::move(document), std::move(models));
    document_.set_file(file.string());
    settings_.scene.clear();
  }
  const bool built_in = loaded.file == default_device();
  device_file_ = loaded.file.string();
  device_tip_ = loaded.tip;
  settings_.device = built_in ? "" : device_file_;
  settings_.device_tip = loaded.tip;
  if (!built_in) remember_recent(settings_, device_file_);
  say_about_arm();
}

void Desktop::say_about_arm() {
  const ArmDescription& arm = desk_.stage().arm();
  std::string text =
      fmt::format("Arm: {}, {} joint{} to {}, reach {:.2g} m.", arm.name, arm.dof(),
                  arm.dof() == 1 ? "" : "s", arm.tip_link, farthest_tip(arm).distance);
  if (!fit_text(fitted(arm)).empty()) text += " Gains are fitted to it.";
  notices_.say(text);
  for (std::size_t i = 0; i < std::min(kSaid, arm.warnings.size()); ++i) {
    notices_.say(arm.warnings[i]);
  }
  if (arm.warnings.size() > kSaid) {
    notices_.say(fmt::format("{} more warnings: limpid check {}", arm.warnings.size() - kSaid,
                             fs::path(device_file_).filename().string()));
  }
}

// Gains that suited the arm before may be far too stiff for this one.
void Desktop::fit_to(const ArmDescription& arm) {
  if (fitted_for_ && fitted_for_->urdf == arm.urdf) return;
  const ArmDescription* before = fitted_for_ ? &*fitted_for_ : nullptr;
  refit(settings_.parameters, before, &arm);
  refit(settings_.twin.parameters, before, &arm);
  fitted_for_ = arm;
}

Settings Desktop::settings_to_keep() const {
  Settings kept = settings_;
  end_passivity_break(kept);
  if (compensated_) static_cast<CompensationSettings&>(kept.parameters) = compensated_->second;
  if (!fitted_for_) return kept;
  refit(kept.parameters, &*fitted_for_, nullptr);
  refit(kept.twin.parameters, &*fitted_for_, nullptr);
  return kept;
}

}  // namespace limpid
