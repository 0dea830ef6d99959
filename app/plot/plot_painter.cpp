#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "app/plot/band_stretches.h"
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

// Text over curves, readable through a veil of the background.
void draw_backed_text(const PlotFrame& frame, ImVec2 at, Rgb rgb, const std::string& text,
                      float veil) {
  const ImVec2 size = text_size(Face::small, text);
  const float pad = 3 * frame.scale;
  frame.list.AddRectFilled({at.x - pad, at.y}, {at.x + size.x + pad, at.y + size.y},
                           colour(frame.palette.panel, veil), pad);
  draw_text(frame.list, Face::small, at, rgb, text);
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

namespace {

// In sight, from the left.
template <class Draw>
void for_marks(const PlotFrame& frame, const History& history, Draw&& draw) {
  for (const Mark& mark : history.marks()) {
    const float x = std::round(frame.x_of(mark.time));
    if (x >= frame.area.min.x && x <= frame.area.max.x) draw(mark, x);
  }
}

bool crosses(const PlotFrame& frame, const Trace& trace, const ScreenRect& box) {
  for (const TraceRun& run : trace.runs) {
    for (std::size_t i = run.first; i < run.first + run.count; ++i) {
      const TracePoint& to = trace.points[i];
      const TracePoint& from = trace.points[i > run.first ? i - 1 : i];
      if (frame.area.min.x + to.x < box.min.x || frame.area.min.x + from.x > box.max.x) continue;
      const auto low = static_cast<double>(std::min(from.low, to.low));
      const auto high = static_cast<double>(std::max(from.high, to.high));
      if (frame.y_of(low) > box.min.y && frame.y_of(high) < box.max.y) return true;
    }
  }
  return false;
}

// Lines of text from the bottom on, each free from some place on.
class MarkRows {
 public:
  explicit MarkRows(const PlotFrame& frame, float line) : frame_(frame), line_(line) {
    free_from_.fill(frame.area.min.x);
    const float fit = frame.area.height() / line;
    most_ = std::clamp(static_cast<std::size_t>(fit), std::size_t{1}, kRows);
    usual_ = std::clamp(static_cast<std::size_t>(fit / 2), std::size_t{1}, kRows);
  }
  ScreenRect box(std::size_t row, float left, float width) const {
    const float bottom = frame_.area.max.y - static_cast<float>(row) * line_ - 2 * frame_.scale;
    return {{left, bottom - line_}, {left + width, bottom}};
  }
  // The lowest one that no curve crosses, else the lowest one in the lower half.
  std::optional<std::size_t> find(std::span<const Trace> traces, float left, float width) const {
    std::optional<std::size_t> crossed;
    for (std::size_t row = 0; row < most_; ++row) {
      if (left < free_from_[row]) continue;
      const ScreenRect place = box(row, left, width);
      if (std::ranges::none_of(traces, [&](const Trace& t) { return crosses(frame_, t, place); }))
        return row;
      if (!crossed && row < usual_) crossed = row;
    }
    return crossed;
  }
  void take(std::size_t row, float until) { free_from_[row] = std::max(free_from_[row], until); }

 private:
  static constexpr std::size_t kRows = 5;

  const PlotFrame& frame_;
  float line_;
  std::size_t most_ = 1, usual_ = 1;
  std::array<float, kRows> free_from_{};
};

}  // namespace

void draw_mark_lines(const PlotFrame& frame, const History& history) {
  float last = -1e9f;
  for_marks(frame, history, [&](const Mark&, float x) {
    if (x - last < 3 * frame.scale) return;
    dashed_line(frame, {x, frame.area.min.y}, {x, frame.area.max.y},
                colour(frame.palette.muted, 0.45f), 2 * frame.scale);
    last = x;
  });
}

// A label stands right of its line, at the end left of it.
void draw_mark_labels(const PlotFrame& frame, const History& history, std::span<const Trace> traces,
                      ImVec2 mouse) {
  MarkRows rows(frame, text_size(Face::small, "0").y);
  for_marks(frame, history, [&](const Mark& mark, float x) {
    const float width = text_size(Face::small, mark.label).x;
    const float gap = 4 * frame.scale;
    const bool at_the_end = x + gap + width > frame.area.max.x;
    const float left = at_the_end ? x - gap - width : x + gap;
    const bool pointed_at = frame.area.contains(mouse) && std::abs(mouse.x - x) < gap;
    const auto row = rows.find(traces, left, width);
    if (!row && !pointed_at) return;
    draw_backed_text(frame, rows.box(row.value_or(0), left, width).min, frame.palette.muted,
                     mark.label, pointed_at ? 1.0f : 0.85f);
    rows.take(row.value_or(0), left + width + 6 * frame.scale);
  });
}

namespace {

// Each with its edges on the screen.
template <class Draw>
void for_stretches(const PlotFrame& frame, const Band& band, const History& history,
                   const std::vector<SampleIndex>& rows, Draw&& draw) {
  for (const BandStretch& stretch : band_stretches(band, history, rows)) {
    draw(stretch.said, frame.area.min.x + static_cast<float>(stretch.from),
         frame.area.min.x + static_cast<float>(stretch.to));
  }
}

void draw_names(const PlotFrame& frame, const Band& band, const History& history,
                const std::vector<SampleIndex>& rows) {
  float free_from = frame.area.min.x;
  int before = -1;
  for_stretches(frame, band, history, rows, [&](int now, float left, float right) {
    const std::string& name = band.names[static_cast<std::size_t>(now)];
    const ImVec2 label = text_size(Face::small, name);
    const float x =
        std::max(std::min(left, frame.area.max.x - label.x - 6 * frame.scale), frame.area.min.x) +
        2 * frame.scale;
    if (name.empty() || std::exchange(before, now) == now || x < free_from) return;
    // Where the plot is low, names would fill it.
    if (frame.area.height() < 6 * label.y) return;
    // A moment under another law is a line without a name.
    if (!band.names.front().empty() && right - left < label.x) return;
    // Below the names of others.
    const float y = frame.area.min.y + (band.striped ? label.y : 0);
    draw_backed_text(frame, {x, y}, band.striped ? frame.palette.text : frame.palette.muted, name,
                     0.85f);
    free_from = x + label.x + 12 * frame.scale;
  });
}

// From lower left to upper right; stretches side by side fit together.
void draw_stripes(const PlotFrame& frame, float left, float right) {
  const float gap = 7 * frame.scale, high = frame.area.height();
  const ImU32 rgba = colour(frame.palette.muted, 0.5f);
  frame.list.AddRectFilled({left, frame.area.min.y}, {right, frame.area.max.y},
                           colour(frame.palette.muted, 0.1f));
  frame.list.PushClipRect({left, frame.area.min.y}, {right, frame.area.max.y}, true);
  for (float x = gap * std::floor((left - high) / gap); x < right; x += gap) {
    frame.list.AddLine({x, frame.area.max.y}, {x + high, frame.area.min.y}, rgba, frame.scale);
  }
  frame.list.PopClipRect();
}

}  // namespace

void draw_bands(const PlotFrame& frame, const PlotSpec& spec, const History& history,
                const std::vector<SampleIndex>& rows) {
  for (const Band& band : spec.bands) {
    const auto most = static_cast<float>(std::max<std::size_t>(2, band.names.size()) - 1);
    for_stretches(frame, band, history, rows, [&](int now, float left, float right) {
      if (band.striped && now > 0) return draw_stripes(frame, left, right);
      if (now == 0) return;
      frame.list.AddRectFilled(
          {left, frame.area.min.y}, {right, frame.area.max.y},
          colour(frame.palette.accent, band.tint * static_cast<float>(now) / most));
    });
  }
}

void draw_band_names(const PlotFrame& frame, const PlotSpec& spec, const History& history,
                     const std::vector<SampleIndex>& rows) {
  for (const Band& band : spec.bands) draw_names(frame, band, history, rows);
}

void draw_menu_button(const PlotFrame& frame, const ScreenRect& button, bool pointed_at) {
  if (button.height() <= 0) return;
  const float s = frame.scale;
  if (pointed_at) {
    frame.list.AddRectFilled(button.min, button.max, colour(frame.palette.frame_hovered), 4 * s);
  }
  const ImU32 rgba = colour(pointed_at ? frame.palette.text : frame.palette.muted);
  const float x = 0.5f * (button.min.x + button.max.x), y = 0.5f * (button.min.y + button.max.y);
  for (const float at : {-5.0f, 0.0f, 5.0f}) {
    frame.list.AddCircleFilled({x + at * s, y}, 1.6f * s, rgba);
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
