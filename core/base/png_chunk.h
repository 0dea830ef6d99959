// Chunks that PNG files may have behind their header (ISO/IEC 15948).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace limpid {

inline constexpr int kPngHeader = 8 + 25;  // bytes of the signature and IHDR

// Returns the chunk pHYs: pixels per metre, as many across as down.
std::string png_density(std::uint32_t per_metre);

// Returns the chunk tEXt with a description of the picture, in ASCII.
std::string png_description(std::string_view text);

}  // namespace limpid
