// The look of an arm: its makers' models, or a chain of capsules where there are none.
#pragma once

#include <map>
#include <set>
#include <span>
#include <string>

#include "core/dynamics/arm_description.h"
#include "render/model/model.h"
#include "render/scene_items.h"

namespace limpid {

// Tells glTF by the file's suffix.
bool is_gltf(const std::string& file);

// Finds the glTF files among `models`, given as they are in their files, that have z up. glTF has y
// up and URDF z, so ROS turns these pictures; some makers write them with z up all the same. A
// turned picture then lies across its link. Both ways are tried, and the one is kept in which the
// pictures are where the links are: in the boxes of their collision shapes, or without any in boxes
// around the frames that the links carry. The pictures of one folder come from one maker: the way
// of most of them holds for those that fit both ways. `collisions` are like arm.visuals. Errors:
// LoadCancelled.
std::set<std::string> with_z_up(const ArmDescription& arm,
                                const std::map<std::string, Model>& models,
                                std::span<const Visual> collisions, const LoadProgress& progress);

// Turns a model from y up to z up.
void stand_upright(Model& model);

// Reads the models of the visuals that have none yet; for the window's thread only where they are
// small. A file that cannot be read, or is empty, becomes a stand-in, with a line in the arm's
// warnings. glTF is turned from y up to z up, unless with_z_up() names it, which is a warning, too.
// `collisions` are the collision shapes of the arm's links, as far as they are known. Errors:
// LoadCancelled.
void load_visuals(ArmDescription& arm, std::span<const Visual> collisions = {},
                  const LoadProgress& progress = {});

// Adds what is drawn of an arm with loaded visuals to items.base and items.moving. An arm or link
// without visuals, or with stand-ins only, is drawn as capsules from joint to joint.
void add_arm(const ArmDescription& arm, SceneItems& items);

// Returns the end of link i in its own frame: the next joint, or the tip for the last link [m].
Vec3 end_of(const ArmDescription& arm, std::size_t i);

}  // namespace limpid
