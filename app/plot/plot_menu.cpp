#include "app/plot/plot_menu.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace limpid {
namespace {

constexpr std::size_t kMostRowsToCopy = 300'000;  // beyond that, clipboards become slow

std::filesystem::path save_text(const std::filesystem::path& file, const std::string& text) {
  errno = 0;
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (!out) {
    throw std::runtime_error(fmt::format("{}: cannot be written: {}", file.string(),
                                         errno != 0 ? std::strerror(errno) : "unknown why"));
  }
  return file;
}

PlotNotice copy_csv(const PlotSpec& spec, const History& history, const PlotPicture& picture) {
  const std::size_t rows = plot_csv_rows(history, picture.start, picture.stop);
  if (rows > kMostRowsToCopy) {
    return {fmt::format("{} rows are too many for the clipboard; save as CSV instead", rows), true};
  }
  ImGui::SetClipboardText(plot_csv(spec, history, picture.start, picture.stop).c_str());
  return {fmt::format("Copied {} rows", rows)};
}

}  // namespace

PlotWish plot_menu_items(bool png_offered) {
  PlotWish wish = PlotWish::none;
  if (ImGui::MenuItem("Copy as CSV")) wish = PlotWish::copy_csv;
  if (ImGui::MenuItem("Save as CSV")) wish = PlotWish::save_csv;
  if (png_offered && ImGui::MenuItem("Save as PNG")) wish = PlotWish::save_png;
  if (ImGui::MenuItem("Save as SVG")) wish = PlotWish::save_svg;
  ImGui::Separator();
  if (ImGui::MenuItem("Fit", "double click")) wish = PlotWish::fit;
  return wish;
}

std::filesystem::path free_file(const std::filesystem::path& folder, const std::string& name,
                                const std::string& extension) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!std::filesystem::is_directory(folder, error)) {
    throw std::runtime_error(
        fmt::format("{}: the folder cannot be made: {}", folder.string(), error.message()));
  }
  for (int number = 1;; ++number) {
    const auto file = folder / fmt::format("{}-{:03}.{}", name, number, extension);
    if (!std::filesystem::exists(file, error)) return file;
  }
}

PlotNotice fulfil(PlotWish wish, const PlotSpec& spec, const History& history,
                  const PlotPicture& picture, const std::filesystem::path& folder) try {
  if (wish == PlotWish::copy_csv) return copy_csv(spec, history, picture);
  const bool csv = wish == PlotWish::save_csv;
  const auto file = free_file(folder, spec.file_name, csv ? "csv" : "svg");
  save_text(file, csv ? plot_csv(spec, history, picture.start, picture.stop)
                      : plot_svg(spec, history, picture));
  return {"Saved " + file.string()};
} catch (const std::exception& e) {
  return {e.what(), true};
}

}  // namespace limpid
