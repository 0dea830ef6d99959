#include "app/plot/plot_menu.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
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
                                         errno != 0 ? std::strerror(errno) : "unknown reason"));
  }
  return file;
}

PlotNotice copy_csv(const PlotSpec& spec, const History& history, const PlotPicture& picture) {
  const PlotTable table = plot_table(spec, history, picture.start, picture.stop);
  const std::size_t rows = table.times.size();
  if (rows > kMostRowsToCopy) {
    return {fmt::format("{} rows are too many for the clipboard; save as CSV instead", rows), true};
  }
  ImGui::SetClipboardText(csv_text(table).c_str());
  return {fmt::format("Copied {} rows{}", rows, word_on_times(table))};
}

PlotNotice save_as(const std::filesystem::path& folder, const std::string& name,
                   const char* extension, const std::function<std::string()>& text,
                   const std::string& word = {}) {
  try {
    const auto file = save_text(free_file(folder, name, extension), text());
    // The name comes first: text too long for the plot is cut off at its end.
    return {fmt::format("Saved {}{} in {}", file.filename().string(), word, folder.string()), false,
            file};
  } catch (const std::exception& e) {
    return {e.what(), true};
  }
}

}  // namespace

PlotWish plot_menu_items(bool png_offered, bool arranged) {
  PlotWish wish = PlotWish::none;
  if (arranged) {
    if (ImGui::MenuItem("Channels and name...")) wish = PlotWish::choose;
    if (ImGui::MenuItem("Add a plot...", "N")) wish = PlotWish::add;
    if (ImGui::MenuItem("Remove this plot")) wish = PlotWish::remove;
    ImGui::Separator();
  }
  if (arranged && ImGui::MenuItem("Export...", "Ctrl+E")) wish = PlotWish::export_as;
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
    auto file = folder / fmt::format("{}-{:03}.{}", name, number, extension);
    if (!std::filesystem::exists(file, error)) return file;
  }
}

std::optional<PlotNotice> fulfil(PlotWish wish, const PlotSpec& spec, const History& history,
                                 const PlotPicture& picture, const PlotSaving& saving) {
  if (wish == PlotWish::copy_csv) return copy_csv(spec, history, picture);
  if (wish == PlotWish::save_svg) {
    return save_as(saving.folder, spec.file_name, "svg",
                   [&] { return plot_svg(spec, history, picture); });
  }
  // The work takes the rows along, as the history goes on meanwhile.
  const auto save = [folder = saving.folder, name = spec.file_name,
                     table = std::make_shared<const PlotTable>(
                         plot_table(spec, history, picture.start, picture.stop))] {
    return save_as(
        folder, name, "csv", [&] { return csv_text(*table); }, word_on_times(*table));
  };
  if (!saving.beside) return save();
  saving.beside(save);
  return std::nullopt;
}

}  // namespace limpid
