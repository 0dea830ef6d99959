// An arm as its makers drew it, and as a chain of capsules where they did not.
#pragma once

#include <map>
#include <set>
#include <span>
#include <string>

#include "core/dynamics/arm_description.h"
#include "render/model/model.h"
#include "render/scene_items.h"

namespace limpid {

// Which way up the glTF pictures of an arm's links are.
//
// glTF has y up and URDF z, and so ROS turns these pictures. Some makers write them with z up all
// the same, and a turned picture then lies across its link. Both are tried, and the one is kept in
// which the pictures are where the links are: in the boxes of their collision shapes, or without
// any in boxes around the frames that the links carry.

bool is_gltf(const std::string& file);  // by its suffix

// Of the glTF files among `models`, which are as they are in their files, those that have z up.
// The pictures of one folder come from one maker: what tells for most of them holds for those that
// fit both ways. `collisions` as arm.visuals are. Errors: LoadCancelled.
std::set<std::string> with_z_up(const ArmDescription& arm,
                                const std::map<std::string, Model>& models,
                                std::span<const Visual> collisions, const LoadProgress& progress);

// From y up to z up.
void stand_upright(Model& model);

// Reads the models of the visuals that have none yet; for the window's thread only where they are
// small. One that cannot be read, or is empty, becomes a stand-in, with a line in the arm's
// warnings. glTF is turned from y up to z up, unless it fits the links better as it is, which is a
// warning, too: see upright.h. `collisions` are the shapes of the arm's links where they collide,
// as far as they are known. Errors: LoadCancelled.
void load_visuals(ArmDescription& arm, std::span<const Visual> collisions = {},
                  const LoadProgress& progress = {});

// What there is to draw of an arm whose visuals are loaded, into items.base and items.moving. An
// arm without any, and links without any or of which only stand-ins are left, are drawn as capsules
// from joint to joint.
void add_arm(const ArmDescription& arm, SceneItems& items);

// Where link i ends, in its own frame: at the next joint, the last one at the tip [m].
Vec3 end_of(const ArmDescription& arm, std::size_t i);

}  // namespace limpid
