// Plan of a library's loop: arm, scene and settings of its options, read and checked.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/library/limpid/limpid.h"
#include "app/run/simulate.h"

namespace limpid {

// A plan without a hand. `notes`: for people, what was mended, guessed or fitted.
struct LibraryPlan {
  RunPlan plan;
  std::vector<std::string> notes;
};

// Whose arm a loop moves: its own simulation, its caller's simulation, or real motors.
enum class LoopArm { own, callers, real };

// Reads the options. Damping that the arm's file does not say is made up for a simulated arm alone:
// of a device the loop counts no more than is known. Errors: FileError, FieldError.
LibraryPlan read_plan(const LoopOptions& options, LoopArm of);

// Returns the path of rows of time [s], x, y, z [m]. Errors: FileError.
HandPath hand_of_rows(std::span<const double> rows);

// Returns limits of the loop's safety layer. Errors: FieldError for one that is not allowed.
SafetyLimits limits_of(const LoopLimits& wanted);

// Returns the setting of that key. Errors: FieldError.
const ParameterInfo& setting_named(std::string_view key);

// Returns "did you mean X?" if one of all has nearly that name, else where all are: `list`.
std::string meant_or(std::string_view name, const std::vector<std::string>& all, const char* list);

// Sets one setting of a loop that is made. Errors: FieldError.
void set_live(Parameters& p, const std::string& key_value, LoopArm of);
void set_live(Parameters& p, std::string_view key, double value, LoopArm of);

}  // namespace limpid
