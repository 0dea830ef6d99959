// The arm and the scenes that come with the program.
#pragma once

#include <filesystem>

#include "devices/files/scene/scene_file.h"
#include "devices/files/session/hand_file.h"
#include "devices/files/urdf_file.h"

namespace limpid::test {

inline std::filesystem::path assets_dir() { return LIMPID_ASSETS_DIR; }
inline ArmDescription omni() { return read_urdf(assets_dir() / "devices/omni.urdf"); }
inline SceneDocument omni_document(const char* name) {
  return read_scene(assets_dir() / "scenes" / name, omni());
}
inline Scene omni_scene(const char* name) { return omni_document(name).scene; }
inline HandPath hand(const char* name) { return read_hand(assets_dir() / "hands" / name); }

}  // namespace limpid::test
