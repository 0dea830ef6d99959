#include "app/desktop/shell/pads.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

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
                            .y = button(GLFW_GAMEPAD_BUTTON_Y)}});
  }
  return pads;
}

}  // namespace limpid
