#include "app/plot/plot_legend.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace limpid {
namespace {

constexpr float kSwatch = 14;  // [px] at scale 1
constexpr float kEntriesApart = 12;

void draw_swatch(const PlotFrame& frame, const ScreenRect& entry, const Curve& curve, float alpha) {
  const float s = frame.scale;
  const ImU32 rgba = colour(colour_of(frame.palette, curve), alpha);
  const float y = std::round(0.5f * (entry.min.y + entry.max.y));
  frame.list.AddRectFilled({entry.min.x, y - s}, {entry.min.x + kSwatch * s, y + s}, rgba, s);
  draw_run_sign(frame.list, {entry.min.x + 0.5f * kSwatch * s, y}, curve.sign, rgba,
                colour(frame.palette.panel), s);
}

// Removes the words that a label shares with the one before it.
std::string without_shared_words(const std::string& label, const std::string& before) {
  const auto differs = std::ranges::mismatch(label, before).in1;
  const auto same = static_cast<std::size_t>(differs - label.begin());
  const std::size_t space = label.rfind(' ', same > 0 ? same - 1 : 0);
  return space == std::string::npos || same == 0 ? label : label.substr(space + 1);
}

}  // namespace

float PlotLegend::sample_width(float scale) const {
  return style_.samples ? (kSwatch + 5) * scale : 0;
}

// Returns the label as the style has it; empty if it says nothing more.
std::string PlotLegend::label_of(const std::string& whole, const std::string& before) const {
  if (style_.samples) return whole;
  if (style_.runs) return without_shared_words(whole, before);
  std::string last = whole.substr(whole.rfind(' ') + 1);
  const bool said = std::ranges::any_of(entries_, [&](const Entry& e) { return e.label == last; });
  return said ? "" : last;
}

// Lays out entries from left to right, in lines no wider than `width`, relative to (0, 0).
ImVec2 PlotLegend::lay_out(const PlotSpec& spec, float width, float scale) {
  entries_.clear();
  const float height = text_size(Face::small, "0").y + 2 * scale;
  ImVec2 at{0, 0};
  float widest = 0;
  std::string before;
  for (std::size_t i = 0; i < spec.curves.size(); ++i) {
    if (!style_.hidden_too && !spec.curves[i].visible) continue;
    const std::string name = spec.curves[i].name();
    std::string label = label_of(name, before);
    before = name;
    if (label.empty()) continue;
    const float entry = sample_width(scale) + text_size(Face::small, label).x;
    if (at.x > 0 && at.x + entry > width) at = {0, at.y + height};
    const ScreenRect box{at, {at.x + entry, at.y + height}};
    entries_.push_back({box, static_cast<int>(i), std::move(label)});
    widest = std::max(widest, at.x + entry);
    at.x += entry + kEntriesApart * scale;
  }
  return {widest, at.y + height};
}

void PlotLegend::move_entries(ImVec2 by) {
  for (Entry& e : entries_) {
    e.box = {{e.box.min.x + by.x, e.box.min.y + by.y}, {e.box.max.x + by.x, e.box.max.y + by.y}};
  }
}

float PlotLegend::place(const Room& room, const PlotSpec& spec, float scale) {
  entries_.clear();
  if (spec.curves.empty()) return 0;
  const ScreenRect& outer = room.outer;
  const float left = outer.min.x + 2 * scale, right = outer.max.x - 6 * scale;
  const float beside = room.beside.width() - 22 * scale;
  const float line = text_size(Face::small, "0").y + 2 * scale;
  const float under = outer.max.y - room.beside.max.y - room.least_height;
  const float most = std::max(1.0f, std::floor(under / line)) * line;
  constexpr std::array kStyles{Style{true, true, true}, Style{false, true, true},
                               Style{false, false, true}, Style{false, false, false}};
  for (const Style& style : kStyles) {
    style_ = style;
    ImVec2 size = lay_out(spec, 1e6f, scale);
    if (size.x < beside) {
      move_entries({room.beside.max.x - 6 * scale - size.x, room.beside.max.y - size.y});
      return 0;
    }
    size = lay_out(spec, right - left, scale);
    if (size.y > most + 1 && style.runs) continue;
    std::erase_if(entries_, [&](const Entry& e) { return e.box.max.y > most + 1; });
    move_entries({left, room.beside.max.y});
    return std::min(size.y, most);
  }
  return 0;
}

int PlotLegend::curve_at(ImVec2 mouse) const {
  for (const Entry& e : entries_) {
    if (e.box.contains(mouse)) return e.curve;
  }
  return -1;
}

void PlotLegend::draw(const PlotFrame& frame, const PlotSpec& spec, int hovered) const {
  for (const Entry& e : entries_) {
    const Curve& curve = spec.curves[static_cast<std::size_t>(e.curve)];
    if (style_.samples) draw_swatch(frame, e.box, curve, curve.visible ? 1.0f : 0.25f);
    const Rgb text = e.curve == hovered ? frame.palette.text
                     : style_.samples   ? frame.palette.muted
                                        : colour_of(frame.palette, curve);
    draw_text(frame.list, Face::small,
              {e.box.min.x + sample_width(frame.scale), e.box.min.y + frame.scale},
              curve.visible ? text : mix(text, frame.palette.panel, 0.6f), e.label);
  }
}

}  // namespace limpid
