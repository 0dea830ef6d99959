#include <cmath>

#include "app/plot/plot_frame.h"

namespace limpid {
namespace {

constexpr float kThickness = 1.6f;  // [px] at scale 1
constexpr float kFaint = 0.22f;     // of a curve's opacity, between dashes
constexpr float kDotsFrom = 7;      // samples further apart than this get dots [px]
constexpr float kTolerance = 0.2f;  // by which points may be left out [px]
constexpr float kSoftUpTo = 2.5f;     // wider bands need no soft rim [px]

// A point on the screen with the upper and lower edge of the curve there.
struct ScreenPoint {
  float x;
  float top;
  float bottom;
};

// Slopes a line from an anchor may have to pass all points so far closely.
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

// Leaves out points that lie on the line between their neighbours: smooth curves need a tenth of
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

// A band is a strip between two edges. Where it is thin it gets a soft rim, like an antialiased
// line; where it is as wide as the signal's noise it gets none.
void draw_strip(ImDrawList& list, std::span<const ScreenPoint> points, ImU32 solid) {
  const ImU32 clear = solid & ~IM_COL32_A_MASK;
  const ImVec2 white = ImGui::GetFontTexUvWhitePixel();
  const auto count = static_cast<int>(points.size());
  list.PrimReserve((count - 1) * 18, count * 4);
  const unsigned base = list._VtxCurrentIdx;
  int spared = 0;
  const auto quad = [&](unsigned a) {
    for (const unsigned index : {a, a + 1, a + 5, a, a + 5, a + 4}) {
      list.PrimWriteIdx(static_cast<ImDrawIdx>(index));
    }
  };
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const unsigned at = base + 4 * static_cast<unsigned>(i);
    quad(at + 1);
    const float thinner = std::min(points[i].bottom - points[i].top,
                                   points[i + 1].bottom - points[i + 1].top);
    if (thinner > kSoftUpTo) {
      spared += 12;
    } else {
      quad(at);
      quad(at + 2);
    }
  }
  for (const ScreenPoint& p : points) {
    list.PrimWriteVtx({p.x, p.top - 1}, white, clear);
    list.PrimWriteVtx({p.x, p.top}, white, solid);
    list.PrimWriteVtx({p.x, p.bottom}, white, solid);
    list.PrimWriteVtx({p.x, p.bottom + 1}, white, clear);
  }
  list.PrimUnreserve(spared, 0);
}

void draw_band(const PlotFrame& frame, std::span<const ScreenPoint> points, ImU32 solid) {
  if (points.size() == 1) {
    const ScreenPoint& p = points.front();
    frame.list.AddRectFilled({p.x - 0.5f, p.top - 0.5f}, {p.x + 0.5f, p.bottom + 0.5f}, solid);
    return;
  }
  constexpr std::size_t kChunk = 4000;  // keeps the vertices within 16 bit indices
  for (std::size_t from = 0; from + 1 < points.size(); from += kChunk - 1) {
    draw_strip(frame.list, points.subspan(from, std::min(kChunk, points.size() - from)), solid);
  }
}

void draw_line(const PlotFrame& frame, std::span<const ScreenPoint> points, ImU32 solid,
               float thickness) {
  for (const ScreenPoint& p : points) frame.list.PathLineTo({p.x, p.top});
  // Whole pixels let ImGui draw a line with a third of the triangles.
  frame.list.PathStroke(solid, 0, std::round(thickness));
}

void draw_dots(const PlotFrame& frame, std::span<const TracePoint> points, ImU32 solid) {
  for (const TracePoint& p : points) {
    frame.list.AddCircleFilled({frame.area.min.x + p.x, frame.y_of(p.low)}, 2.2f * frame.scale,
                               solid, 8);
  }
}

bool far_apart(const PlotFrame& frame, std::span<const TracePoint> points) {
  if (points.size() < 2) return true;
  const float apart =
      (points.back().x - points.front().x) / static_cast<float>(points.size() - 1);
  return apart >= kDotsFrom * frame.scale;
}

}  // namespace

void draw_trace(const PlotFrame& frame, const Trace& trace, Rgb rgb, float emphasis) {
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
    simplify(on_screen);
    const ImU32 solid = colour(rgb, run.faint ? kFaint * alpha : alpha);
    if (trace.band) {
      draw_band(frame, on_screen, solid);
    } else {
      draw_line(frame, on_screen, solid, thickness);
      if (!run.faint && far_apart(frame, points)) draw_dots(frame, points, solid);
    }
  }
}

}  // namespace limpid
