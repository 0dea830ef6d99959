// Leads through the identification of a device: what is asked before, what goes on, what was found.
#pragma once

#include <imgui.h>

#include <map>
#include <string>

#include "app/desktop/live/identify_controller.h"
#include "core/tick/compensation.h"

namespace limpid {

class IdentifyDialog {
 public:
  // While `open`; a motion ends when it is closed. `down`: of the settings, the start of the
  // choice.
  void draw(bool& open, IdentifyController& controller, Down down, const ArmDescription& arm);

  // What of it can be clicked, by its label, and where it was drawn in the last frame [px].
  static std::map<std::string, ImVec2> places();

 private:
  void draw_question(IdentifyController& controller, const ArmDescription& arm);

  IdentifyRequest request_;  // as it was the last time
  Down down_ = Down::as_file;
  bool with_load_ = false, was_open_ = false;
  float load_ = 50;  // [g]
};

}  // namespace limpid
