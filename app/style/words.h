// Words for parameters, before their symbols, and tooltips beside what they explain.
#pragma once

#include <imgui.h>

#include <string>

#include "core/tick/parameters.h"

namespace limpid {

// Returns a text with Greek letters for the words eta and alpha, as the panel writes them. Keys
// such as coupling.eta stay.
std::string with_greek(std::string text);

// Begins a tooltip of the item between two corners [ImGui's coordinates]: beside its panel, or
// above or below the item if the panel reaches across the window. Pairs with end_tooltip().
void begin_tooltip(ImVec2 from, ImVec2 to);
void end_tooltip();
// Shows a tooltip of ImGui's last item, while the mouse is over it.
void tooltip(const char* text);

// Writes the number with its unit, as a slider shows it; a value that is not a number means the
// arm's own.
std::string with_unit(const FieldInfo& info, double value);

// Returns whether the usual value is the one that the paper gives, in section 4.
bool of_paper(const FieldInfo& info);

// Returns the text of a plot's mark where the parameter has changed: "η 0.909".
std::string mark_text(const ParameterInfo& info, const Parameters& p);

// Returns a text that is `room` wide at most in a font [px]: of a longer one the middle is left
// out.
std::string shortened(const std::string& text, float room, const ImFont* in);

// Writes an energy with three digits, in J or mJ: "−64.2 mJ", "5.76 J".
std::string energy_text(double joules);

}  // namespace limpid
