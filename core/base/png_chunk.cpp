#include "core/base/png_chunk.h"

namespace limpid {
namespace {

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(value >> shift & 0xff);
  return bytes;
}

// Checksum as in the PNG specification, annex D.
std::uint32_t crc(std::string_view bytes) {
  std::uint32_t sum = 0xffffffffu;
  for (const char byte : bytes) {
    sum ^= static_cast<unsigned char>(byte);
    for (int i = 0; i < 8; ++i) sum = (sum & 1) != 0 ? 0xedb88320u ^ (sum >> 1) : sum >> 1;
  }
  return ~sum;
}

std::string chunk(const std::string& name, const std::string& body) {
  return big_endian(static_cast<std::uint32_t>(body.size())) + name + body +
         big_endian(crc(name + body));
}

}  // namespace

std::string png_density(std::uint32_t per_metre) {
  return chunk("pHYs", big_endian(per_metre) + big_endian(per_metre) + '\1');
}

std::string png_description(std::string_view text) {
  return chunk("tEXt", std::string("Description") + '\0' + std::string(text));
}

}  // namespace limpid
