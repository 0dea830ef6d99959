// The painter of a plot's parts: axes, curves, signs, thresholds, marks, bands.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "app/plot/axis.h"
#include "app/plot/band_names.h"
#include "app/plot/label_room.h"
#include "app/plot/plot_frame.h"
#include "app/plot/trace.h"
#include "app/style/ticks.h"

namespace limpid {

namespace {

void level_line(const PlotFrame& frame, float y, ImU32 rgba, float thickness = 1) {
  const float at = std::round(y);
  frame.list.AddRectFilled({frame.area.min.x, at}, {frame.area.max.x, at + thickness}, rgba);
}

void upright_line(const PlotFrame& frame, float x, ImU32 rgba, float thickness = 1) {
  const float at = std::round(x);
  frame.list.AddRectFilled({at, frame.area.min.y}, {at + thickness, frame.area.max.y}, rgba);
}

void draw_value_axis(const PlotFrame& frame, const PlotSpec& spec) {
  const float text_height = text_size(Face::small, "0").y;
  const auto most = static_cast<double>(frame.area.height() / (2.0f * text_height));
  for (const AxisPlace& place : axis_places(spec.y, frame.y, most)) {
    const float y = frame.y_of(place.value);
    level_line(frame, y, colour(frame.palette.grid));
    const ImVec2 size = text_size(Face::small, place.label);
    // Labels at the ends are pushed inwards rather than cut off or left out.
    const float middle = y - 0.5f * size.y;
    const float top = std::clamp(middle, frame.area.min.y - 3, frame.area.max.y + 3 - size.y);
    if (std::abs(top - middle) > 0.6f * size.y) continue;
    draw_text(frame.list, Face::small, {frame.area.min.x - size.x - 6 * frame.scale, top},
              frame.palette.muted, place.label);
  }
}

// Draws a label under the area, from the left. At the ends it is pushed inwards rather than cut off
// or left out.
void draw_place_below(const PlotFrame& frame, double at, const std::string& label, float right) {
  const float x = frame.x_of(at);
  upright_line(frame, x, colour(frame.palette.grid));
  const ImVec2 size = text_size(Face::small, label);
  const float left = std::clamp(x - 0.5f * size.x, frame.area.min.x - 0.3f * size.x,
                                std::max(frame.area.min.x - 0.3f * size.x, right - size.x));
  if (std::abs(left + 0.5f * size.x - x) > 0.4f * size.x) return;
  draw_text(frame.list, Face::small, {left, frame.area.max.y + 4 * frame.scale},
            frame.palette.muted, label);
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
    draw_place_below(frame, ticks.at(i) + time_offset, time_text(ticks.at(i), ticks.step, clock),
                     frame.outer.max.x);
  }
}

// Draws what the axis shows at its right end; its numbers leave room for that.
void draw_across_axis(const PlotFrame& frame, const PlotSpec& spec) {
  const std::string unit = unit_text(spec.x, frame.x);
  const std::string name = spec.x.label.empty() ? unit : spec.x.label + "  " + unit;
  const float room = 0.75f * frame.area.width();
  const float wide = std::min(room, text_size(Face::small, name).x);
  const float left = frame.area.max.x - wide;
  draw_clipped_text(frame.list, Face::small, {left, frame.area.max.y + 4 * frame.scale},
                    frame.palette.text, name, room);
  const float widest = text_size(Face::small, "\u22120.00").x;
  const auto most = static_cast<double>(frame.area.width() / (1.6f * widest));
  for (const AxisPlace& place : axis_places(spec.x, frame.x, most)) {
    draw_place_below(frame, place.value, place.label, left - 4 * frame.scale);
  }
}

constexpr float kThickness = 2;             // [px] at scale 1
constexpr float kDotsFrom = 7;              // samples further apart than this get dots [px]
constexpr float kTolerance = 0.2f;          // error at which points may be left out [px]
constexpr float kTallFrom = 6;              // height that neighbouring columns share [px]
constexpr std::size_t kGroup = 12;          // columns looked at together
constexpr std::size_t kLongestPath = 2000;  // as ImGui counts in 16 bits
constexpr float kSoftUpTo = 2.5f;           // wider bands need no soft rim [px]

// A point on the screen with the upper and lower edge of the curve there.
struct ScreenPoint {
  float x;
  float top;
  float bottom;
};

// Slopes at which a line from an anchor passes all points so far closely.
class Cone {
 public:
  bool admits(float dx, float dy) const { return dy >= low_ * dx && dy <= high_ * dx; }
  void narrow(float dx, float dy) {
    low_ = std::max(low_, (dy - kTolerance) / dx);
    high_ = std::min(high_, (dy + kTolerance) / dx);
  }

 private:
  float low_ = -1e9f;
  float high_ = 1e9f;
};

// Leaves out points that lie on the line between their neighbours. Smooth curves need a tenth of
// them, and triangles are what drawing in software costs.
void simplify(std::vector<ScreenPoint>& points) {
  if (points.size() < 3) return;
  std::size_t kept = 1;
  ScreenPoint anchor = points.front();
  ScreenPoint last = points[1];
  Cone top;
  Cone bottom;
  const auto narrow = [&](const ScreenPoint& p) {
    top.narrow(p.x - anchor.x, p.top - anchor.top);
    bottom.narrow(p.x - anchor.x, p.bottom - anchor.bottom);
  };
  narrow(last);
  for (std::size_t i = 2; i < points.size(); ++i) {
    const ScreenPoint p = points[i];
    const float dx = p.x - anchor.x;
    if (!top.admits(dx, p.top - anchor.top) || !bottom.admits(dx, p.bottom - anchor.bottom)) {
      points[kept++] = anchor = last;
      top = bottom = Cone();
    }
    narrow(p);
    last = p;
  }
  points[kept++] = last;
  points.resize(kept);
}

// A mesh of four rows of vertices, one column for each point, and the quads between them.
class Ribbon {
 public:
  // `quads`: the most that will be added.
  Ribbon(ImDrawList& list, int points, int quads)
      : list_(list), white_(ImGui::GetFontTexUvWhitePixel()), unused_(6 * quads) {
    list.PrimReserve(unused_, 4 * points);
    base_ = list._VtxCurrentIdx;
  }
  Ribbon(const Ribbon&) = delete;
  Ribbon& operator=(const Ribbon&) = delete;
  ~Ribbon() { list_.PrimUnreserve(unused_, 0); }

  void column(float x, std::array<float, 4> y, ImU32 outer, ImU32 inner) {
    list_.PrimWriteVtx({x, y[0]}, white_, outer);
    list_.PrimWriteVtx({x, y[1]}, white_, inner);
    list_.PrimWriteVtx({x, y[2]}, white_, inner);
    list_.PrimWriteVtx({x, y[3]}, white_, outer);
  }

  // Adds a quad between rows `row` and `row` + 1 from one column to another.
  void quad(std::size_t from, std::size_t to, unsigned row) {
    const unsigned a = base_ + 4 * static_cast<unsigned>(from) + row;
    const unsigned b = base_ + 4 * static_cast<unsigned>(to) + row;
    for (const unsigned index : {a, a + 1, b + 1, a, b + 1, b}) {
      list_.PrimWriteIdx(static_cast<ImDrawIdx>(index));
    }
    unused_ -= 6;
  }

 private:
  ImDrawList& list_;
  ImVec2 white_;
  int unused_;
  unsigned base_ = 0;
};

// Draws a band, thin parts with a soft rim like an antialiased line's. Parts as wide as the
// signal's noise have none.
void draw_thin(ImDrawList& list, std::span<const ScreenPoint> points, ImU32 solid) {
  const ImU32 clear = solid & ~IM_COL32_A_MASK;
  const auto count = static_cast<int>(points.size());
  Ribbon ribbon(list, count, 3 * (count - 1));
  for (const ScreenPoint& p : points) {
    ribbon.column(p.x, {p.top - 1, p.top, p.bottom, p.bottom + 1}, clear, solid);
  }
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    ribbon.quad(i, i + 1, 1);
    const ScreenPoint& a = points[i];
    const ScreenPoint& b = points[i + 1];
    if (std::min(a.bottom - a.top, b.bottom - b.top) > kSoftUpTo) continue;
    ribbon.quad(i, i + 1, 0);
    ribbon.quad(i, i + 1, 2);
  }
}

// Draws a tall band with the part common to all columns as one rectangle: a software renderer is
// slow at pieces a pixel wide.
void draw_tall(ImDrawList& list, std::span<const ScreenPoint> points, float core_top,
               float core_bottom, ImU32 solid) {
  const auto count = static_cast<int>(points.size());
  Ribbon ribbon(list, count, 2 * (count - 1) + 1);
  for (const ScreenPoint& p : points) {
    ribbon.column(p.x, {p.top, core_top, core_bottom, p.bottom}, solid, solid);
  }
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    ribbon.quad(i, i + 1, 0);
    ribbon.quad(i, i + 1, 2);
  }
  ribbon.quad(0, points.size() - 1, 1);
}

void draw_band(ImDrawList& list, std::span<const ScreenPoint> points, ImU32 solid) {
  if (points.size() == 1) {
    const ScreenPoint& p = points.front();
    list.AddRectFilled({p.x - 0.5f, p.top - 0.5f}, {p.x + 0.5f, p.bottom + 0.5f}, solid);
    return;
  }
  for (std::size_t from = 0; from + 1 < points.size(); from += kGroup) {
    const auto group = points.subspan(from, std::min(kGroup + 1, points.size() - from));
    const float top = std::ranges::max(group, {}, &ScreenPoint::top).top;
    const float bottom = std::ranges::min(group, {}, &ScreenPoint::bottom).bottom;
    if (bottom - top > kTallFrom) {
      draw_tall(list, group, top, bottom, solid);
    } else {
      draw_thin(list, group, solid);
    }
  }
}

void draw_line(const PlotFrame& frame, std::span<const ScreenPoint> points, ImU32 solid,
               float thickness) {
  for (std::size_t from = 0; from + 1 < points.size(); from += kLongestPath) {
    const auto part = points.subspan(from, std::min(kLongestPath + 1, points.size() - from));
    for (const ScreenPoint& p : part) frame.list.PathLineTo({p.x, p.top});
    // A width of whole pixels lets ImGui draw a line with a third of the triangles.
    frame.list.PathStroke(solid, 0, std::round(thickness));
  }
}

void draw_dots(const PlotFrame& frame, std::span<const TracePoint> points, ImU32 solid) {
  for (const TracePoint& p : points) {
    frame.list.AddCircleFilled({frame.area.min.x + p.x, frame.y_of(p.low)}, 2.2f * frame.scale,
                               solid, 8);
  }
}

bool far_apart(const PlotFrame& frame, std::span<const TracePoint> points) {
  if (points.size() < 2) return true;
  const float apart = (points.back().x - points.front().x) / static_cast<float>(points.size() - 1);
  return apart >= kDotsFrom * frame.scale;
}

constexpr float kBetweenSigns = 64;  // [px] at scale 1
constexpr float kSign = 3.6f;        // half the width of a sign

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

// Draws text over curves, readable through a veil of the background.
void draw_backed_text(const PlotFrame& frame, ImVec2 at, Rgb rgb, const std::string& text,
                      float veil) {
  const ImVec2 size = text_size(Face::small, text);
  const float pad = 3 * frame.scale;
  frame.list.AddRectFilled({at.x - pad, at.y}, {at.x + size.x + pad, at.y + size.y},
                           colour(frame.palette.panel, veil), pad);
  draw_text(frame.list, Face::small, at, rgb, text);
}

// Calls draw(mark, x) for the marks in sight, from the left.
template <class Draw>
void for_marks(const PlotFrame& frame, const History& history, Draw&& draw) {
  for (const PlotMark& mark : history.marks()) {
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

// Rows of labels from the bottom up.
class MarkRows {
 public:
  MarkRows(const PlotFrame& frame, float line) : frame_(frame), line_(line) {
    const float fit = frame.area.height() / line;
    most_ = std::clamp(static_cast<std::size_t>(fit), std::size_t{1}, kRows);
    usual_ = std::clamp(static_cast<std::size_t>(fit / 2), std::size_t{1}, kRows);
  }
  ScreenRect box(std::size_t row, float left, float width) const {
    const float bottom =
        frame_.area.max.y - static_cast<float>(within(row)) * line_ - 2 * frame_.scale;
    return {{left, bottom - line_}, {left + width, bottom}};
  }
  // Returns the lowest row with room that no curve crosses, else the lowest one in the lower half.
  std::optional<std::size_t> find(const LabelRoom& room, std::span<const Trace> traces, float left,
                                  float width) const {
    std::optional<std::size_t> crossed;
    for (std::size_t row = 0; row < most_; ++row) {
      const ScreenRect place = box(row, left, width);
      if (!room.has(place.box())) continue;
      if (std::ranges::none_of(traces, [&](const Trace& t) { return crosses(frame_, t, place); }))
        return row;
      if (!crossed && row < usual_) crossed = row;
    }
    return crossed;
  }

 private:
  static constexpr std::size_t kRows = 5;

  std::size_t within(std::size_t row) const { return std::min(row, most_ - 1); }

  const PlotFrame& frame_;
  float line_;
  std::size_t most_ = 1, usual_ = 1;
};

// Marks of one pixel; a note stands alone.
struct MarksAt {
  float x;
  bool note;
  std::vector<std::string> labels;
};

// Leaves out marks with these keys.
std::vector<MarksAt> marks_by_place(const PlotFrame& frame, const History& history,
                                    const std::vector<std::string>& said) {
  std::vector<MarksAt> places;
  for_marks(frame, history, [&](const PlotMark& mark, float x) {
    if (std::ranges::find(said, mark.key) != said.end()) return;
    const bool note = mark.key == kNoteMark;
    const bool same = !places.empty() && !note && !places.back().note && places.back().x == x;
    if (!same) places.push_back({x, note, {}});
    places.back().labels.push_back(mark.label);
  });
  return places;
}

// Returns each label of a few marks, or of those pointed at; of many the first and a count.
std::vector<std::string> labels_of(const MarksAt& at, bool pointed_at) {
  constexpr std::size_t kFew = 2;
  if (pointed_at || at.labels.size() <= kFew) return at.labels;
  return {fmt::format("{} and {} more", at.labels.front(), at.labels.size() - 1)};
}

constexpr float kLawEdge = 3;  // of a law's band, at its top [px]

// Calls draw(number, left, right) for each stretch, with its edges on the screen.
template <class Draw>
void for_stretches(const PlotFrame& frame, const Band& band, const History& history,
                   const std::vector<SampleIndex>& rows, Draw&& draw) {
  for (const BandStretch& stretch : band_stretches(band, history, rows)) {
    draw(stretch.said, frame.area.min.x + static_cast<float>(stretch.from),
         frame.area.min.x + static_cast<float>(stretch.to));
  }
}

// Draws the names of a band at `top`. Returns whether there are any.
bool draw_names(const PlotFrame& frame, const Band& band, float top, const History& history,
                const std::vector<SampleIndex>& rows, LabelRoom& room) {
  const float inset = 2 * frame.scale;
  const auto name_of = [&](int said) -> const std::string& {
    return band.names[static_cast<std::size_t>(said)];
  };
  std::vector<NamedStretch> stretches;
  for_stretches(frame, band, history, rows, [&](int now, float left, float right) {
    const std::string& name = name_of(now);
    const float width = name.empty() ? 0 : text_size(Face::small, name).x + inset;
    stretches.push_back(
        {now, static_cast<double>(left), static_cast<double>(right), static_cast<double>(width)});
  });
  // A short time under another law is a line without a name.
  const NameLine line{static_cast<double>(frame.area.min.x),
                      static_cast<double>(frame.area.max.x - 4 * frame.scale),
                      static_cast<double>(12 * frame.scale), !band.laws};
  const std::vector<PlacedName> placed = place_names(stretches, line);
  for (const PlacedName& each : placed) {
    const std::string& name = name_of(stretches[each.stretch].said);
    const ImVec2 size = text_size(Face::small, name);
    const ImVec2 at{static_cast<float>(each.left) + inset, top};
    draw_backed_text(frame, at, band.striped ? frame.palette.text : frame.palette.muted, name,
                     0.85f);
    room.take(ScreenRect{at, {at.x + size.x + 12 * frame.scale, at.y + size.y}}.box());
  }
  return !placed.empty();
}

// Draws stripes from lower left to upper right; those of stretches side by side fit together.
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

void draw_axes(const PlotFrame& frame, const PlotSpec& spec, double time_offset) {
  if (spec.kind == PlotKind::time) {
    draw_time_axis(frame, time_offset);
  } else {
    draw_across_axis(frame, spec);
  }
  draw_value_axis(frame, spec);
  const float zero = frame.y_of(0);
  if (spec.y.zero_line && !frame.y.log && zero >= frame.area.min.y && zero <= frame.area.max.y) {
    level_line(frame, zero, colour(frame.palette.axis));
  }
  const float left = frame.x_of(0);
  if (spec.kind == PlotKind::cross && spec.x.zero_line && left >= frame.area.min.x &&
      left <= frame.area.max.x) {
    upright_line(frame, left, colour(frame.palette.axis));
  }
}

void draw_trace(const PlotFrame& frame, const Trace& trace, const Curve& curve, float emphasis) {
  const float thickness = kThickness * frame.scale * std::max(1.0f, emphasis);
  const float half = trace.band ? 0.5f * (thickness - 1) : 0;
  const float alpha = std::min(1.0f, emphasis);
  std::vector<ScreenPoint> on_screen;
  for (const TraceRun& run : trace.runs) {
    const auto points = std::span(trace.points).subspan(run.first, run.count);
    on_screen.clear();
    for (const TracePoint& p : points) {
      on_screen.push_back(
          {frame.area.min.x + p.x, frame.y_of(p.high) - half, frame.y_of(p.low) + half});
    }
    if (!trace.wanders) simplify(on_screen);
    const ImU32 solid = colour(colour_of(frame.palette, curve, run.law), alpha);
    if (trace.band) {
      draw_band(frame.list, on_screen, solid);
    } else {
      draw_line(frame, on_screen, solid, thickness);
      if (!trace.wanders && far_apart(frame, points)) draw_dots(frame, points, solid);
    }
  }
}

void draw_run_sign(ImDrawList& list, ImVec2 at, RunSign sign, ImU32 rgba, ImU32 back, float scale) {
  const float r = kSign * scale;
  const ImVec2 from{at.x - r, at.y - r}, to{at.x + r, at.y + r};
  const auto triangle = [&](float size, ImU32 ink) {
    list.AddTriangleFilled({at.x, at.y - size}, {at.x + size, at.y + 0.8f * size},
                           {at.x - size, at.y + 0.8f * size}, ink);
  };
  switch (sign) {
    case RunSign::none: return;
    case RunSign::square:
      list.AddRectFilled({from.x - scale, from.y - scale}, {to.x + scale, to.y + scale}, back);
      return list.AddRectFilled(from, to, rgba);
    case RunSign::ring:
      list.AddCircleFilled(at, r + 1.2f * scale, back, 16);
      return list.AddCircle(at, r, rgba, 16, 1.8f * scale);
    case RunSign::triangle: triangle(r + 2 * scale, back); return triangle(1.2f * r, rgba);
  }
}

// Draws signs at whole distances along the time axis, or along the curve if that wanders.
void draw_run_signs(const PlotFrame& frame, const Trace& trace, const Curve& curve,
                    float emphasis) {
  if (curve.sign == RunSign::none) return;
  const float apart = std::round(kBetweenSigns * frame.scale);
  const auto place = [&](const TracePoint& p) {
    return ImVec2{frame.area.min.x + p.x, 0.5f * (frame.y_of(p.low) + frame.y_of(p.high))};
  };
  const double begins = trace.wanders ? 0
                                      : std::fmod(static_cast<double>(frame.window.first_pixel),
                                                  static_cast<double>(apart));
  for (const TraceRun& run : trace.runs) {
    const ImU32 rgba = colour(colour_of(frame.palette, curve, run.law), std::min(1.0f, emphasis));
    double way = 0;
    for (std::size_t i = run.first; i + 1 < run.first + run.count; ++i) {
      const ImVec2 from = place(trace.points[i]), to = place(trace.points[i + 1]);
      if (!trace.wanders) way = begins + static_cast<double>(from.x - frame.area.min.x);
      const double step = trace.wanders ? std::hypot(to.x - from.x, to.y - from.y)
                                        : static_cast<double>(to.x - from.x);
      const double next = apart * (std::floor(way / static_cast<double>(apart)) + 1);
      if (step > 0 && next <= way + step) {
        const auto part = static_cast<float>((next - way) / step);
        draw_run_sign(frame.list,
                      {from.x + part * (to.x - from.x), from.y + part * (to.y - from.y)},
                      curve.sign, rgba, colour(frame.palette.panel), frame.scale);
      }
      way += step;
    }
  }
}

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
    // A whole UTF-8 character goes: continuation bytes with their first one.
    if (shown.ends_with("\u2026")) shown.erase(shown.size() - 3);
    while (!shown.empty() && (shown.back() & 0xc0) == 0x80) shown.pop_back();
    if (!shown.empty()) shown.pop_back();
    if (!shown.empty()) shown += "\u2026";
  }
  draw_text(list, face, at, rgb, shown);
  return text_size(face, shown).x;
}

void draw_thresholds(const PlotFrame& frame, const PlotSpec& spec, LabelRoom& room) {
  for (const Threshold& each : spec.thresholds) {
    const float y = std::round(frame.y_of(each.value));
    if (y < frame.area.min.y || y > frame.area.max.y) continue;
    const Rgb rgb = ink(frame.palette, each.ink);
    dashed_line(frame, {frame.area.min.x, y}, {frame.area.max.x, y}, colour(rgb, 0.8f),
                3 * frame.scale);
    const ImVec2 size = text_size(Face::small, each.label);
    const auto places =
        room.beside_level(static_cast<double>(y), static_cast<double>(size.x),
                          static_cast<double>(size.y), static_cast<double>(5 * frame.scale));
    const auto box = room.take_first(places);
    if (!box) continue;
    const ImVec2 at{static_cast<float>(box->left), static_cast<float>(box->top)};
    draw_backed_text(frame, at, rgb, each.label, 0.75f);
  }
}

void draw_mark_lines(const PlotFrame& frame, const History& history) {
  float last = -1e9f;
  for_marks(frame, history, [&](const PlotMark& mark, float x) {
    if (mark.key == kNoteMark) {
      const float r = 4 * frame.scale, top = frame.area.min.y;
      upright_line(frame, x, colour(frame.palette.text, 0.7f));
      frame.list.AddRectFilled({x, top}, {x + 2 * r, top + 1.4f * r}, colour(frame.palette.text));
      return;
    }
    if (x - last < 3 * frame.scale) return;
    dashed_line(frame, {x, frame.area.min.y}, {x, frame.area.max.y},
                colour(frame.palette.muted, 0.45f), 2 * frame.scale);
    last = x;
  });
}

std::optional<double> note_near(const PlotFrame& frame, const History& history, ImVec2 mouse) {
  std::optional<double> found;
  float nearest = 5 * frame.scale;
  for_marks(frame, history, [&](const PlotMark& mark, float x) {
    const float apart = std::abs(x - mouse.x);
    if (mark.key != kNoteMark || apart > nearest) return;
    nearest = apart;
    found = mark.time;
  });
  return found;
}

// Draws labels right of their lines, at the end left of them.
void draw_mark_labels(const PlotFrame& frame, const PlotSpec& spec, const History& history,
                      const std::vector<SampleIndex>& pixels, std::span<const Trace> traces,
                      ImVec2 mouse, LabelRoom& room) {
  const MarkRows rows(frame, text_size(Face::small, "0").y);
  const std::vector<std::string> said = said_by_bands(spec.bands, history, pixels);
  const float gap = 4 * frame.scale;
  for (const MarksAt& at : marks_by_place(frame, history, said)) {
    const bool pointed_at = frame.area.contains(mouse) && std::abs(mouse.x - at.x) < gap;
    std::size_t forced = 0;  // rows for what is pointed at, whatever is there
    for (const std::string& label : labels_of(at, pointed_at)) {
      const float width = text_size(Face::small, label).x;
      const bool at_the_end = at.x + gap + width > frame.area.max.x;
      const float left = at_the_end ? at.x - gap - width : at.x + gap;
      const auto row = rows.find(room, traces, left, width);
      if (!row && !pointed_at) continue;
      const ScreenRect place = rows.box(row ? *row : forced++, left, width);
      draw_backed_text(frame, place.min, at.note ? frame.palette.text : frame.palette.muted, label,
                       pointed_at ? 1.0f : 0.85f);
      room.take(ScreenRect{place.min, {place.max.x + 6 * frame.scale, place.max.y}}.box());
    }
  }
}

void draw_bands(const PlotFrame& frame, const PlotSpec& spec, const History& history,
                const std::vector<SampleIndex>& rows) {
  for (const Band& band : spec.bands) {
    const auto most = static_cast<float>(std::max<std::size_t>(2, band.names.size()) - 1);
    for_stretches(frame, band, history, rows, [&](int now, float left, float right) {
      if (band.striped && now > 0) return draw_stripes(frame, left, right);
      if (band.laws) {
        const Rgb law = law_ink(frame.palette, now);
        const float edge = kLawEdge * frame.scale;
        const float top =
            frame.area.min.y + (edge + 1) * static_cast<float>(std::max(0, band.lane));
        if (band.lane < 0) {
          frame.list.AddRectFilled({left, top}, {right, frame.area.max.y}, colour(law, band.tint));
        }
        frame.list.AddRectFilled({left, top}, {right, top + edge}, colour(law));
        return;
      }
      if (now == 0) return;
      frame.list.AddRectFilled(
          {left, frame.area.min.y}, {right, frame.area.max.y},
          colour(frame.palette.accent, band.tint * static_cast<float>(now) / most));
    });
  }
}

void draw_band_names(const PlotFrame& frame, const PlotSpec& spec, const History& history,
                     const std::vector<SampleIndex>& rows, LabelRoom& room) {
  const float height = text_size(Face::small, "0").y;
  // Names would fill a low plot.
  if (frame.area.height() < 6 * height) return;
  const auto edges = static_cast<float>(law_edges(spec.bands));
  float top = frame.area.min.y + edges * (kLawEdge * frame.scale + 1);
  for (const Band& band : spec.bands) {
    if (draw_names(frame, band, top, history, rows, room)) top += height;
  }
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

void draw_range(const PlotFrame& frame, double start, double stop) {
  const float left = std::max(frame.x_of(start), frame.area.min.x);
  const float right = std::min(frame.x_of(stop), frame.area.max.x);
  if (left > right) return;
  frame.list.AddRectFilled({left, frame.area.min.y}, {right, frame.area.max.y},
                           colour(frame.palette.accent, 0.18f));
  upright_line(frame, left, colour(frame.palette.accent));
  upright_line(frame, right - 1, colour(frame.palette.accent));
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
