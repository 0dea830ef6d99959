#include "app/plot/plot_legend.h"

#include <array>
#include <cmath>

namespace limpid {
namespace {

constexpr float kSwatch = 14;  // [px] at scale 1
constexpr float kApart = 12;
constexpr float kPad = 5;
constexpr float kMostHidden = 0.3f;  // of the plot's area

// How many points of the traces the box would hide.
int hidden_points(const PlotFrame& frame, const ScreenRect& box, const std::vector<Trace>& traces) {
  int hidden = 0;
  for (const Trace& trace : traces) {
    for (const TracePoint& p : trace.points) {
      const float x = frame.area.min.x + p.x;
      if (x < box.min.x || x > box.max.x) continue;
      if (frame.y_of(p.high) <= box.max.y && frame.y_of(p.low) >= box.min.y) ++hidden;
    }
  }
  return hidden;
}

ScreenRect corner_box(const PlotFrame& frame, ImVec2 size, int corner) {
  const float inset = 6 * frame.scale;
  const ImVec2 min{(corner & 1) ? frame.area.max.x - inset - size.x : frame.area.min.x + inset,
                   (corner & 2) ? frame.area.max.y - inset - size.y : frame.area.min.y + inset};
  return {min, {min.x + size.x, min.y + size.y}};
}

void draw_swatch(const PlotFrame& frame, const ScreenRect& entry, const Curve& curve, float alpha) {
  const float s = frame.scale;
  const ImU32 rgba = colour(ink(frame.palette, curve.ink, curve.shade), alpha);
  const float y = std::round(0.5f * (entry.min.y + entry.max.y));
  const float dash = curve.dashed ? 4 * s : kSwatch * s;
  for (float x = 0; x < kSwatch * s; x += 1.25f * dash) {
    frame.list.AddRectFilled({entry.min.x + x, y - s}, {entry.min.x + x + dash, y + s}, rgba, s);
  }
}

}  // namespace

// Entries from left to right, in lines no wider than `width`, relative to (0, 0).
ImVec2 PlotLegend::lay_out(const PlotSpec& spec, float width, float scale) {
  entries_.clear();
  const float height = text_size(Face::small, "0").y + 2 * scale;
  ImVec2 at{0, 0};
  float widest = 0;
  for (std::size_t i = 0; i < spec.curves.size(); ++i) {
    const float text = text_size(Face::small, spec.curves[i].label).x;
    const float entry = (kSwatch + 5) * scale + text;
    if (at.x > 0 && at.x + entry > width) at = {0, at.y + height};
    entries_.push_back({{at, {at.x + entry, at.y + height}}, static_cast<int>(i)});
    widest = std::max(widest, at.x + entry);
    at.x += entry + kApart * scale;
  }
  return {widest, at.y + height};
}

void PlotLegend::move_entries(ImVec2 by) {
  for (Entry& e : entries_) {
    e.box = {{e.box.min.x + by.x, e.box.min.y + by.y}, {e.box.max.x + by.x, e.box.max.y + by.y}};
  }
}

float PlotLegend::place_outside(const ScreenRect& outer, float title_end, float title_bottom,
                                float least_height, const PlotSpec& spec, float scale) {
  inside_ = false;
  if (spec.curves.empty()) {
    entries_.clear();
    return 0;
  }
  ImVec2 size = lay_out(spec, 1e6f, scale);
  const float right = outer.max.x - 6 * scale;
  if (right - size.x > title_end + 16 * scale) {
    move_entries({right - size.x, title_bottom - size.y});
    return 0;
  }
  const float left = outer.min.x + 2 * scale;
  size = lay_out(spec, right - left, scale);
  inside_ = outer.max.y - title_bottom - size.y < least_height;
  move_entries({left, title_bottom});
  return inside_ ? 0 : size.y;
}

void PlotLegend::place_inside(const PlotFrame& frame, const PlotSpec& spec,
                              const std::vector<Trace>& traces) {
  if (!inside_) return;
  const float pad = kPad * frame.scale;
  ImVec2 size = lay_out(spec, 0.85f * frame.area.width() - 2 * pad, frame.scale);
  size = {size.x + 2 * pad, size.y + 1.2f * pad};
  // In a small plot it would hide what it explains; the read-out at the mouse names the curves,
  // too.
  if (size.x * size.y > kMostHidden * frame.area.width() * frame.area.size().y) {
    entries_.clear();
    inside_ = false;
    return;
  }
  std::array<int, 4> hidden{};
  for (int corner = 0; corner < 4; ++corner) {
    hidden[static_cast<std::size_t>(corner)] =
        hidden_points(frame, corner_box(frame, size, corner), traces);
  }
  // Stays where it is unless another corner is clearly better.
  const auto best = std::ranges::min_element(hidden);
  if (2 * *best < hidden[static_cast<std::size_t>(corner_)] - 8) {
    corner_ = static_cast<int>(best - hidden.begin());
  }
  box_ = corner_box(frame, size, corner_);
  move_entries({box_.min.x + pad, box_.min.y + 0.6f * pad});
}

int PlotLegend::curve_at(ImVec2 mouse) const {
  for (const Entry& e : entries_) {
    if (e.box.contains(mouse)) return e.curve;
  }
  return -1;
}

void PlotLegend::draw(const PlotFrame& frame, const PlotSpec& spec, int hovered) const {
  if (entries_.empty()) return;
  if (inside_) {
    frame.list.AddRectFilled(box_.min, box_.max, colour(frame.palette.panel, 0.82f),
                             4 * frame.scale);
    frame.list.AddRect(box_.min, box_.max, colour(frame.palette.border), 4 * frame.scale);
  }
  for (const Entry& e : entries_) {
    const Curve& curve = spec.curves[static_cast<std::size_t>(e.curve)];
    draw_swatch(frame, e.box, curve, curve.visible ? 1.0f : 0.25f);
    const Rgb text = e.curve == hovered ? frame.palette.text : frame.palette.muted;
    draw_text(frame.list, Face::small,
              {e.box.min.x + (kSwatch + 5) * frame.scale, e.box.min.y + frame.scale},
              curve.visible ? text : mix(text, frame.palette.panel, 0.6f), curve.label);
  }
}

}  // namespace limpid
