#include "render/model/glb_bytes.h"

#include <array>
#include <bit>
#include <cstdint>

namespace limpid {
namespace {

using Bytes = std::vector<unsigned char>;

constexpr std::uint32_t kGlbMagic = 0x46546C67, kJson = 0x4E4F534A, kBinary = 0x004E4942;

void put(Bytes& out, std::size_t number) {
  const auto bytes =
      std::bit_cast<std::array<unsigned char, 4>>(static_cast<std::uint32_t>(number));
  out.insert(out.end(), bytes.begin(), bytes.end());
}

}  // namespace

void fill_up(Bytes& bytes, unsigned char filler) {
  bytes.resize((bytes.size() + 3) / 4 * 4, filler);
}

Bytes glb_bytes(const std::string& json, const Bytes& data) {
  const std::size_t text = (json.size() + 3) / 4 * 4, binary = (data.size() + 3) / 4 * 4;
  Bytes out;
  out.reserve(28 + text + binary);
  put(out, kGlbMagic);
  put(out, 2);
  put(out, 12 + 8 + text + 8 + binary);
  put(out, text);
  put(out, kJson);
  out.insert(out.end(), json.begin(), json.end());
  fill_up(out, ' ');
  put(out, binary);
  put(out, kBinary);
  out.insert(out.end(), data.begin(), data.end());
  fill_up(out, 0);
  return out;
}

}  // namespace limpid
