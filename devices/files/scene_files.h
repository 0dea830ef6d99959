// Models of a scene as bytes: in memory, and inside session files.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace limpid {

using ModelBytes = std::shared_ptr<const std::vector<unsigned char>>;

// Bytes of models by their names in a scene's text.
using SceneFiles = std::map<std::string, ModelBytes>;

}  // namespace limpid
