// Text that ImGui has drawn: read back from the quads of its glyphs, with place, clip and window.
#pragma once

#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace limpid::test {

struct DrawnText {
  std::string text, window;
  ImVec2 min, max;  // of its letters
  ImVec4 clip;      // what lies beyond is not seen
  ImU32 colour = 0;
  ImVec2 at = {};  // where it was put: the upper left corner of its first letter's cell

  ImVec2 middle() const { return {(min.x + max.x) / 2, (min.y + max.y) / 2}; }
  // Tells whether any, or all, of its width and height is seen.
  bool seen() const { return max.x > clip.x && min.x < clip.z && max.y > clip.y && min.y < clip.w; }
  bool whole() const {
    return min.x >= clip.x - 1 && max.x <= clip.z + 1 && min.y >= clip.y - 1 && max.y <= clip.w + 1;
  }
};

namespace drawn {

struct Letter {
  const ImFontGlyph* glyph = nullptr;
  const ImFont* font = nullptr;
};

// Finds the glyph of a place in the texture; none for other pictures.
inline Letter letter_at(ImVec2 uv) {
  for (const ImFont* font : ImGui::GetIO().Fonts->Fonts) {
    for (const ImFontGlyph& glyph : font->Glyphs) {
      if (glyph.Visible == 0) continue;
      if (uv.x > glyph.U0 && uv.x < glyph.U1 && uv.y > glyph.V0 && uv.y < glyph.V1) {
        return {&glyph, font};
      }
    }
  }
  return {};
}

inline void append(std::string& text, unsigned letter) {
  char bytes[5] = {};
  ImTextCharToUtf8(bytes, letter);
  text += bytes;
}

}  // namespace drawn

// Returns the texts of the last frame that are seen at all, in the order in which they were drawn.
inline std::vector<DrawnText> drawn_texts() {
  std::vector<DrawnText> all;
  const ImDrawData& data = *ImGui::GetDrawData();
  for (int n = 0; n < data.CmdListsCount; ++n) {
    const ImDrawList& list = *data.CmdLists[n];
    for (const ImDrawCmd& command : list.CmdBuffer) {
      if (command.UserCallback != nullptr || command.TextureId != ImGui::GetIO().Fonts->TexID) {
        continue;
      }
      double pen = 0, line = 0;  // where the next letter of this text would stand
      const ImFont* font = nullptr;
      const auto vertex = [&](unsigned i) -> const ImDrawVert& {
        return list
            .VtxBuffer[static_cast<int>(list.IdxBuffer[static_cast<int>(i)] + command.VtxOffset)];
      };
      for (unsigned i = command.IdxOffset; i + 6 <= command.IdxOffset + command.ElemCount; i += 3) {
        const ImDrawVert &a = vertex(i), &b = vertex(i + 2);  // opposite corners
        if (a.uv.x == b.uv.x || a.uv.y == b.uv.y) continue;   // filled with one colour
        const auto [glyph, of] = drawn::letter_at({(a.uv.x + b.uv.x) / 2, (a.uv.y + b.uv.y) / 2});
        if (glyph == nullptr) continue;
        i += 3;  // a letter has two triangles
        const double scale = (b.pos.x - a.pos.x) / (b.uv.x - a.uv.x) * (glyph->U1 - glyph->U0) /
                             (glyph->X1 - glyph->X0);
        const double left =
            a.pos.x - scale * (glyph->X0 + (a.uv.x - glyph->U0) / (glyph->U1 - glyph->U0) *
                                               (glyph->X1 - glyph->X0));
        const double top =
            a.pos.y - scale * (glyph->Y0 + (a.uv.y - glyph->V0) / (glyph->V1 - glyph->V0) *
                                               (glyph->Y1 - glyph->Y0));
        const double space = scale * of->FindGlyph(' ')->AdvanceX;
        const double gap = (left - pen) / space;
        const bool goes_on = font == of && std::abs(top - line) < 1 && gap > -0.05 && gap < 3.05 &&
                             std::abs(gap - std::round(gap)) < 0.05 && a.col == all.back().colour;
        if (!goes_on) {
          all.push_back({"", list._OwnerName != nullptr ? list._OwnerName : "", a.pos, b.pos,
                         command.ClipRect, a.col,
                         ImVec2(static_cast<float>(left), static_cast<float>(top))});
        } else {
          all.back().text.append(static_cast<std::size_t>(std::lround(std::max(gap, 0.0))), ' ');
        }
        DrawnText& text = all.back();
        drawn::append(text.text, glyph->Codepoint);
        text.min = ImMin(text.min, a.pos);
        text.max = ImMax(text.max, b.pos);
        pen = left + scale * static_cast<double>(glyph->AdvanceX);
        line = top;
        font = of;
      }
    }
  }
  std::erase_if(all, [](const DrawnText& text) { return !text.seen(); });
  return all;
}

}  // namespace limpid::test
