#include "app/desktop/device/pads.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>

namespace limpid {

std::vector<Pad> plugged_pads() {
  std::vector<Pad> pads;
  for (int slot = GLFW_JOYSTICK_1; slot <= GLFW_JOYSTICK_LAST; ++slot) {
    GLFWgamepadstate state{};
    if (glfwGetGamepadState(slot, &state) != GLFW_TRUE) continue;
    const auto axis = [&](int which) { return static_cast<double>(state.axes[which]); };
    const auto trigger = [&](int which) { return (1 + axis(which)) / 2; };  // -1 when let go
    const auto button = [&](int which) { return state.buttons[which] == GLFW_PRESS; };
    pads.push_back({.id = glfwGetJoystickGUID(slot),
                    .name = glfwGetGamepadName(slot),
                    .now = {.left_x = axis(GLFW_GAMEPAD_AXIS_LEFT_X),
                            .left_y = axis(GLFW_GAMEPAD_AXIS_LEFT_Y),
                            .right_y = axis(GLFW_GAMEPAD_AXIS_RIGHT_Y),
                            .left_trigger = trigger(GLFW_GAMEPAD_AXIS_LEFT_TRIGGER),
                            .right_trigger = trigger(GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER),
                            .a = button(GLFW_GAMEPAD_BUTTON_A),
                            .b = button(GLFW_GAMEPAD_BUTTON_B),
                            .x = button(GLFW_GAMEPAD_BUTTON_X),
                            .y = button(GLFW_GAMEPAD_BUTTON_Y)}});
  }
  return pads;
}

// A gamepad that is plugged in while the window is open has a notice, once; those of the start are
// in the panel.
PadHand::Asked Pads::follow(std::vector<Pad> pads, const Heard& heard, const Camera& camera,
                            double dt) {
  const std::string& wanted = settings_.gamepad;
  for (const Pad& pad : pads) {
    const bool known = std::ranges::find(pads_, pad.id, &Pad::id) != pads_.end();
    if (known || !known_ || pad.id == wanted) continue;
    notices_.say(
        fmt::format("{} is plugged in. To move the hand with this gamepad, choose it under Device, "
                    "in the panel at the right (F3).",
                    pad.name));
  }
  pads_ = std::move(pads);
  known_ = true;
  const auto pad = std::ranges::find(pads_, wanted, &Pad::id);
  const bool there = pad != pads_.end();
  if (!there || heard.device) {
    if (!there && !wanted.empty() && !leading_.empty()) {
      notices_.say(
          fmt::format("{} is unplugged. The mouse moves the hand until the gamepad is back.",
                      leading_),
          true);
    }
    leading_.clear();
    hand_.lose(live_.controls());
    return {};
  }
  if (leading_ != pad->name) {
    leading_ = pad->name;
    notices_.say(fmt::format(
        "{} moves the hand. Left stick: moves the hand. Triggers: move it nearer and farther. A: "
        "takes hold or lets go. B: switches the force off. Y: next coupling. X: magnet.",
        leading_));
  }
  const PadReading now = heard.listens ? pad->now : PadReading{.b = pad->now.b};
  const Vec3 tip =
      live_.stage().rows().tip(live_.loop().layout().in(live_.row(), Column::device_position));
  if (!tip.allFinite()) return {};
  return hand_.lead(now, {camera.right(), camera.up(), camera.forward()}, live_.stage().arm(), tip,
                    dt, live_.controls());
}

}  // namespace limpid
