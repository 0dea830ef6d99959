// Gamepads that are plugged in, as GLFW knows them, and the one that moves the hand.
#pragma once

#include <string>
#include <vector>

#include "app/desktop/base/settings.h"
#include "app/desktop/device/pad_hand.h"
#include "app/desktop/live/live_stage.h"
#include "render/camera.h"

namespace limpid {

// Returns the gamepads in the order of their slots; to be called after input was collected.
// Joysticks without GLFW's names for their buttons do not count.
std::vector<Pad> plugged_pads();

class Pads {
 public:
  Pads(const Settings& settings, Notices& notices, LiveStage& live)
      : settings_(settings), notices_(notices), live_(live) {}

  // Takes the present gamepads, `dt` [s] after the last call. The chosen one moves the hand as seen
  // through the camera, unless a `device` does, or the window does not listen. Returns its other
  // requests.
  struct Heard {
    bool device, listens;
  };
  PadHand::Asked follow(std::vector<Pad> pads, const Heard& heard, const Camera& camera, double dt);
  const std::vector<Pad>& all() const { return pads_; }
  const std::string& leading() const { return leading_; }  // name of the gamepad; or none

 private:
  const Settings& settings_;
  Notices& notices_;
  LiveStage& live_;
  std::vector<Pad> pads_;
  PadHand hand_;
  std::string leading_;
  bool known_ = false;  // pads_ has been read once
};

}  // namespace limpid
