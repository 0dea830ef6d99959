// What people read of a parameter: words first, the symbol after.
#pragma once

#include <imgui.h>

#include <string>

#include "core/tick/parameters.h"

namespace limpid {

// Tooltips that stand beside what they explain.

// Of the item between two corners [ImGui's coordinates]: beside the panel that it is in, or above
// or below it where that reaches across the window. Pairs with end_tooltip().
void begin_tooltip(ImVec2 from, ImVec2 to);
void end_tooltip();
// Of ImGui's last item, while the mouse is over it.
void tooltip(const char* text);

// Beside a slider: "Impedance scaling η". What has no words of its own is called by its label.
const char* caption(const ParameterInfo& info);

// The number with its unit, as a slider shows it; what is not a number is the arm's own.
std::string with_unit(const ParameterInfo& info, double value);

// Whether its usual value is the one that the paper gives, in section 4.
bool of_paper(const ParameterInfo& info);

// Where a plot marks that it has changed: "η 0.909".
std::string mark_text(const ParameterInfo& info, const Parameters& p);

// An energy with three digits, in J or mJ: "−64.2 mJ", "5.76 J".
std::string energy_text(double joules);

}  // namespace limpid
