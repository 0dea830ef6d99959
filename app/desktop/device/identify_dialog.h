// Dialog that leads through the identification of a device: questions, progress, results.
#pragma once

#include <imgui.h>

#include <map>
#include <string>

#include "app/desktop/device/identify_controller.h"
#include "core/tick/compensation.h"

namespace limpid {

class IdentifyDialog {
 public:
  // Draws the dialog while `open`; closing it ends a motion. `down`: direction of gravity in the
  // settings, the first choice.
  void draw(bool& open, IdentifyController& controller, Down down, const ArmDescription& arm);

  // Returns the places of its buttons in the last frame, by label [px].
  static std::map<std::string, ImVec2> places();

 private:
  void draw_question(IdentifyController& controller, const ArmDescription& arm);

  IdentifyRequest request_;  // as it was the last time
  Down down_ = Down::as_file;
  bool with_load_ = false, was_open_ = false;
  float load_ = 50;  // [g]
};

}  // namespace limpid
