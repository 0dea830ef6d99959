// Pictures of a model: PNG, JPEG and WebP, within limits of size and work.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "render/model/model.h"

namespace limpid {

// How a warning about one that decode() cannot read goes on.
inline constexpr const char* kUnknownPicture =
    "no PNG, JPEG or WebP that can be read, it is left out";

class ModelImages {
 public:
  // Nothing for what is no readable PNG, JPEG or WebP. Throws std::runtime_error naming the file
  // when all pictures so far come to more than 1 GiB, encoded or decoded.
  std::optional<Image> decode(std::span<const unsigned char> bytes, const std::string& name);

 private:
  std::size_t encoded_ = 0, decoded_ = 0;  // bytes so far
};

}  // namespace limpid
