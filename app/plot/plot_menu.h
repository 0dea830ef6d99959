// A plot's menu: what it can give away, as numbers on the clipboard, tables and pictures in files.
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
  std::filesystem::path file = {};  // the file written, if any
};

struct PlotSaving {
  std::filesystem::path folder;  // created when missing

  // Saves the plot between two corners [px, ImGui coordinates] as a PNG when asked; whoever does
  // that tells the result. Without it PNG is not offered.
  std::function<void(const ScreenRect& box, const std::filesystem::path& file)> save_png;

  // Does work on a file elsewhere, where it may take its time, and tells the result. Without it the
  // work is done, and its result told, at once.
  std::function<void(std::function<PlotNotice()> work)> beside;

  // The owner of the plots lets people choose their channels, and add and remove plots.
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

// Draws the items of the context menu inside an open pop-up; returns the choice.
PlotWish plot_menu_items(bool png_offered, bool arranged);

// Returns the first free "folder/name-001.extension". Creates the folder. Throws std::runtime_error
// naming it when that is not possible.
std::filesystem::path free_file(const std::filesystem::path& folder, const std::string& name,
                                const std::string& extension);

// Does copy_csv, save_csv and save_svg; returns what to tell about it, if that is known already.
// Never throws for a file that cannot be written: that is told, too.
std::optional<PlotNotice> fulfil(PlotWish wish, const PlotSpec& spec, const History& history,
                                 const PlotPicture& picture, const PlotSaving& saving);

}  // namespace limpid
