// Keys and mouse for ImGui, which takes them as events since version 1.89, as fields before. Keys
// have GLFW's names. The next frame sees what is told.
#pragma once

#include <imgui.h>

namespace limpid {

// Begins input, once for every context, after ImGui's own part for GLFW if a window has one.
void begin_imgui_input();

void show_key(int key, bool down);
// Writes a character into the text that has the keys. A comma in a number is its decimal point, as
// half of all keypads have it: ImGui would drop it, and 0,6 be 6.
void write_character(unsigned character);
// Says that the last item takes numbers. Comes after each of ImGui's own fields of numbers.
void note_number_item();
void show_modifiers(bool control, bool shift, bool alt);
void show_mouse(const ImVec2& at);
void show_mouse_button(int button, bool down);

// Lets arrows and the space bar go through what ImGui has open, as through a menu, or not.
void lead_menus_by_keys(bool lead);
// Lets them go through the present window, unless they do so already, or are in a list of it.
void lead_window_by_keys();
// Shows which item keys have chosen, if called in a frame before the item is drawn; ImGui hides it
// now and then.
void show_chosen_item();
// Counts the menus and popups that are open inside of each other.
int menus_open();
// Tells whether an arrow leaves the open menu for its neighbour: 1 or -1, else 0; ImGui would close
// it. Comes after all menus of the bar were drawn; `before` is menus_open() before them.
int step_to_menu_beside(int before);

// Does what ImGui::IsKeyPressed() does.
bool key_pressed(int key, bool repeat = true);

}  // namespace limpid
