#include "app/plot/cairo_canvas.h"

#include <cairo-ft.h>
#include <cairo-pdf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "app/style/theme.h"
#include "core/base/utf8.h"

namespace limpid {
namespace {

template <auto kFree>
struct Frees {
  template <class T>
  void operator()(T* what) const {
    kFree(what);
  }
};
using Surface = std::unique_ptr<cairo_surface_t, Frees<cairo_surface_destroy>>;
using Context = std::unique_ptr<cairo_t, Frees<cairo_destroy>>;
using FontFace = std::unique_ptr<cairo_font_face_t, Frees<cairo_font_face_destroy>>;

// Returns the font of a file; null where there is none.
FontFace face_of(const std::string& file) {
  if (file.empty()) return nullptr;
  const std::unique_ptr<FcPattern, Frees<FcPatternDestroy>> pattern(FcPatternCreate());
  FcPatternAddString(pattern.get(), FC_FILE, reinterpret_cast<const FcChar8*>(file.c_str()));
  FcPatternAddInteger(pattern.get(), FC_INDEX, 0);
  FontFace face(cairo_ft_font_face_create_for_pattern(pattern.get()));
  return cairo_font_face_status(face.get()) == CAIRO_STATUS_SUCCESS ? std::move(face) : nullptr;
}

cairo_status_t append(void* to, const unsigned char* bytes, unsigned count) noexcept {
  try {
    static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(bytes), count);
    return CAIRO_STATUS_SUCCESS;
  } catch (const std::bad_alloc&) {
    return CAIRO_STATUS_NO_MEMORY;
  }
}

// Cairo draws nothing more after an error. Errors: std::runtime_error.
void check(cairo_status_t status) {
  if (status == CAIRO_STATUS_SUCCESS) return;
  throw std::runtime_error(std::string("the picture cannot be drawn: ") +
                           cairo_status_to_string(status));
}

}  // namespace

struct CairoCanvas::Impl {
  std::string document;  // bytes of PDF until now; the surface writes there to its end
  Surface surface;
  Context cairo;
  std::array<FontFace, 2> faces;  // regular, semibold

  // Begins to draw on the surface, whose paper is filled.
  void begin(cairo_surface_t* on, double scale, Rgb paper) {
    surface.reset(on);
    check(cairo_surface_status(on));
    cairo.reset(cairo_create(on));
    check(cairo_status(cairo.get()));
    faces = {face_of(font_file(Face::regular)), face_of(font_file(Face::semibold))};
    use(paper);
    cairo_paint(cairo.get());
    cairo_scale(cairo.get(), scale, scale);
    cairo_set_antialias(cairo.get(), CAIRO_ANTIALIAS_BEST);
    cairo_set_line_join(cairo.get(), CAIRO_LINE_JOIN_ROUND);
    // Text without hints is as wide at any resolution.
    cairo_font_options_t* options = cairo_font_options_create();
    cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_set_font_options(cairo.get(), options);
    cairo_font_options_destroy(options);
  }

  void use(Rgb rgb, double alpha = 1) {
    cairo_set_source_rgba(cairo.get(), rgb.r / 255.0, rgb.g / 255.0, rgb.b / 255.0, alpha);
  }
  void path(const Box& box) {
    cairo_rectangle(cairo.get(), box.left, box.top, box.width, box.height);
  }
  void path(std::span<const Point> points) {
    for (const Point& p : points) cairo_line_to(cairo.get(), p.x, p.y);
  }
  void fill(Rgb rgb, double alpha = 1) {
    use(rgb, alpha);
    cairo_fill(cairo.get());
  }
  void stroke(Rgb rgb, double width, cairo_line_cap_t cap = CAIRO_LINE_CAP_BUTT) {
    use(rgb);
    cairo_set_line_width(cairo.get(), width);
    cairo_set_line_cap(cairo.get(), cap);
    cairo_stroke(cairo.get());
  }
};

CairoCanvas::CairoCanvas(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
CairoCanvas::~CairoCanvas() = default;

void CairoCanvas::rect(const Box& box, Rgb fill, double alpha) {
  impl_->path(box);
  impl_->fill(fill, alpha);
}

void CairoCanvas::outline(const Box& box, Rgb rgb) {
  impl_->path(box);
  impl_->stroke(rgb, 1);
}

// Draws stripes from upper left to lower right, 7 px apart, over a veil.
void CairoCanvas::stripes(const Box& box, Rgb rgb) {
  rect(box, rgb, 0.1);
  cairo_t* cairo = impl_->cairo.get();
  cairo_save(cairo);
  impl_->path(box);
  cairo_clip(cairo);
  const double apart = 7 * std::numbers::sqrt2;
  for (double x = box.left - box.height; x < box.left + box.width; x += apart) {
    cairo_move_to(cairo, x, box.top);
    cairo_line_to(cairo, x + box.height, box.top + box.height);
  }
  impl_->use(rgb, 0.5);
  cairo_set_line_width(cairo, 1);
  cairo_stroke(cairo);
  cairo_restore(cairo);
}

void CairoCanvas::line(Point from, Point to, Rgb rgb, double width, double dash, double gap) {
  cairo_t* cairo = impl_->cairo.get();
  const std::array lengths{dash, gap};
  if (dash > 0) cairo_set_dash(cairo, lengths.data(), 2, 0);
  impl_->path(std::array{from, to});
  impl_->stroke(rgb, width);
  cairo_set_dash(cairo, nullptr, 0, 0);
}

void CairoCanvas::polyline(std::span<const Point> points, Rgb rgb, double width) {
  impl_->path(points);
  impl_->stroke(rgb, width, CAIRO_LINE_CAP_ROUND);
}

void CairoCanvas::polygon(std::span<const Point> points, Rgb rgb, double width) {
  impl_->path(points);
  cairo_close_path(impl_->cairo.get());
  impl_->use(rgb);
  cairo_fill_preserve(impl_->cairo.get());
  if (width > 0) impl_->stroke(rgb, width);
  cairo_new_path(impl_->cairo.get());
}

void CairoCanvas::square(Point middle, double half, Rgb fill, Rgb edge) {
  const Box box{middle.x - half, middle.y - half, 2 * half, 2 * half};
  rect(box, fill, 1);
  outline(box, edge);
}

void CairoCanvas::ring(Point middle, double radius, Rgb edge, Rgb fill) {
  cairo_t* cairo = impl_->cairo.get();
  cairo_arc(cairo, middle.x, middle.y, radius, 0, 2 * std::numbers::pi);
  impl_->use(fill);
  cairo_fill_preserve(cairo);
  impl_->stroke(edge, 1.8);
}

void CairoCanvas::text(Point at, Anchor anchor, Rgb rgb, const std::string& what, bool bold) {
  cairo_font_face_t* face = impl_->faces[bold ? 1 : 0].get();
  if (face == nullptr) return;
  const std::string valid = utf8_of(what);  // bytes that are none would spoil all that follows
  cairo_t* cairo = impl_->cairo.get();
  cairo_set_font_face(cairo, face);
  cairo_set_font_size(cairo, kCanvasFont);
  cairo_text_extents_t size{};
  cairo_text_extents(cairo, valid.c_str(), &size);
  constexpr std::array kBefore{0.0, 0.5, 1.0};  // part of the width before the anchor
  const double before = kBefore[static_cast<std::size_t>(anchor)] * size.x_advance;
  cairo_move_to(cairo, at.x - before, at.y);
  impl_->use(rgb);
  cairo_show_text(cairo, valid.c_str());
  cairo_new_path(cairo);
}

void CairoCanvas::clip(const Box* box) {
  cairo_reset_clip(impl_->cairo.get());
  if (box == nullptr) return;
  impl_->path(*box);
  cairo_clip(impl_->cairo.get());
}

RasterCanvas::RasterCanvas(double width, double height, double scale, Rgb paper)
    : CairoCanvas(std::make_unique<Impl>()) {
  const auto pixels = [scale](double x) {
    return std::max(1, static_cast<int>(std::lround(x * scale)));
  };
  impl_->begin(cairo_image_surface_create(CAIRO_FORMAT_RGB24, pixels(width), pixels(height)), scale,
               paper);
}

Raster RasterCanvas::take() {
  check(cairo_status(impl_->cairo.get()));
  cairo_surface_t* surface = impl_->surface.get();
  cairo_surface_flush(surface);
  Raster raster{
      cairo_image_surface_get_width(surface), cairo_image_surface_get_height(surface), {}};
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface));
  const unsigned char* bytes = cairo_image_surface_get_data(surface);
  const auto width = static_cast<std::size_t>(raster.width);
  const auto height = static_cast<std::size_t>(raster.height);
  raster.rgba.resize(4 * width * height);
  auto* to = raster.rgba.data();
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      std::uint32_t pixel = 0;  // 0x00RRGGBB as a number of this processor
      std::copy_n(bytes + y * stride + 4 * x, 4, reinterpret_cast<unsigned char*>(&pixel));
      for (const int shift : {16, 8, 0}) *to++ = static_cast<unsigned char>(pixel >> shift);
      *to++ = 255;
    }
  }
  return raster;
}

PdfCanvas::PdfCanvas(double width, double height, double scale, Rgb paper,
                     const std::string& made_by)
    : CairoCanvas(std::make_unique<Impl>()) {
  cairo_surface_t* surface =
      cairo_pdf_surface_create_for_stream(append, &impl_->document, width * scale, height * scale);
  cairo_pdf_surface_restrict_to_version(surface, CAIRO_PDF_VERSION_1_4);  // for every reader
  cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATOR, made_by.c_str());
  impl_->begin(surface, scale, paper);
}

std::string PdfCanvas::end() {
  check(cairo_status(impl_->cairo.get()));
  impl_->cairo.reset();
  cairo_surface_finish(impl_->surface.get());
  check(cairo_surface_status(impl_->surface.get()));
  return std::move(impl_->document);
}

}  // namespace limpid
