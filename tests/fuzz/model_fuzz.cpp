// Fuzzes STL, OBJ, PLY and Collada: any bytes give a model whose numbers are consistent, or an
// error of one line; never the end of this program. The first byte chooses the format.
#include <array>
#include <cmath>
#include <cstdlib>

#include "render/model/model_file.h"

namespace {

void demand(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  constexpr std::array kNames{"fuzz.stl", "fuzz.obj", "fuzz.ply", "fuzz.dae"};
  if (size == 0) return 0;
  try {
    const limpid::Model model = limpid::parse_model({data + 1, size - 1}, kNames[data[0] % 4]);
    demand(!model.indices.empty() && model.indices.size() % 3 == 0);
    for (const std::uint32_t index : model.indices) demand(index < model.vertices.size());
    for (const limpid::Vertex& v : model.vertices)
      demand(v.position.allFinite() && std::abs(v.normal.norm() - 1) < 1e-3f && v.uv.allFinite() &&
             v.color.allFinite());
  } catch (const std::runtime_error& error) {
    const std::string line = error.what();
    demand(line.starts_with("fuzz.") && line.find('\n') == line.npos);
  }
  return 0;
}
