// What has to be answered before the window goes on with it.
#pragma once

#include <filesystem>
#include <string>

#include "app/desktop/base/notices.h"
#include "devices/files/urdf_file.h"

namespace limpid {

// What to do with changes that are not saved, while `open`; the answer is a command. Staying clears
// `open`. `has_file`: saving needs no name.
void draw_unsaved_question(bool& open, bool has_file, const Act& act);

// Whether a recording that runs may end with the window, while `open`; the answer is a command.
void draw_quit_question(bool& open, const Act& act);

// Whether a file may be expanded by the program xacro, while `open`. True once it may, which clears
// `open`.
bool draw_xacro_question(bool& open, const std::filesystem::path& file);

// Which end of an arm is meant, where it branches.
class TipQuestion {
 public:
  // While `open`. The link, once it is chosen; that clears `open`.
  std::string draw(bool& open, const TipsToChoose& choice);

 private:
  std::size_t chosen_ = 0;
  bool was_open_ = false;
};

}  // namespace limpid
