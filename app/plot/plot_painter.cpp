#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/plot/plot_frame.h"
#include "app/style/ticks.h"

namespace limpid {
namespace {

void dashed_line(const PlotFrame& frame, ImVec2 from, ImVec2 to, ImU32 rgba, float dash) {
  const bool level = from.y == to.y;
  const float length = level ? to.x - from.x : to.y - from.y;
  for (float at = 0; at < length; at += 2 * dash) {
    const float end = std::min(at + dash, length);
    const ImVec2 a = level ? ImVec2{from.x + at, from.y} : ImVec2{from.x, from.y + at};
    const ImVec2 b = level ? ImVec2{from.x + end, from.y} : ImVec2{from.x, from.y + end};
    frame.list.AddRectFilled(a, {b.x + (level ? 0 : 1), b.y + (level ? 1 : 0)}, rgba);
  }
}

void level_line(const PlotFrame& frame, float y, ImU32 rgba, float thickness = 1) {
  const float at = std::round(y);
  frame.list.AddRectFilled({frame.area.min.x, at}, {frame.area.max.x, at + thickness}, rgba);
}

void upright_line(const PlotFrame& frame, float x, ImU32 rgba, float thickness = 1) {
  const float at = std::round(x);
  frame.list.AddRectFilled({at, frame.area.min.y}, {at + thickness, frame.area.max.y}, rgba);
}

// Text over curves, readable through a veil of the background.
void draw_backed_text(const PlotFrame& frame, ImVec2 at, Rgb rgb, const std::string& text,
                      float veil) {
  const ImVec2 size = text_size(Face::small, text);
  const float pad = 3 * frame.scale;
  frame.list.AddRectFilled({at.x - pad, at.y}, {at.x + size.x + pad, at.y + size.y},
                           colour(frame.palette.panel, veil), pad);
  draw_text(frame.list, Face::small, at, rgb, text);
}

void draw_value_axis(const PlotFrame& frame, const PlotSpec& spec) {
  const float text_height = text_size(Face::small, "0").y;
  const Limits shown{frame.y.low * spec.factor, frame.y.high * spec.factor};
  const int most = std::max(2, static_cast<int>(frame.area.height() / (2.0f * text_height)));
  const Ticks ticks = nice_ticks(shown.low, shown.high, most);
  const int exponent = common_exponent(shown.low, shown.high);
  for (std::int64_t i = ticks.first; i <= ticks.last; ++i) {
    const float y = frame.y_of(ticks.at(i) / spec.factor);
    level_line(frame, y, colour(frame.palette.grid));
    const std::string label = tick_text(ticks.at(i), ticks.step, exponent);
    const ImVec2 size = text_size(Face::small, label);
    // Pushed inwards at the ends rather than cut off or left out.
    const float middle = y - 0.5f * size.y;
    const float top = std::clamp(middle, frame.area.min.y - 3, frame.area.max.y + 3 - size.y);
    if (std::abs(top - middle) > 0.6f * size.y) continue;
    draw_text(frame.list, Face::small, {frame.area.min.x - size.x - 6 * frame.scale, top},
              frame.palette.muted, label);
  }
}

void draw_time_axis(const PlotFrame& frame, double time_offset) {
  const double low = frame.window.start() - time_offset;
  const double high = frame.window.stop() - time_offset;
  const bool clock = std::max(std::abs(low), std::abs(high)) >= 60;
  const double step_guess = nice_step(high - low, 8);
  const ImVec2 widest = text_size(Face::small, time_text(-std::abs(high), step_guess, clock));
  const int most = std::max(1, static_cast<int>(frame.area.width() / (1.9f * widest.x)));
  const Ticks ticks = time_ticks(low, high, most);
  for (std::int64_t i = ticks.first; i <= ticks.last; ++i) {
    const float x = frame.x_of(ticks.at(i) + time_offset);
    upright_line(frame, x, colour(frame.palette.grid));
    const std::string label = time_text(ticks.at(i), ticks.step, clock);
    const ImVec2 size = text_size(Face::small, label);
    // Pushed inwards at the ends rather than cut off or left out.
    const float left =
        std::clamp(x - 0.5f * size.x, frame.area.min.x - 0.3f * size.x, frame.outer.max.x - size.x);
    if (std::abs(left + 0.5f * size.x - x) > 0.4f * size.x) continue;
    draw_text(frame.list, Face::small, {left, frame.area.max.y + 4 * frame.scale},
              frame.palette.muted, label);
  }
}

}  // namespace

ImVec2 text_size(Face face, const std::string& text) {
  const ImFont* f = font(face);
  return f->CalcTextSizeA(f->FontSize, 1e6f, 0, text.data(), text.data() + text.size());
}

void draw_text(ImDrawList& list, Face face, ImVec2 at, Rgb rgb, const std::string& text) {
  const ImFont* f = font(face);
  list.AddText(f, f->FontSize, {std::round(at.x), std::round(at.y)}, colour(rgb), text.data(),
               text.data() + text.size());
}

float draw_clipped_text(ImDrawList& list, Face face, ImVec2 at, Rgb rgb, const std::string& text,
                        float width) {
  std::string shown = text;
  while (!shown.empty() && text_size(face, shown).x > width) {
    // Whole UTF-8 characters: drop continuation bytes with their first one.
    if (shown.ends_with("\u2026")) shown.erase(shown.size() - 3);
    while (!shown.empty() && (shown.back() & 0xc0) == 0x80) shown.pop_back();
    if (!shown.empty()) shown.pop_back();
    if (!shown.empty()) shown += "\u2026";
  }
  draw_text(list, face, at, rgb, shown);
  return text_size(face, shown).x;
}

void draw_axes(const PlotFrame& frame, const PlotSpec& spec, double time_offset) {
  draw_time_axis(frame, time_offset);
  draw_value_axis(frame, spec);
  const float zero = frame.y_of(0);
  if (spec.zero_line && zero >= frame.area.min.y && zero <= frame.area.max.y) {
    level_line(frame, zero, colour(frame.palette.axis));
  }
}

void draw_thresholds(const PlotFrame& frame, const PlotSpec& spec) {
  for (const Threshold& each : spec.thresholds) {
    const float y = std::round(frame.y_of(each.value));
    if (y < frame.area.min.y || y > frame.area.max.y) continue;
    const Rgb rgb = ink(frame.palette, each.ink);
    dashed_line(frame, {frame.area.min.x, y}, {frame.area.max.x, y}, colour(rgb, 0.8f),
                3 * frame.scale);
    const ImVec2 size = text_size(Face::small, each.label);
    const float above = y - size.y - 2 * frame.scale;
    const ImVec2 at{frame.area.max.x - size.x - 5 * frame.scale,
                    above < frame.area.min.y ? y + 2 * frame.scale : above};
    draw_backed_text(frame, at, rgb, each.label, 0.75f);
  }
}

// A label stands right of its line, at the end left of it, on the lowest line of text that is free.
void draw_marks(const PlotFrame& frame, const History& history, ImVec2 mouse) {
  constexpr std::size_t kRows = 4;
  std::array<float, kRows> free_from{};
  free_from.fill(frame.area.min.x);
  float last_line = -1e9f;
  for (const Mark& mark : history.marks()) {
    const float x = std::round(frame.x_of(mark.time));
    if (x < frame.area.min.x || x > frame.area.max.x) continue;
    if (x - last_line >= 3 * frame.scale) {
      dashed_line(frame, {x, frame.area.min.y}, {x, frame.area.max.y},
                  colour(frame.palette.muted, 0.45f), 2 * frame.scale);
      last_line = x;
    }
    const ImVec2 size = text_size(Face::small, mark.label);
    const float gap = 4 * frame.scale;
    const bool at_the_end = x + gap + size.x > frame.area.max.x;
    const float left = at_the_end ? x - gap - size.x : x + gap;
    const bool pointed_at = frame.area.contains(mouse) && std::abs(mouse.x - x) < gap;
    const auto rows = std::clamp(static_cast<std::size_t>(frame.area.height() / (2 * size.y)),
                                 std::size_t{1}, kRows);
    const auto* free = std::find_if(free_from.begin(), free_from.begin() + rows,
                                    [&](float from) { return left >= from; });
    const bool room = free != free_from.begin() + rows;
    if (!room && !pointed_at) continue;
    const auto row = room ? static_cast<std::size_t>(free - free_from.begin()) : 0;
    const float top = frame.area.max.y - static_cast<float>(row + 1) * size.y - 2 * frame.scale;
    draw_backed_text(frame, {left, top}, frame.palette.muted, mark.label,
                     pointed_at ? 1.0f : 0.75f);
    free_from[row] = std::max(free_from[row], left + size.x + 6 * frame.scale);
  }
}

void draw_bands(const PlotFrame& frame, const PlotSpec& spec, const History& history,
                const std::vector<SampleIndex>& rows) {
  if (spec.band_channel < 0 || history.empty()) return;
  const auto inside = [&](std::size_t pixel) {
    return rows[pixel] < rows[pixel + 1] &&
           history.extent(spec.band_channel, rows[pixel], rows[pixel + 1]).high > 0.5f;
  };
  const ImVec2 label = text_size(Face::small, spec.band_label);
  float free_from = frame.area.min.x;
  for (std::size_t pixel = 0; pixel + 1 < rows.size(); ++pixel) {
    if (!inside(pixel)) continue;
    const float left = frame.area.min.x + static_cast<float>(pixel);
    while (pixel + 2 < rows.size() && inside(pixel + 1)) ++pixel;
    const float right = frame.area.min.x + static_cast<float>(pixel) + 1;
    frame.list.AddRectFilled({left, frame.area.min.y}, {right, frame.area.max.y},
                             colour(frame.palette.accent, 0.13f));
    const float at = std::min(left, frame.area.max.x - label.x) + 2 * frame.scale;
    if (at < free_from) continue;
    draw_backed_text(frame, {at, frame.area.min.y}, frame.palette.muted, spec.band_label, 0.75f);
    free_from = at + label.x + 12 * frame.scale;
  }
}

void draw_playback(const PlotFrame& frame, double time, bool held) {
  const float x = std::round(frame.x_of(time));
  if (x < frame.area.min.x || x > frame.area.max.x) return;
  const ImU32 rgba = colour(held ? frame.palette.text : frame.palette.accent);
  const float wide = std::max(1.0f, std::round(frame.scale));
  const float left = std::clamp(std::round(x - 0.5f * wide), frame.area.min.x,
                                std::max(frame.area.min.x, frame.area.max.x - wide));
  frame.list.AddRectFilled({left, frame.area.min.y}, {left + wide, frame.area.max.y}, rgba);
  const float r = 5 * frame.scale;
  frame.list.AddTriangleFilled({x - r, frame.area.min.y}, {x + r, frame.area.min.y},
                               {x, frame.area.min.y + 1.4f * r}, rgba);
}

void draw_notice(const PlotFrame& frame, const std::string& text, bool bad, float alpha) {
  const float pad = 6 * frame.scale;
  const float room = frame.area.width() - 4 * pad;
  const ImVec2 full = text_size(Face::small, text);
  const float width = std::min(full.x, room);
  const ImVec2 min{frame.area.min.x + 0.5f * (frame.area.width() - width) - pad,
                   frame.area.max.y - full.y - 4 * pad};
  const ImVec2 max{min.x + width + 2 * pad, min.y + full.y + 1.4f * pad};
  const Rgb edge = bad ? frame.palette.broken : frame.palette.border;
  frame.list.AddRectFilled(min, max, colour(frame.palette.raised, alpha), 4 * frame.scale);
  frame.list.AddRect(min, max, colour(edge, alpha), 4 * frame.scale);
  draw_clipped_text(frame.list, Face::small, {min.x + pad, min.y + 0.7f * pad}, frame.palette.text,
                    text, width + 1);
}

}  // namespace limpid
