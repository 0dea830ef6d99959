// How ImGui is told what keys and mouse do, which its version 1.89 changed: into fields before, as
// events since. Keys have GLFW's names, and what is told is what the next frame sees.
#pragma once

#include <imgui.h>

namespace limpid {

// Once for every context, after ImGui's own part for GLFW where a window has one.
void begin_imgui_input();

void show_key(int key, bool down);
void show_modifiers(bool control, bool shift, bool alt);
void show_mouse(const ImVec2& at);
void show_mouse_button(int button, bool down);

// Whether arrows and the space bar go through what ImGui has open, as through a menu.
void lead_menus_by_keys(bool lead);
// Shows which item keys have chosen, in a frame before it is drawn; ImGui hides it now and then.
void show_chosen_item();
// So many menus and popups are open inside of each other.
int menus_open();
// After all menus of the bar were drawn, where `before` of them were open inside of each other at
// first: 1 or -1 where an arrow leaves the one that is open for its neighbour, else 0. ImGui would
// close it.
int step_to_menu_beside(int before);

// ImGui::IsKeyPressed().
bool key_pressed(int key, bool repeat = true);

}  // namespace limpid
