// While a program on the control socket leads the window: what the person had before. It comes back
// when the program is gone, and it is what is kept for the next start meanwhile.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/desktop/shell/tuning.h"
#include "app/desktop/shell/world.h"

namespace limpid {

class Desktop;

class Lead {
 public:
  explicit Lead(Desktop& desktop) : d_(desktop) {}

  // A program's are the settings from now on.
  bool on() const { return own_.has_value(); }
  // Before a program changes a setting; before it opens a scene or an arm. Once more changes
  // nothing.
  void begin();
  void begin_elsewhere();
  // After it has changed something: what differs from that later on, the person has changed.
  void note_program();
  // Once a turn: keeps that with what comes back.
  void follow_person();
  // The person's settings and scene are back, without force on a real device where anything
  // differs. False: not yet, as something is recorded or loaded. `study`: that it was one is said.
  bool end(bool study);
  // For the next start, without anything that a program has set.
  Settings settings_to_keep() const;

 private:
  struct Elsewhere {
    World::Place place;
    std::string scene, device, device_tip;  // of the settings
  };
  void go_back(const Elsewhere& before);

  Desktop& d_;
  std::optional<Tuning::Choices> own_;
  std::vector<std::string> recent_;
  Parameters seen_, seen_twin_;  // as the program has left them
  std::optional<Elsewhere> elsewhere_;
};

}  // namespace limpid
