// Asks for a file: in the desktop's own dialog where it has one that answers, else in ours.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/base/file_portal.h"
#include "app/desktop/widgets/path_dialog.h"

namespace limpid {

class FileQuestion {
 public:
  // Of the moment at which it is asked.
  struct Place {
    std::filesystem::path first;            // a folder with / at its end, or the new file
    std::vector<PathDialog::Place> places;  // beside our list
    bool own = false;                       // ours in any case
    std::string parent = {};                // the window, as portals name it
  };
  explicit FileQuestion(PathDialog::Options options) : dialog_(std::move(options)) {}

  // While `open`. Returns the file once it is chosen, and clears `open`. `place` is asked while it
  // is open.
  std::filesystem::path draw(bool& open, const std::function<Place()>& place);

 private:
  void draw_waiting(bool& open);

  PathDialog dialog_;
  bool asked_ = false;
  std::optional<FilePortal> portal_;  // while the desktop's own dialog is to answer
};

}  // namespace limpid
