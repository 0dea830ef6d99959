// What can be taken away from a plot: numbers on the clipboard, tables and pictures in files.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "app/plot/plot_export.h"
#include "app/plot/plot_frame.h"

namespace limpid {

struct PlotNotice {
  std::string text;
  bool bad = false;
  std::filesystem::path file = {};  // that was written, if one was
};

struct PlotSaving {
  std::filesystem::path folder;  // created when missing

  // Asked to save the plot that is drawn between two corners [px, ImGui coordinates] as a PNG; who
  // does that says what became of it. Without it PNG is not offered.
  std::function<void(const ScreenRect& box, const std::filesystem::path& file)> save_png;

  // Does work on a file that may take its time somewhere else, and says what became of it. Without
  // it that is done, and said, at once.
  std::function<void(std::function<PlotNotice()> work)> beside;

  // Whoever draws the plots lets their channels be chosen, and plots be added and removed.
  bool arranged = false;
};

enum class PlotWish {
  none,
  copy_csv,
  save_csv,
  save_svg,
  save_png,
  fit,
  choose,
  add,
  remove,
  export_as
};

// The items of the context menu inside an open pop-up; says what was chosen.
PlotWish plot_menu_items(bool png_offered, bool arranged);

// First free "folder/name-001.extension". Creates the folder. Throws std::runtime_error naming it
// when that is not possible.
std::filesystem::path free_file(const std::filesystem::path& folder, const std::string& name,
                                const std::string& extension);

// Does copy_csv, save_csv and save_svg; what there is to tell the person about it, if it is known
// already. Never throws for a file that cannot be written: that is told, too.
std::optional<PlotNotice> fulfil(PlotWish wish, const PlotSpec& spec, const History& history,
                                 const PlotPicture& picture, const PlotSaving& saving);

}  // namespace limpid
