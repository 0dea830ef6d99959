// Question for a file: in the desktop's own dialog if it has one that answers, else in ours.
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
  // Places at the moment of the question.
  struct Place {
    std::filesystem::path first;            // a folder with / at its end, or the new file
    std::vector<PathDialog::Place> places;  // beside the list of our dialog
    bool own = false;                       // ours in any case
    std::string parent = {};                // id of the window, as portals name it
  };
  explicit FileQuestion(PathDialog::Options options) : dialog_(std::move(options)) {}

  // Draws the question while `open`. Returns the file once it is chosen, and clears `open`. Calls
  // `place` while it is open.
  std::filesystem::path draw(bool& open, const std::function<Place()>& place);

 private:
  void draw_waiting(bool& open);

  PathDialog dialog_;
  bool asked_ = false;
  std::optional<FilePortal> portal_;  // while the desktop's dialog is open
};

}  // namespace limpid
