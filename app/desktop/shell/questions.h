// Questions that have to be answered before the window goes on.
#pragma once

#include <filesystem>
#include <string>

#include "app/desktop/base/notices.h"
#include "devices/files/urdf_file.h"

namespace limpid {

// Asks what to do with unsaved changes, while `open`; the answer is a command. Staying clears
// `open`. `has_file`: saving needs no name.
void draw_unsaved_question(bool& open, bool has_file, const Act& act);

// Asks whether a running recording may end with the window, while `open`; the answer is a command.
void draw_quit_question(bool& open, const Act& act);

// Asks whether the program xacro may expand a file, while `open`. Returns true once it may, which
// clears `open`.
bool draw_xacro_question(bool& open, const std::filesystem::path& file);

// Question for the end of an arm that branches.
class TipQuestion {
 public:
  // Draws the question while `open`. Returns the link once it is chosen, and clears `open`.
  std::string draw(bool& open, const TipsToChoose& choice);

 private:
  std::size_t chosen_ = 0;
  bool was_open_ = false;
};

}  // namespace limpid
