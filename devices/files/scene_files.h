// The models of a scene as they are kept: in memory, and inside session files.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace limpid {

using ModelBytes = std::shared_ptr<const std::vector<unsigned char>>;

// Bytes of models by the names that a scene's text has for them.
using SceneFiles = std::map<std::string, ModelBytes>;

}  // namespace limpid
