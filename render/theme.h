// Light on dark or dark on light, for the picture and the panels alike.
#pragma once

#include <cstdint>

namespace limpid {

enum class Theme : std::uint8_t { dark, light };

}  // namespace limpid
