// Carries out what the export dialog asks for, beside the window, and remembers what was written
// last, so that it can be opened.
#pragma once

#include <cstddef>
#include <filesystem>

#include "app/desktop/live/live_session.h"
#include "app/desktop/panels/export_dialog.h"
#include "app/desktop/shell/dialogs.h"

namespace limpid {

class Exporter {
 public:
  Exporter(LiveSession& live, OpenDialog& dialog, Notices& notices)
      : live_(live), dialog_(dialog), notices_(notices) {}

  // Asks what, where and how, a plot of the row first.
  void begin(std::size_t plot) {
    plot_ = plot;
    dialog_.open("export");
  }
  std::size_t plot() const { return plot_; }
  // A picture of the window is the window's own work: its file is returned then, else nothing.
  std::filesystem::path carry_out(const ExportOrder& order, const Stage& stage);

  // What was written last, for a while; empty: nothing new.
  void wrote(const std::filesystem::path& file);
  const std::filesystem::path& written() const { return written_; }
  void forget() { written_.clear(); }
  void update();  // once a frame
  void open_written();
  void show_written();

 private:
  LiveSession& live_;
  OpenDialog& dialog_;
  Notices& notices_;
  std::size_t plot_ = 0;
  std::filesystem::path written_;
  double until_ = 0;  // ImGui's time [s]
};

}  // namespace limpid
