#include "app/desktop/shell/exporter.h"

#include <fmt/format.h>
#include <imgui.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "app/base/open_elsewhere.h"
#include "app/plot/canvas_tape.h"
#include "app/plot/plot_export.h"
#include "app/run/provenance.h"
#include "devices/files/atomic_file.h"
#include "render/gl/offscreen.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr double kOffered = 30;  // time in which the last file can be opened from the window [s]

PlotNotice written_as(const fs::path& file, std::span<const unsigned char> bytes) {
  write_atomically(file, bytes);
  return {"", false, file};  // a banner shows it
}

std::span<const unsigned char> bytes_of(const std::string& text) {
  return {reinterpret_cast<const unsigned char*>(text.data()), text.size()};
}

// Adds a notice on failure to the work.
template <class Work>
std::function<PlotNotice()> said(Work work) {
  return [work = std::move(work)]() -> PlotNotice {
    try {
      return work();
    } catch (const std::exception& e) {
      return {e.what(), true};
    }
  };
}

// Returns the plots of an order, as they are shown, in the order's size and colours.
std::vector<FigurePart> parts_of(const ExportOrder& order, const Stage& stage) {
  std::vector<FigurePart> parts;
  for (std::size_t i = 0; i < stage.plots.size(); ++i) {
    if (order.what != ExportOrder::What::figure && i != order.plot) continue;
    PlotPicture picture = stage.plots[i].picture(stage.group);
    if (const auto range = stage.group.range(); range && order.stretch) {
      picture.start = range->start;
      picture.stop = range->stop;
    }
    picture.width = static_cast<int>(std::lround(order.width * kLayoutPerMillimetre));
    picture.height = static_cast<int>(std::lround(order.height * kLayoutPerMillimetre));
    picture.theme = order.theme;
    picture.millimetres = order.width;
    parts.push_back({stage.plots[i].spec(), picture});
  }
  return parts;
}

}  // namespace

fs::path Exporter::carry_out(const ExportOrder& order, const Stage& stage) {
  if (order.what == ExportOrder::What::window) return order.file;
  const std::vector<FigurePart> parts = parts_of(order, stage);
  if (parts.empty()) return {};
  const PlotPicture& first = parts.front().picture;
  if (order.what == ExportOrder::What::table) {
    const auto table = std::make_shared<const PlotTable>(
        plot_table(parts.front().spec, stage.history, first.start, first.stop));
    live_.save_beside(said([table, file = order.file] {
      PlotNotice notice = written_as(file, bytes_of(csv_text(*table)));
      notice.text += word_on_times(*table);
      return notice;
    }));
    return {};
  }
  if (order.format == ExportOrder::Format::svg) {
    live_.save_beside(said([svg = figure_svg(parts, stage.history), file = order.file] {
      return written_as(file, bytes_of(svg));
    }));
    return {};
  }
  const auto tape = std::make_shared<CanvasTape>();
  draw_figure(parts, stage.history, *tape);
  PlotPicture picture = first;
  picture.height *= static_cast<int>(parts.size());
  if (order.format == ExportOrder::Format::pdf) {
    live_.save_beside(said([tape, picture, file = order.file] {
      // Provenance names no settings, as they may have changed within the plot's time.
      PdfCanvas canvas(picture.width, picture.height, 72 / 25.4 / kLayoutPerMillimetre,
                       paper_of(picture), provenance("", std::nullopt));
      tape->play(canvas);
      return written_as(file, bytes_of(canvas.end()));
    }));
    return {};
  }
  const double scale = order.dpi / 25.4 / kLayoutPerMillimetre;
  live_.save_beside(said([tape, picture, scale, dpi = order.dpi, file = order.file] {
    RasterCanvas canvas(picture.width, picture.height, scale, paper_of(picture));
    tape->play(canvas);
    const Raster raster = canvas.take();
    const auto per_metre = static_cast<unsigned>(std::lround(dpi / 0.0254));
    return written_as(file, png_of(raster.width, raster.height, raster.rgba, per_metre,
                                   provenance("", std::nullopt)));
  }));
  return {};
}

void Exporter::wrote(const fs::path& file) {
  written_ = file;
  until_ = ImGui::GetTime() + kOffered;
}

void Exporter::update() {
  if (const fs::path file = live_.take_written(); !file.empty()) wrote(file);
  if (!written_.empty() && ImGui::GetTime() > until_) forget();
}

void Exporter::open_written() {
  live_.save_beside([file = std::exchange(written_, {})]() -> PlotNotice {
    if (open_elsewhere(file)) return {fmt::format("Opening {}", file.filename().string())};
    return {"The file cannot be opened, because xdg-open (of the package xdg-utils) is missing.",
            true};
  });
}

void Exporter::show_written() {
  live_.save_beside([file = std::exchange(written_, {})]() -> PlotNotice {
    if (show_in_folder(file))
      return {fmt::format("The file is in {}", file.parent_path().string())};
    return {fmt::format("The file is in {}. No file manager was found on this computer.",
                        file.parent_path().string()),
            true};
  });
}

}  // namespace limpid
