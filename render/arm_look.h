// An arm as its makers drew it, and as a chain of capsules where they did not.
#pragma once

#include <span>

#include "core/dynamics/arm_description.h"
#include "render/model/load_progress.h"
#include "render/scene_items.h"

namespace limpid {

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
