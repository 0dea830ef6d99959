#include <array>
#include <cmath>

#include "app/plot/plot_frame.h"

namespace limpid {
namespace {

constexpr float kThickness = 2;             // [px] at scale 1
constexpr float kDotsFrom = 7;              // samples further apart than this get dots [px]
constexpr float kTolerance = 0.2f;          // by which points may be left out [px]
constexpr float kTallFrom = 6;              // height that neighbouring columns share [px]
constexpr std::size_t kGroup = 12;          // columns looked at together
constexpr std::size_t kLongestPath = 2000;  // what ImGui counts in 16 bits
constexpr float kSoftUpTo = 2.5f;           // wider bands need no soft rim [px]

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

// Four rows of vertices, one column for each point, and the quads between them.
class Mesh {
 public:
  // `quads`: at most so many will be added.
  Mesh(ImDrawList& list, int points, int quads)
      : list_(list), white_(ImGui::GetFontTexUvWhitePixel()), unused_(6 * quads) {
    list.PrimReserve(unused_, 4 * points);
    base_ = list._VtxCurrentIdx;
  }
  Mesh(const Mesh&) = delete;
  Mesh& operator=(const Mesh&) = delete;
  ~Mesh() { list_.PrimUnreserve(unused_, 0); }

  void column(float x, std::array<float, 4> y, ImU32 outer, ImU32 inner) {
    list_.PrimWriteVtx({x, y[0]}, white_, outer);
    list_.PrimWriteVtx({x, y[1]}, white_, inner);
    list_.PrimWriteVtx({x, y[2]}, white_, inner);
    list_.PrimWriteVtx({x, y[3]}, white_, outer);
  }

  // Between rows `row` and `row` + 1 from one column to another.
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

// A soft rim where the band is thin, like that of an antialiased line; none where it is as wide as
// the signal's noise.
void draw_thin(ImDrawList& list, std::span<const ScreenPoint> points, ImU32 solid) {
  const ImU32 clear = solid & ~IM_COL32_A_MASK;
  const auto count = static_cast<int>(points.size());
  Mesh mesh(list, count, 3 * (count - 1));
  for (const ScreenPoint& p : points) {
    mesh.column(p.x, {p.top - 1, p.top, p.bottom, p.bottom + 1}, clear, solid);
  }
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    mesh.quad(i, i + 1, 1);
    const ScreenPoint& a = points[i];
    const ScreenPoint& b = points[i + 1];
    if (std::min(a.bottom - a.top, b.bottom - b.top) > kSoftUpTo) continue;
    mesh.quad(i, i + 1, 0);
    mesh.quad(i, i + 1, 2);
  }
}

// What all columns have in common is one rectangle: filling it in pieces a pixel wide is what
// takes a software renderer long.
void draw_tall(ImDrawList& list, std::span<const ScreenPoint> points, float core_top,
               float core_bottom, ImU32 solid) {
  const auto count = static_cast<int>(points.size());
  Mesh mesh(list, count, 2 * (count - 1) + 1);
  for (const ScreenPoint& p : points) {
    mesh.column(p.x, {p.top, core_top, core_bottom, p.bottom}, solid, solid);
  }
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    mesh.quad(i, i + 1, 0);
    mesh.quad(i, i + 1, 2);
  }
  mesh.quad(0, points.size() - 1, 1);
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
    // Whole pixels let ImGui draw a line with a third of the triangles.
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
    if (!trace.wanders) simplify(on_screen);
    const ImU32 solid = colour(rgb, alpha);
    if (trace.band) {
      draw_band(frame.list, on_screen, solid);
    } else {
      draw_line(frame, on_screen, solid, thickness);
      if (!trace.wanders && far_apart(frame, points)) draw_dots(frame, points, solid);
    }
  }
}

}  // namespace limpid
