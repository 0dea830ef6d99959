// Which way up the glTF pictures of an arm's links are.
//
// glTF has y up and URDF z, and so ROS turns these pictures. Some makers write them with z up all
// the same, and a turned picture then lies across its link. Both are tried, and the one is kept in
// which the pictures are where the links are: in the boxes of their collision shapes, or without
// any in boxes around the frames that the links carry.
#pragma once

#include <map>
#include <set>
#include <span>
#include <string>

#include "core/dynamics/arm_description.h"
#include "render/model/load_progress.h"
#include "render/model/model.h"

namespace limpid {

bool is_gltf(const std::string& file);  // by its suffix

// Of the glTF files among `models`, which are as they are in their files, those that have z up.
// The pictures of one folder come from one maker: what tells for most of them holds for those that
// fit both ways. `collisions` as arm.visuals are. Errors: LoadCancelled.
std::set<std::string> with_z_up(const ArmDescription& arm,
                                const std::map<std::string, Model>& models,
                                std::span<const Visual> collisions, const LoadProgress& progress);

// From y up to z up.
void stand_upright(Model& model);

}  // namespace limpid
