// The shapes that stand for an arm's links where its makers look for collisions.
#pragma once

#include <filesystem>
#include <vector>

#include "core/dynamics/arm_description.h"

namespace limpid {

// Of an arm that was read from `file`, placed as its visuals are; without a colour. What cannot be
// read is left out: these shapes are neither seen nor touched, they only say where a link is.
std::vector<Visual> read_collisions(const ArmDescription& arm, const std::filesystem::path& file);

}  // namespace limpid
