// Demonstration of broken passivity: settings under which the loop gives energy without end.
#pragma once

#include "app/desktop/base/settings.h"
#include "core/dynamics/arm_description.h"

namespace limpid {

// Returns `p` with the proposed law in a stiff, undamped grip and eta well below Routh's limit for
// it.
Parameters without_passivity(const Parameters& p, const ArmDescription& arm);

// Gives these settings to the run that is edited; does nothing if passivity is broken already.
void break_passivity(Settings& settings, const ArmDescription& arm);
inline constexpr const char* kBreakEnded =
    "The demonstration of broken passivity has ended. All settings have their earlier values "
    "again.";
inline bool passivity_broken(const Settings& settings) { return settings.before_break.has_value(); }
// Puts back all settings of all lanes from before; does nothing if passivity is not broken.
void end_passivity_break(Settings& settings);
// Ends the break if another law was chosen for the broken run, and keeps that law. Returns whether
// it ended.
bool end_break_by_law(Settings& settings);

}  // namespace limpid
