#include "app/style/picture_legend.h"

#include <algorithm>
#include <array>

#include "app/style/palette.h"
#include "app/style/theme.h"

namespace limpid {
namespace {

struct Entry {
  const char* text;
  Ink ink;
};
constexpr std::array kEntries{Entry{"device (ghost)", Ink::device}, Entry{"proxy", Ink::proxy},
                              Entry{"hand", Ink::hand},
                              Entry{"contact force, 1 N = 2 cm", Ink::contact}};
constexpr float kLine = 1.35f;  // of the small face's size

}  // namespace

void draw_picture_legend(ImDrawList& list, ImVec2 at, const PictureLegend& legend) {
  ImFont* small = font(Face::small);
  const float em = small->FontSize;
  const Palette& colours = current_palette();
  const auto entry = [&](const char* text, Rgb rgb) {
    list.AddCircleFilled({at.x + em * 0.3f, at.y + em * 0.55f}, em * 0.3f, colour(rgb));
    list.AddText(small, em, {at.x + em, at.y}, colour(colours.text, 0.85f), text);
    at.y += kLine * em;
  };
  for (const Entry& e : kEntries) entry(e.text, ink(colours, e.ink));
  if (legend.beside != nullptr) entry(legend.beside, ink(colours, Ink::rerun));
  if (legend.cone == nullptr) return;
  entry(legend.cone, legend.slips ? rgb(0xf0e442) : rgb(0xcc79a7));  // as in the picture
}

ImVec2 picture_legend_size() {
  const ImFont* small = font(Face::small);
  const float em = small->FontSize;
  float widest = 0;
  for (const Entry& e : kEntries) {
    widest = std::max(widest, small->CalcTextSizeA(em, 1e9f, 0, e.text).x);
  }
  return {em + widest, kLine * em * static_cast<float>(kEntries.size() + 2)};
}

}  // namespace limpid
