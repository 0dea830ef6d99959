// Fuzzes glTF: any bytes give a model whose numbers are consistent, or an error of one line.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "render/model/gltf_model.h"
#include "render/model/simplify.h"

namespace {

void demand(bool holds) {
  if (!holds) std::abort();
}

void check(const std::vector<limpid::Part>& parts, const std::vector<std::uint32_t>& indices,
           const limpid::Model& model) {
  std::size_t at = 0;
  for (const limpid::Part& part : parts) {
    demand(part.first == at && part.count % 3 == 0);
    at += part.count;
    for (const int image :
         {part.material.color, part.material.surface, part.material.normal, part.material.emission})
      demand(image < static_cast<int>(model.images.size()));
  }
  demand(at == indices.size());
  for (const std::uint32_t index : indices) demand(index < model.vertices.size());
}

void put_word(unsigned char* to, std::size_t word) {
  const auto narrow = static_cast<std::uint32_t>(word);
  std::memcpy(to, &narrow, 4);
}

}  // namespace

extern "C" std::size_t LLVMFuzzerMutate(unsigned char* data, std::size_t size, std::size_t most);

// Corrects the lengths in a binary file most of the time; otherwise no input would get past them.
extern "C" std::size_t LLVMFuzzerCustomMutator(unsigned char* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  size = LLVMFuzzerMutate(data, size, most);
  if (seed % 8 == 0 || size < 32 || std::memcmp(data, "glTF", 4) != 0) return size;
  constexpr unsigned char kBin[] = {'B', 'I', 'N', 0};
  const unsigned char* tag = std::search(data + 24, data + size, kBin, kBin + 4);
  const auto at = static_cast<std::size_t>(tag - data);
  if (at == size) {
    put_word(data + 12, size - 20);
  } else {
    size = at + 4 + (size - at - 4) / 4 * 4;
    put_word(data + 12, at - 4 - 20);
    put_word(data + at - 4, size - at - 4);
  }
  put_word(data + 8, size);
  return size;
}

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  try {
    limpid::Model model = limpid::parse_gltf({data, size}, "fuzz.glb");
    limpid::add_coarse(model, 1);
    check(model.parts, model.indices, model);
    if (!model.coarse.empty()) check(model.coarse_parts, model.coarse, model);
    for (const limpid::Vertex& v : model.vertices)
      demand(v.position.allFinite() && std::abs(v.normal.norm() - 1) < 1e-3f && v.uv.allFinite() &&
             v.color.allFinite());
    for (const limpid::Image& image : model.images)
      demand(image.rgba.size() == 4 * static_cast<std::size_t>(image.width * image.height));
  } catch (const std::runtime_error& error) {
    const std::string line = error.what();
    demand(line.starts_with("fuzz.glb: ") && line.find('\n') == line.npos);
  }
  return 0;
}
