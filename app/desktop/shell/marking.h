// Marks that people set: in the plots of the loop and in what it records, or in a recording that is
// played, whose file is written anew then.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/desktop/base/notices.h"
#include "app/desktop/base/settings.h"
#include "app/desktop/live/live_session.h"
#include "app/desktop/playback/playback.h"
#include "app/desktop/shell/dialogs.h"

namespace limpid {

class Marking {
 public:
  Marking(const Settings& settings, LiveSession& live, Playback& playback, OpenDialog& dialog,
          Notices& notices)
      : settings_(settings), live_(live), playback_(playback), dialog_(dialog), notices_(notices) {}

  // At the mouse in a plot, else now: what it says is asked in a dialog.
  void begin();
  // Of the recording that is played: one of its marks, by its place among them.
  void edit(std::size_t which);
  // To the mark before or after the moment that is shown.
  void go(int direction);
  // Of the recording that is played, where its marks were changed last, and not a setting.
  bool can_undo() const { return last() && !done_.empty(); }
  bool can_redo() const { return last() && !undone_.empty(); }
  void undo() { step(done_, undone_); }
  void redo() { step(undone_, done_); }

  // The dialog: when it is, what it says at first, whether it is there already.
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
  LiveSession& live_;
  Playback& playback_;
  OpenDialog& dialog_;
  Notices& notices_;
  std::optional<std::size_t> which_;  // that is edited
  LiveSession::Moment moment_;        // of a new one, in the loop
  std::uint64_t tick_ = 0;            // or in a recording
  std::string text_;
  std::filesystem::path file_;  // whose steps these are
  Parameters then_;             // the settings at the last of them
  std::vector<Marks> done_, undone_;
  Marks known_;  // all that the file had, as far as this window knows
};

}  // namespace limpid
