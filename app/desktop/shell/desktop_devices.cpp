// What the desktop does when devices come and go.
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "app/base/folders.h"
#include "app/desktop/shell/desktop.h"
#include "app/run/own_world.h"
#include "devices/files/scene/scene_file.h"
#include "devices/files/text_file.h"
#include "devices/files/urdf_file.h"

namespace limpid {
namespace {

// What the loop takes from an arm once, when it is opened.
bool same_limits(const ArmDescription& one, const ArmDescription& other) {
  return one.delay == other.delay &&
         std::ranges::equal(one.joints, other.joints, {}, &Joint::effort, &Joint::effort);
}

}  // namespace

void Desktop::open_device(std::unique_ptr<Device> device) {
  devices_.plugged();
  const DeviceTraits& traits = device->traits();
  const ArmDescription& present = desk_.stage().arm();
  if (Plug::guides(traits)) {
    const SceneEditor& editor = document_.editor();
    if (desk_.loop().device_in_place()) {
      open(present, editor.document(), editor.models(), nullptr, !editor.dirty());
    }
    return desk_.loop().plug(std::move(device));
  }
  // A device lowers the arm's limits to its own: the next one begins with those of the arm's file.
  const bool in_place = desk_.loop().device_in_place();
  const bool lowered = in_place && arm_of_file_ && arm_of_file_->urdf == present.urdf;
  const ArmDescription before = lowered ? *arm_of_file_ : present;
  const ArmDescription arm = devices_.hub().arm_for(traits, before);
  DeviceTraits without_limits = traits;
  without_limits.effort.clear();
  arm_of_file_ = devices_.hub().arm_for(without_limits, before);
  const bool same_arm = in_place && arm.urdf == present.urdf;
  if (same_arm && same_limits(arm, present)) return desk_.loop().plug(std::move(device));
  playback_.close();
  if (!same_arm) return change_arm(arm, std::move(device));
  const SceneEditor& editor = document_.editor();
  open(arm, editor.document(), editor.models(), std::move(device), !editor.dirty());
}

// Of a device it is the device's, remembered with it: nothing of it is left to an arm that comes
// after it.
void Desktop::take_compensation(bool of_device) {
  CompensationSettings& now = settings_.parameters;
  const CompensationSettings of_virtual = compensated_ ? compensated_->second : now;
  compensated_.reset();
  now = of_virtual;
  if (!of_device) return;
  const std::string& id = devices_.hub().in_use();
  compensated_ = {id, of_virtual};
  now = devices_.hub().notes(id).compensation;
}

void Desktop::note_compensation() {
  const bool sliding = ImGui::GetCurrentContext() != nullptr && ImGui::IsAnyItemActive();
  if (!compensated_ || sliding) return;
  const CompensationSettings& now = settings_.parameters;
  CompensationSettings& noted = devices_.hub().notes(compensated_->first).compensation;
  if (noted == now) return;
  noted = now;
  devices_.save();
}

void Desktop::close_device() {
  if (!desk_.loop().device_in_place()) return desk_.loop().plug(nullptr);
  try {
    change_arm(read_urdf(device_file_, device_tip_, consent(device_file_)), nullptr);
  } catch (const std::exception& e) {
    notices_.say(e.what(), true);
    change_arm(read_urdf(default_device()), nullptr);
  }
}

void Desktop::change_arm(const ArmDescription& arm, std::unique_ptr<Device> device) {
  if (!device && document_.has_set_aside()) {
    return document_.leave([this, arm] { take_up_set_aside(arm); });
  }
  if (auto scene = document_.scene_for(arm)) {
    return open(arm, std::move(scene->document), std::move(scene->models), std::move(device),
                !document_.editor().dirty());
  }
  document_.put_aside();
  const std::filesystem::path file = scene_of_device(arm);
  document_.set_file(file.string());
  open(arm, read_scene(file, arm), {}, std::move(device));
}

// What was open before a device brought its own scene, with its changes.
void Desktop::take_up_set_aside(const ArmDescription& arm) {
  const SetAside before = document_.take_set_aside();
  document_.set_file(before.file);
  open(arm, before.world->document, before.world->models, nullptr, !before.unsaved);
}

}  // namespace limpid
