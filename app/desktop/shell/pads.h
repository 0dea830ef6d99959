// The gamepads that are plugged in, as GLFW knows them, and the one that leads the hand.
#pragma once

#include <string>
#include <vector>

#include "app/desktop/base/settings.h"
#include "app/desktop/live/live_session.h"
#include "app/desktop/live/pad_hand.h"
#include "render/camera.h"

namespace limpid {

// After input was collected; in the order of their slots. Joysticks whose buttons GLFW has no names
// for are none.
std::vector<Pad> plugged_pads();

class Pads {
 public:
  Pads(const Settings& settings, Notices& notices, LiveSession& live)
      : settings_(settings), notices_(notices), live_(live) {}

  // Those that are there now, `dt` [s] after the last call: the chosen one leads the hand as it is
  // seen through the camera, unless a `device` does, or the window does not listen. What else it
  // asks for.
  struct Heard {
    bool device, listens;
  };
  PadHand::Asked follow(std::vector<Pad> pads, const Heard& heard, const Camera& camera, double dt);
  const std::vector<Pad>& all() const { return pads_; }
  const std::string& leading() const { return leading_; }  // its name; or none

 private:
  const Settings& settings_;
  Notices& notices_;
  LiveSession& live_;
  std::vector<Pad> pads_;
  PadHand hand_;
  std::string leading_;
  bool known_ = false;  // asked for once
};

}  // namespace limpid
