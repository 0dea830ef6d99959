// Settings that suit an arm as the paper's suit its own.
//
// All of them hang on the device's damping b_d and its delay t_d: with b_vc = b_d/12, k_vc = 10/12
// b_d/(T + 3/2 t_d) and b_v = b_d condition (3) holds with an equals sign, as it does for the
// paper's, and with alpha = 35/12 b_d eta_min of (25) is the paper's 0.59. An
// arm whose file does not say how it is damped gets a damping that takes its motion off as fast as
// the built-in arm's does, or less where that would stop its lightest joint within a tick.
#pragma once

#include <array>
#include <string>

#include "core/dynamics/arm_description.h"
#include "core/tick/parameters.h"

namespace limpid {

inline constexpr std::array kFittedKeys{"coupling.k_vc", "coupling.b_vc", "coupling.b_v",
                                        "observer.alpha", "device.damping"};

// The paper's settings where they suit the arm: (3) holds with what its file says, and its damping
// is not far above what they need. Else with the keys above as they suit it, at two digits, for the
// tick and the damping that are chosen, if one is; with (3) as it is for a delay t_d [s] and a
// link.
Parameters fitted(const ArmDescription& arm, const Parameters& chosen = {}, double delay = 0,
                  const LinkSettings& link = {});

// What of its own forces an arm's motors should take off the hand: of one that was identified all
// that was found, and of its friction the usual share; else nothing.
CompensationSettings suggested_compensation(const ArmDescription& arm);

// For people: "k_vc 1700 N m/rad, ..." of the keys above; empty if they are the paper's.
std::string fit_text(const Parameters& fitted);

// Gives `p` what suits `now`, in place of what suited `before` or is the paper's; whatever was
// chosen otherwise stays. Null: an arm that the paper's suit.
void refit(Parameters& p, const ArmDescription* before, const ArmDescription* now);

}  // namespace limpid
