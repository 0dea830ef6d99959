// Marks that users set: in the plots of the loop and its recording, or in a recording that is
// played, whose file is then written anew.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/desktop/base/notices.h"
#include "app/desktop/base/settings.h"
#include "app/desktop/live/live_stage.h"
#include "app/desktop/playback/playback.h"
#include "app/desktop/shell/dialogs.h"

namespace limpid {

class Marking {
 public:
  Marking(const Settings& settings, LiveStage& live, Playback& playback, OpenDialog& dialog,
          Notices& notices)
      : settings_(settings), live_(live), playback_(playback), dialog_(dialog), notices_(notices) {}

  // Opens the dialog for a mark at the mouse in a plot, else now.
  void begin();
  // Opens the dialog for one of the played recording's marks, by its place among them.
  void edit(std::size_t which);
  // Seeks the mark before or after the moment shown.
  void go(int direction);
  // Returns whether marks of the played recording were changed last, and not a setting.
  bool can_undo() const { return last() && !done_.empty(); }
  bool can_redo() const { return last() && !undone_.empty(); }
  void undo() { step(done_, undone_); }
  void redo() { step(undone_, done_); }

  // Contents of the dialog: the mark's time, its text, and whether it exists already.
  std::string when() const;
  const std::string& text() const { return text_; }
  bool there() const { return which_.has_value(); }
  void accept(const std::string& text);
  void remove();

 private:
  using Marks = std::vector<Mark>;

  bool last() const;
  void change(Marks marks);
  void save(Marks marks);
  void step(std::vector<Marks>& from, std::vector<Marks>& to);
  std::size_t count() const;

  const Settings& settings_;
  LiveStage& live_;
  Playback& playback_;
  OpenDialog& dialog_;
  Notices& notices_;
  std::optional<std::size_t> which_;  // the mark that is edited
  LiveStage::Moment moment_;          // of a new mark, in the loop
  std::uint64_t tick_ = 0;            // of a mark in a recording
  std::string text_;
  std::filesystem::path file_;  // of the steps in done_ and undone_
  Parameters then_;             // settings at the last step
  std::vector<Marks> done_, undone_;
  Marks known_;  // all marks that the file has had, as far as this window knows
};

}  // namespace limpid
