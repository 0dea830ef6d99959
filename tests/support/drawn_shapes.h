// Shapes that ImGui has drawn: lines, boxes and discs, each with its place and colour.
#pragma once

#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <vector>

namespace limpid::test {

// A shape that one call filled or stroked.
struct DrawnShape {
  ImVec2 min, max;  // of its corners; a soft rim does not count
  ImU32 colour = 0;
  ImVec4 clip{};
  int corners = 0;

  ImVec2 middle() const { return {(min.x + max.x) / 2, (min.y + max.y) / 2}; }
  float width() const { return max.x - min.x; }
  float height() const { return max.y - min.y; }
};

// Returns the shapes of the last frame, but no letters, in the order in which they were drawn.
inline std::vector<DrawnShape> drawn_shapes() {
  std::vector<DrawnShape> all;
  const ImDrawData& data = *ImGui::GetDrawData();
  for (int n = 0; n < data.CmdListsCount; ++n) {
    const ImDrawList& list = *data.CmdLists[n];
    for (const ImDrawCmd& command : list.CmdBuffer) {
      if (command.UserCallback != nullptr || command.TextureId != ImGui::GetIO().Fonts->TexID) {
        continue;
      }
      long last = -1;  // highest vertex of the shape that is being read
      for (unsigned i = command.IdxOffset; i < command.IdxOffset + command.ElemCount; i += 3) {
        std::array<ImDrawVert, 3> corner;
        std::array<long, 3> number{};
        for (unsigned k = 0; k < 3; ++k) {
          number[k] = list.IdxBuffer[static_cast<int>(i + k)];
          corner[k] = list.VtxBuffer[static_cast<int>(static_cast<unsigned>(number[k]) +
                                                      command.VtxOffset)];
        }
        const auto same = [&](float ImVec2::*axis) {
          return corner[0].uv.*axis == corner[1].uv.*axis &&
                 corner[1].uv.*axis == corner[2].uv.*axis;
        };
        if (!same(&ImVec2::x) && !same(&ImVec2::y)) continue;  // half of a letter
        // Each call has vertices of its own, behind those of the one before.
        if (last < 0 || *std::ranges::min_element(number) > last) {
          all.push_back({{1e9f, 1e9f}, {-1e9f, -1e9f}, 0, command.ClipRect, 0});
        }
        DrawnShape& shape = all.back();
        for (unsigned k = 0; k < 3; ++k) {
          if (number[k] > last) ++shape.corners;
          if ((corner[k].col & IM_COL32_A_MASK) == 0) continue;
          shape.colour = corner[k].col;
          shape.min = ImMin(shape.min, corner[k].pos);
          shape.max = ImMax(shape.max, corner[k].pos);
        }
        last = std::max(last, *std::ranges::max_element(number));
      }
    }
  }
  return all;
}

// Returns those of one colour.
inline std::vector<DrawnShape> drawn_shapes(ImU32 colour) {
  std::vector<DrawnShape> all = drawn_shapes();
  std::erase_if(all, [&](const DrawnShape& shape) { return shape.colour != colour; });
  return all;
}

}  // namespace limpid::test
