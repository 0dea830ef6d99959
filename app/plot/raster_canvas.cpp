#include "app/plot/raster_canvas.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "app/style/theme.h"

namespace limpid {
namespace {

using Point = PlotCanvas::Point;
using Contour = std::vector<Point>;

constexpr int kCorners = 12;  // of a round end

// Covered part of each pixel. Every edge adds, in the rows that it crosses, how much it shadows
// what is right of it. Holes turn the other way round.
class Coverage {
 public:
  Coverage(int width, int height)
      : width_(width),
        height_(height),
        all_(static_cast<std::size_t>(width + 2) * static_cast<std::size_t>(height)) {}

  void add(const Contour& contour) {
    for (std::size_t i = 0; i < contour.size(); ++i) {
      edge(contour[i], contour[(i + 1) % contour.size()]);
    }
  }

  // Calls paint(x, y, covered) for each covered pixel, 0 to 1, and is empty then.
  template <class Paint>
  void sweep(const Paint& paint) {
    for (int y = top_; y < bottom_; ++y) {
      float sum = 0;
      float* row = row_of(y);
      for (int x = left_; x < std::min(right_, width_); ++x) {
        sum += row[x];
        row[x] = 0;
        const float covered = std::min(std::abs(sum), 1.0f);
        if (covered > 1e-3f) paint(x, y, covered);
      }
      row[width_] = row[width_ + 1] = 0;
    }
    top_ = height_;
    left_ = width_;
    bottom_ = right_ = 0;
  }

 private:
  float* row_of(int y) {
    return all_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width_ + 2);
  }

  void edge(Point from, Point to) {
    if (from.y == to.y) return;
    const float direction = from.y < to.y ? 1 : -1;
    if (from.y > to.y) std::swap(from, to);
    const double slope = (to.x - from.x) / (to.y - from.y);
    const int first = std::max(0, static_cast<int>(std::floor(from.y)));
    const int last = std::min(height_, static_cast<int>(std::ceil(to.y)));
    top_ = std::min(top_, first);
    bottom_ = std::max(bottom_, last);
    for (int y = first; y < last; ++y) {
      const double low = std::max<double>(y, from.y), high = std::min<double>(y + 1, to.y);
      if (high <= low) continue;
      const double x0 = from.x + (low - from.y) * slope, x1 = from.x + (high - from.y) * slope;
      shadow(row_of(y), std::min(x0, x1), std::max(x0, x1),
             direction * static_cast<float>(high - low));
    }
  }

  // Adds an edge from x0 to x1 within one row, of the height `part`.
  void shadow(float* row, double x0, double x1, float part) {
    const double most = width_;
    x0 = std::clamp(x0, 0.0, most);
    x1 = std::clamp(x1, 0.0, most);
    const int first = static_cast<int>(std::floor(x0)), last = static_cast<int>(std::floor(x1));
    left_ = std::min(left_, first);
    right_ = std::max(right_, last + 2);
    if (first == last) {
      const auto right = static_cast<float>(0.5 * (x0 + x1) - first);  // uncovered part
      row[first] += part * (1 - right);
      row[first + 1] += part * right;
      return;
    }
    // The covered part up to pixel x grows as the edge goes across it.
    const double wide = x1 - x0;
    float before = 0;
    for (int x = first; x <= last; ++x) {
      const double a = std::max(x0, static_cast<double>(x)), b = std::min(x1, x + 1.0);
      const double crossed = (b - a) / wide;
      const double mean = x + 1 - 0.5 * (a + b);  // part of the pixel right of the edge, on average
      const double reached = (a - x0) / wide;
      const auto now = static_cast<float>(reached + crossed * mean);
      row[x] += part * (now - before);
      before = now;
    }
    row[last + 1] += part * (1 - before);
  }

  int width_, height_;
  int top_ = 1 << 30, bottom_ = 0, left_ = 1 << 30, right_ = 0;  // area that is covered
  std::vector<float> all_;
};

Contour circle(Point middle, double radius, int corners) {
  Contour contour;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    contour.push_back({middle.x + radius * std::cos(angle), middle.y + radius * std::sin(angle)});
  }
  return contour;
}

Contour band(Point from, Point to, double width) {
  const double x = to.x - from.x, y = to.y - from.y, length = std::hypot(x, y);
  if (length == 0) return {};
  const double nx = -y / length * width / 2, ny = x / length * width / 2;
  return {{from.x + nx, from.y + ny},
          {to.x + nx, to.y + ny},
          {to.x - nx, to.y - ny},
          {from.x - nx, from.y - ny}};
}

Contour corners_of(const PlotCanvas::Box& box) {
  const double right = box.left + box.width, bottom = box.top + box.height;
  return {{box.left, box.top}, {right, box.top}, {right, bottom}, {box.left, bottom}};
}

// Decodes UTF-8; leaves out bytes that are no character.
std::vector<unsigned long> characters(const std::string& text) {
  std::vector<unsigned long> all;
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const std::size_t length = byte < 0x80 ? 1 : byte < 0xe0 ? 2 : byte < 0xf0 ? 3 : 4;
    unsigned long code = length == 1 ? byte : byte & (0xffu >> (length + 1));
    for (std::size_t k = 1; k < length && i + k < text.size(); ++k) {
      code = code << 6 | (static_cast<unsigned char>(text[i + k]) & 0x3f);
    }
    all.push_back(code);
    i += length;
  }
  return all;
}

// Outlines of glyphs, by FreeType.
class Type {
 public:
  Type() {
    if (FT_Init_FreeType(&library_) != 0) library_ = nullptr;
    const std::array files{font_file(Face::regular), font_file(Face::semibold)};
    for (std::size_t i = 0; library_ != nullptr && i < files.size(); ++i) {
      if (files[i].empty() || FT_New_Face(library_, files[i].c_str(), 0, &faces_[i]) != 0) {
        faces_[i] = nullptr;
      }
    }
  }
  ~Type() {
    if (library_ != nullptr) FT_Done_FreeType(library_);  // and its faces
  }
  Type(const Type&) = delete;
  Type& operator=(const Type&) = delete;

  // Adds the outlines of a text `size` high, from (0, 0) on the base line on; returns its width.
  double outlines(const std::string& text, bool bold, double size, std::vector<Contour>& into) {
    FT_Face face = faces_[bold ? 1 : 0];
    if (face == nullptr) return 0;
    pen_ = {size / face->units_per_EM, 0, &into};
    for (const unsigned long code : characters(text)) {
      if (FT_Load_Char(face, code, FT_LOAD_NO_SCALE) != 0) continue;
      const FT_Outline_Funcs funcs{move_to, line_to, conic_to, cubic_to, 0, 0};
      FT_Outline_Decompose(&face->glyph->outline, &funcs, &pen_);
      pen_.x += static_cast<double>(face->glyph->advance.x) * pen_.scale;
    }
    return pen_.x;
  }

 private:
  struct Pen {
    double scale = 1, x = 0;
    std::vector<Contour>* into = nullptr;

    Point at(const FT_Vector* v) const {
      return {x + static_cast<double>(v->x) * scale, -static_cast<double>(v->y) * scale};
    }
    Point last() const { return into->back().back(); }
    void put(Point p) const { into->back().push_back(p); }
  };
  static Pen& pen(void* user) { return *static_cast<Pen*>(user); }

  static int move_to(const FT_Vector* to, void* user) {
    pen(user).into->push_back({pen(user).at(to)});
    return 0;
  }
  static int line_to(const FT_Vector* to, void* user) {
    pen(user).put(pen(user).at(to));
    return 0;
  }
  static int conic_to(const FT_Vector* control, const FT_Vector* to, void* user) {
    const Point a = pen(user).last(), b = pen(user).at(control), c = pen(user).at(to);
    for (int i = 1; i <= kSteps; ++i) {
      const double t = static_cast<double>(i) / kSteps, s = 1 - t;
      pen(user).put({s * s * a.x + 2 * s * t * b.x + t * t * c.x,
                     s * s * a.y + 2 * s * t * b.y + t * t * c.y});
    }
    return 0;
  }
  static int cubic_to(const FT_Vector* first, const FT_Vector* second, const FT_Vector* to,
                      void* user) {
    const Point a = pen(user).last(), b = pen(user).at(first), c = pen(user).at(second),
                d = pen(user).at(to);
    for (int i = 1; i <= kSteps; ++i) {
      const double t = static_cast<double>(i) / kSteps, s = 1 - t;
      const double w0 = s * s * s, w1 = 3 * s * s * t, w2 = 3 * s * t * t, w3 = t * t * t;
      pen(user).put(
          {w0 * a.x + w1 * b.x + w2 * c.x + w3 * d.x, w0 * a.y + w1 * b.y + w2 * c.y + w3 * d.y});
    }
    return 0;
  }

  static constexpr int kSteps = 6;  // of a curve

  FT_Library library_ = nullptr;
  std::array<FT_Face, 2> faces_{};
  Pen pen_;
};

}  // namespace

struct RasterCanvas::Impl {
  Impl(double wide, double high, double pixels, Rgb paper)
      : scale(pixels),
        raster{std::max(1, static_cast<int>(std::lround(wide * pixels))),
               std::max(1, static_cast<int>(std::lround(high * pixels))),
               {}},
        coverage(raster.width, raster.height) {
    const auto count =
        static_cast<std::size_t>(raster.width) * static_cast<std::size_t>(raster.height);
    raster.rgba.reserve(4 * count);
    for (std::size_t i = 0; i < count; ++i) {
      for (const unsigned char part : {paper.r, paper.g, paper.b, std::uint8_t{255}}) {
        raster.rgba.push_back(part);
      }
    }
    mask.resize(count);
    clip_to(nullptr);
  }

  Contour scaled(Contour contour) const {
    for (Point& p : contour) p = {p.x * scale, p.y * scale};
    return contour;
  }
  void add(const Contour& contour) {
    if (contour.size() > 2) coverage.add(scaled(contour));
  }

  // Adds a piece of a line, which overlaps others: each pixel is covered as by the piece that
  // covers it most.
  void add_piece(const Contour& contour) {
    add(contour);
    coverage.sweep([&](int x, int y, float covered) {
      float& most = mask[index(x, y)];
      if (most == 0) touched.push_back({x, y});
      most = std::max(most, covered);
    });
  }
  void paint_line(std::span<const Point> points, double width, Rgb rgb) {
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      add_piece(band(points[i], points[i + 1], width));
    }
    for (const Point& p : points) add_piece(circle(p, width / 2, kCorners));
    for (const auto& [x, y] : touched) {
      blend_in(x, y, std::exchange(mask[index(x, y)], 0.0f), rgb);
    }
    touched.clear();
  }

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(raster.width) +
           static_cast<std::size_t>(x);
  }

  void paint(Rgb rgb, double alpha) {
    coverage.sweep([&](int x, int y, float covered) {
      blend_in(x, y, covered * static_cast<float>(alpha), rgb);
    });
  }

  void blend_in(int x, int y, float part, Rgb rgb) {
    if (x < left || x >= right || y < top || y >= bottom) return;
    unsigned char* pixel = raster.rgba.data() + 4 * index(x, y);
    const auto blend = [part](unsigned char from, std::uint8_t to) {
      const float mixed =
          static_cast<float>(from) + part * (static_cast<float>(to) - static_cast<float>(from));
      return static_cast<unsigned char>(std::lround(mixed));
    };
    pixel[0] = blend(pixel[0], rgb.r);
    pixel[1] = blend(pixel[1], rgb.g);
    pixel[2] = blend(pixel[2], rgb.b);
  }

  void clip_to(const Box* box) {
    const auto pixel = [&](double at, int most) {
      return std::clamp(static_cast<int>(std::lround(at * scale)), 0, most);
    };
    left = top = 0;
    right = raster.width;
    bottom = raster.height;
    if (box == nullptr) return;
    left = pixel(box->left, raster.width);
    top = pixel(box->top, raster.height);
    right = pixel(box->left + box->width, raster.width);
    bottom = pixel(box->top + box->height, raster.height);
  }

  double scale;
  Raster raster;
  Coverage coverage;
  std::vector<float> mask;  // of the line that is drawn
  std::vector<std::pair<int, int>> touched;
  Type type;
  int left = 0, top = 0, right = 0, bottom = 0;
};

RasterCanvas::RasterCanvas(double width, double height, double scale, Rgb paper)
    : impl_(std::make_unique<Impl>(width, height, scale, paper)) {}
RasterCanvas::~RasterCanvas() = default;

Raster RasterCanvas::take() { return std::move(impl_->raster); }

void RasterCanvas::clip(const Box* box) { impl_->clip_to(box); }

void RasterCanvas::rect(const Box& box, Rgb fill, double alpha) {
  impl_->add(corners_of(box));
  impl_->paint(fill, alpha);
}

void RasterCanvas::outline(const Box& box, Rgb rgb) {
  Contour corners = corners_of(box);
  corners.push_back(corners.front());
  impl_->paint_line(corners, 1, rgb);
}

// Draws stripes from upper left to lower right, 7 px apart, over a veil.
void RasterCanvas::stripes(const Box& box, Rgb rgb) {
  rect(box, rgb, 0.1);
  const double apart = 7 * std::numbers::sqrt2;
  for (double x = box.left - box.height; x < box.left + box.width; x += apart) {
    // Stripes are cut to the box.
    const double from = std::max(0.0, box.left - x);
    const double to = std::min(box.height, box.left + box.width - x);
    if (from < to) impl_->add(band({x + from, box.top + from}, {x + to, box.top + to}, 1));
  }
  impl_->paint(rgb, 0.5);
}

void RasterCanvas::line(Point from, Point to, Rgb rgb, double width, double dash, double gap) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  const auto at = [&](double way) {
    const double part = way / length;
    return Point{from.x + part * (to.x - from.x), from.y + part * (to.y - from.y)};
  };
  if (dash <= 0) {
    impl_->add(band(from, to, width));
  } else {
    for (double way = 0; way < length; way += dash + gap) {
      impl_->add(band(at(way), at(std::min(way + dash, length)), width));
    }
  }
  impl_->paint(rgb, 1);
}

void RasterCanvas::polyline(std::span<const Point> points, Rgb rgb, double width) {
  impl_->paint_line(points, width, rgb);
}

void RasterCanvas::polygon(std::span<const Point> points, Rgb rgb, double width) {
  impl_->add({points.begin(), points.end()});
  impl_->paint(rgb, 1);
  Contour edge(points.begin(), points.end());
  if (!edge.empty()) edge.push_back(edge.front());
  polyline(edge, rgb, width);
}

void RasterCanvas::square(Point middle, double half, Rgb fill, Rgb edge) {
  const Box box{middle.x - half, middle.y - half, 2 * half, 2 * half};
  rect(box, fill, 1);
  outline(box, edge);
}

void RasterCanvas::ring(Point middle, double radius, Rgb edge, Rgb fill) {
  Contour around = circle(middle, radius, 4 * kCorners);
  impl_->add(around);
  impl_->paint(fill, 1);
  around.push_back(around.front());
  polyline(around, edge, 1.8);
}

void RasterCanvas::text(Point at, Anchor anchor, Rgb rgb, const std::string& what, bool bold) {
  std::vector<Contour> outlines;
  const double wide = impl_->type.outlines(what, bold, kCanvasFont, outlines);
  const double left = anchor == Anchor::start    ? at.x
                      : anchor == Anchor::middle ? at.x - wide / 2
                                                 : at.x - wide;
  for (Contour& contour : outlines) {
    for (Point& p : contour) p = {p.x + left, p.y + at.y};
    impl_->add(contour);
  }
  impl_->paint(rgb, 1);
}

}  // namespace limpid
