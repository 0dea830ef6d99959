// Ink that ImGui has drawn: colours of the triangles that cover a place.
#pragma once

#include <imgui.h>
#include <imgui_internal.h>

#include <array>

namespace limpid::test {

// Tells whether a triangle of the last frame whose corners all have a wanted colour covers a place.
template <class Wanted>
bool inked(ImVec2 at, Wanted&& wanted) {
  const ImDrawData& data = *ImGui::GetDrawData();
  for (int n = 0; n < data.CmdListsCount; ++n) {
    const ImDrawList& list = *data.CmdLists[n];
    for (const ImDrawCmd& command : list.CmdBuffer) {
      for (unsigned i = command.IdxOffset; i < command.IdxOffset + command.ElemCount; i += 3) {
        std::array<ImVec2, 3> p;
        bool same = true;
        for (unsigned k = 0; k < 3; ++k) {
          const ImDrawVert& v = list.VtxBuffer[static_cast<int>(
              list.IdxBuffer[static_cast<int>(i + k)] + command.VtxOffset)];
          p[k] = v.pos;
          same = same && wanted(v.col);
        }
        if (same && ImTriangleContainsPoint(p[0], p[1], p[2], at)) return true;
      }
    }
  }
  return false;
}

}  // namespace limpid::test
