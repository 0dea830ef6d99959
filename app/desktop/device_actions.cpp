#include "app/assets.h"
#include "app/desktop/workbench.h"
#include "app/run/scene_meshes.h"
#include "devices/files/file_error.h"
#include "devices/files/scene_file.h"

namespace limpid {
namespace {

// The present scene for another arm, free space where its text names joints or links that this one
// does not have. Of what stands before an Omni a joystick reaches nothing: it has a scene of its
// own.
Scene scene_for(const Scene& present, const std::filesystem::path& file,
                const ArmDescription& arm) {
  const std::filesystem::path assets = data_dir() / "assets";
  if (arm.dof() == 2) return read_scene(assets / "devices/joystick.toml", arm);
  SceneFiles models;
  for (const MeshObstacle& mesh : present.meshes) models[mesh.file] = mesh.source;
  try {
    return parse_scene(present.toml, file.string(), file.parent_path(), arm, models);
  } catch (const FileError&) {
    return read_scene(assets / "scenes/free.toml", arm);
  }
}

}  // namespace

void Workbench::open_device(std::unique_ptr<Device> device) {
  const DeviceTraits& traits = device->traits();
  if (Plug::guides(traits)) {
    if (live.real()) open(stage->arm(), stage->scene(), editor.models());
    return live.plug(std::move(device));
  }
  cut_force();
  ArmDescription arm = arm_for(traits, stage->arm());
  if (live.real() && arm.dof() == stage->arm().dof()) return live.plug(std::move(device));
  close_playback();
  const bool other_arm = arm.urdf != stage->arm().urdf;
  Scene scene = other_arm ? scene_for(stage->scene(), scene_file, arm) : stage->scene();
  MeshModels models = build_meshes(scene);
  open(std::move(arm), std::move(scene), std::move(models), std::move(device));
}

void Workbench::close_device() {
  if (live.real()) {
    open_world(device_file, scene_file);
  } else if (live.device_plugged()) {
    live.plug(nullptr);
  }
}

}  // namespace limpid
