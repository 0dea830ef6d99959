// Shows what passivity is for: settings under which the loop gives energy without end, for a while.
#pragma once

#include "app/desktop/base/settings.h"
#include "core/dynamics/arm_description.h"

namespace limpid {

// The proposed law in a stiff, undamped grip, with eta well below Routh's limit for it. All else
// stays.
Parameters without_passivity(const Parameters& p, const ArmDescription& arm);

// From now on the run that is edited has these. Once more changes nothing.
void break_passivity(Settings& settings, const ArmDescription& arm);
inline constexpr const char* kBreakEnded =
    "Passivity is whole again: all settings are what they were before it was broken.";
inline bool passivity_broken(const Settings& settings) { return settings.before_break.has_value(); }
// All settings of both runs are what they were before; nothing where it is not broken.
void end_passivity_break(Settings& settings);
// Somebody has chosen another law for the broken run: it ends, and that law stays. Whether it did.
bool end_break_by_law(Settings& settings);

}  // namespace limpid
