// The workbench's actions on devices.
#include <fmt/format.h>

#include "app/base/assets.h"
#include "app/desktop/workbench.h"
#include "devices/files/arm/urdf_file.h"
#include "devices/files/file_error.h"
#include "devices/files/scene/scene_file.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

// Of what stands before an Omni a joystick reaches nothing, nor the other way round.
bool share_a_workspace(const ArmDescription& a, const ArmDescription& b) {
  return (a.dof() == 2) == (b.dof() == 2);
}

fs::path own_scene(const ArmDescription& arm) {
  const fs::path assets = data_dir() / "assets";
  return arm.dof() == 2 ? assets / "devices/joystick.toml" : assets / "scenes/free.toml";
}

}  // namespace

void Workbench::open_device(std::unique_ptr<Device> device) {
  devices.plugged();
  const DeviceTraits& traits = device->traits();
  if (Plug::guides(traits)) {
    if (live.device_in_place())
      open(stage->arm(), editor.scene(), editor.models(), nullptr, !editor.dirty());
    return live.plug(std::move(device));
  }
  const ArmDescription arm = arm_for(traits, stage->arm());
  if (live.device_in_place() && arm.dof() == stage->arm().dof())
    return live.plug(std::move(device));
  close_playback();
  change_arm(arm, std::move(device));
}

void Workbench::close_device() {
  if (!live.device_in_place()) return live.plug(nullptr);
  try {
    change_arm(read_urdf(device_file), nullptr);
  } catch (const std::exception& e) {
    say(e.what(), true);
    change_arm(read_urdf(default_device()), nullptr);
  }
}

void Workbench::let_go(std::unique_ptr<Device> device) {
  device_errands.run(
      [done = std::shared_ptr<Device>(std::move(device))]() mutable { done.reset(); });
}

// The present scene with all its changes, if there is one like it for this arm. Shapes and pictures
// of meshes are the same for every arm.
std::optional<SceneEditor::World> Workbench::scene_for(const ArmDescription& arm) const {
  const Scene& present = editor.scene();
  if (arm.urdf == stage->arm().urdf) return SceneEditor::World{present, editor.models()};
  if (!share_a_workspace(arm, stage->arm())) return std::nullopt;
  SceneFiles sources;
  for (const MeshObstacle& mesh : present.meshes) sources[mesh.file] = mesh.source;
  try {
    Scene scene =
        parse_scene(scene_toml(), scene_file, fs::path(scene_file).parent_path(), arm, sources);
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
      scene.meshes[i].shape = present.meshes.at(i).shape;
      scene.meshes[i].path = present.meshes.at(i).path;
    }
    return SceneEditor::World{std::move(scene), editor.models()};
  } catch (const std::exception&) {  // it names joints or links that this arm does not have
    return std::nullopt;
  }
}

void Workbench::change_arm(const ArmDescription& arm, std::unique_ptr<Device> device) {
  if (!device && set_aside_) return leave_scene([this, arm] { take_up_set_aside(arm); });
  if (auto scene = scene_for(arm)) {
    return open(arm, std::move(scene->scene), std::move(scene->models), std::move(device),
                !editor.dirty());
  }
  if (!set_aside_)
    set_aside_ = SetAside{scene_file, stage->arm(), editor.version().world, editor.dirty()};
  const fs::path file = own_scene(arm);
  scene_file = file.string();
  open(arm, read_scene(file, arm), {}, std::move(device));
}

// What was open before a device brought its own scene, with its changes.
void Workbench::take_up_set_aside(const ArmDescription& arm) {
  const SetAside before = *std::exchange(set_aside_, std::nullopt);
  scene_file = before.file;
  open(arm, before.world->scene, before.world->models, nullptr, !before.unsaved);
}

}  // namespace limpid
