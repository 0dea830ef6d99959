#include "app/style/picture_legend.h"

#include <algorithm>
#include <array>
#include <vector>

#include "app/style/palette.h"
#include "app/style/theme.h"
#include "render/theme.h"

namespace limpid {
namespace {

struct Entry {
  std::string text;
  std::vector<Rgb> dots;
};

constexpr float kLine = 1.35f;  // of the small face's size, as all below
constexpr float kLeft = 0.9f, kTop = 0.8f;
constexpr float kDot = 0.7f;             // from one dot to the next
constexpr float kBetween = 1.1f;         // entries side by side
constexpr float kTall = 20, kWide = 30;  // a picture with room for lines

bool in_lines(ImVec2 from, ImVec2 to) {
  const float em = font(Face::small)->FontSize;
  return to.y - from.y >= kTall * em && to.x - from.x >= kWide * em;
}

std::vector<Entry> entries_of(const PictureLegend& legend, bool lines) {
  const Palette& colours = current_palette();
  const auto of = [&](Ink which) { return std::vector{ink(colours, which)}; };
  std::vector<Entry> entries{{lines ? "device (ghost)" : "device", of(Ink::device)},
                             {"proxy", of(Ink::proxy)},
                             {"hand", of(Ink::hand)},
                             {lines ? "contact force, 1 N = 2 cm" : "contact", of(Ink::contact)}};
  const auto run = [&](const std::string& name, float shade) {
    entries.push_back({name, {ink(colours, Ink::device, shade), ink(colours, Ink::proxy, shade)}});
  };
  for (std::size_t i = 0; i < legend.runs.size(); ++i) run(legend.runs[i], kLaneShades[i]);
  if (legend.beside != nullptr) entries.push_back({legend.beside, of(Ink::rerun)});
  if (legend.cone != nullptr) {  // in the picture's colours
    entries.push_back({legend.cone, {legend.slips ? rgb(0xf0e442) : rgb(0xcc79a7)}});
  }
  return entries;
}

float width_of(const Entry& entry) {
  const ImFont* small = font(Face::small);
  const float em = small->FontSize;
  return (0.3f + kDot * static_cast<float>(entry.dots.size())) * em +
         small->CalcTextSizeA(em, 1e9f, 0, entry.text.c_str()).x;
}

// Calls draw() at each entry's place; returns the place behind the last line.
template <class Draw>
float lay_out(const std::vector<Entry>& entries, ImVec2 from, ImVec2 to, bool lines,
              const Draw& draw) {
  const float em = font(Face::small)->FontSize;
  ImVec2 at(from.x + kLeft * em, from.y + kTop * em);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const float width = width_of(entries[i]);
    if (i > 0 && (lines || at.x + width > to.x - kLeft * em)) {
      at = {from.x + kLeft * em, at.y + kLine * em};
    }
    draw(entries[i], at);
    at.x += width + kBetween * em;
  }
  return at.y + kLine * em;
}

}  // namespace

void draw_picture_legend(ImDrawList& list, ImVec2 from, ImVec2 to, const PictureLegend& legend) {
  ImFont* small = font(Face::small);
  const float em = small->FontSize;
  const Palette& colours = current_palette();
  const bool lines = in_lines(from, to) && !legend.compact;
  lay_out(entries_of(legend, lines), from, to, lines, [&](const Entry& entry, ImVec2 at) {
    if (legend.compact) {  // it may stand over an arm
      const float pad = 0.5f * kBetween * em;
      list.AddRectFilled({at.x - pad, at.y - 0.15f * em},
                         {at.x + width_of(entry) + pad, at.y + 1.2f * em},
                         colour(colours.backdrop, 0.72f));
    }
    for (const Rgb rgb : entry.dots) {
      list.AddCircleFilled({at.x + em * 0.3f, at.y + em * 0.55f}, em * 0.3f, colour(rgb));
      at.x += kDot * em;
    }
    list.AddText(small, em, {at.x + 0.3f * em, at.y}, colour(colours.text, 0.85f),
                 entry.text.c_str());
  });
}

ImVec2 picture_legend_size(ImVec2 from, ImVec2 to) {
  const bool lines = in_lines(from, to);
  const float em = font(Face::small)->FontSize;
  // Lines that come and go have their room, too.
  std::vector<Entry> entries = entries_of({}, lines);
  float widest = 0;
  for (const Entry& entry : entries) widest = std::max(widest, width_of(entry));
  const float spare = lines ? 2 * kLine * em : 0;
  const float bottom = lay_out(entries, from, to, lines, [](const Entry&, ImVec2) {});
  return {lines ? kLeft * em + widest : to.x - from.x, bottom + spare - from.y};
}

}  // namespace limpid
