// Lead of a program on the control socket: keeps the person's settings and scene meanwhile. They
// come back when the program is gone, and are kept for the next start.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/desktop/coupling/tuning.h"
#include "app/desktop/shell/world.h"

namespace limpid {

class Desktop;

class Lead {
 public:
  explicit Lead(Desktop& desktop) : d_(desktop) {}

  // Returns whether the settings are a program's now.
  bool on() const { return own_.has_value(); }
  // Keeps the person's settings. To be called before a program changes a setting;
  // begin_elsewhere(): before it opens a scene or an arm. Further calls change nothing.
  void begin();
  void begin_elsewhere();
  // Notes the program's settings. To be called after its changes: later differences are the
  // person's.
  void note_program();
  // Adds the person's changes to the settings that come back; to be called once a turn.
  void follow_person();
  // Brings back the person's settings and scene, without force on a real device if anything
  // differs. Returns false if it has to wait for recording or loading. `study`: the notice speaks
  // of a study.
  bool end(bool study);
  // Returns the settings for the next start, without a program's changes.
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
  LaneParameters seen_;  // as the program left them
  std::optional<Elsewhere> elsewhere_;
};

}  // namespace limpid
