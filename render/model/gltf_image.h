// Pictures of a glTF file: PNG and JPEG, within limits of size and work.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "render/model/model.h"

namespace limpid {

class GltfImages {
 public:
  // Nothing for what is no readable PNG or JPEG. Throws std::runtime_error naming the file when
  // all pictures so far come to more than 1 GiB, encoded or decoded.
  std::optional<Image> decode(std::span<const unsigned char> bytes, const std::string& name);

 private:
  std::size_t encoded_ = 0, decoded_ = 0;  // bytes so far
};

}  // namespace limpid
