// Exporter: carries out orders of the export dialog beside the window, and remembers the last file,
// so that it can be opened.
#pragma once

#include <cstddef>
#include <filesystem>

#include "app/desktop/live/live_stage.h"
#include "app/desktop/plots/export_dialog.h"
#include "app/desktop/shell/dialogs.h"

namespace limpid {

class Exporter {
 public:
  Exporter(LiveStage& live, OpenDialog& dialog) : live_(live), dialog_(dialog) {}

  // Opens the dialog, with this plot offered first.
  void begin(std::size_t plot) {
    plot_ = plot;
    dialog_.open("export");
  }
  std::size_t plot() const { return plot_; }
  // Carries out an order. Returns the file if it is a picture of the window, which the window has
  // to save; else nothing.
  std::filesystem::path carry_out(const ExportOrder& order, const Stage& stage);

  // Remembers the last file written, for a while. written() returns it; empty: none.
  void wrote(const std::filesystem::path& file);
  const std::filesystem::path& written() const { return written_; }
  void forget() { written_.clear(); }
  void update();  // once a frame
  void open_written();
  void show_written();

 private:
  LiveStage& live_;
  OpenDialog& dialog_;
  std::size_t plot_ = 0;
  std::filesystem::path written_;
  double until_ = 0;  // ImGui's time [s]
};

}  // namespace limpid
