// Settings that suit an arm as the paper's suit its own.
//
// All of them depend on the device's damping b_d and its delay t_d. With b_vc = b_d/12, k_vc =
// 10/12 b_d/(T + 3/2 t_d) and b_v = b_d condition (3) holds with an equals sign, as for the
// paper's. Where the joints' damping differs, b_d is the least, and the gains grow with it. With
// alpha = 35/12 b_d eta_min of (25) is the paper's 0.59. An arm whose file says no damping gets one
// that slows it as fast as the built-in arm's does. It gets less where that would stop its lightest
// joint within a tick.
#pragma once

#include <array>
#include <string>

#include "core/dynamics/arm_description.h"
#include "core/tick/parameters.h"

namespace limpid {

inline constexpr std::array kFittedKeys{"coupling.k_vc",      "coupling.b_vc",  "coupling.b_v",
                                        "coupling.per_joint", "observer.alpha", "device.damping"};

// Returns the paper's settings if they suit the arm: (3) holds with the values of its file, whose
// damping is not far above what they need. Otherwise fits the keys above, at two digits, to the
// chosen tick and to the chosen damping, if one is; (3) reckons with a delay t_d [s] and a link.
// Gains that are chosen otherwise are those of all joints, so the fit does not weigh them. The
// delay of an arm that was identified counts in any case.
Parameters fitted(const ArmDescription& arm, const Parameters& chosen = {}, double delay = 0,
                  const LinkSettings& link = {});

// Returns `p` with what the arm's file says of the device's readings: step of the encoders, and
// delay in whole ticks, identified or else assumed, which the law knows.
Parameters with_readings_of(const ArmDescription& arm, Parameters p);
// Returns fitted() for that delay, with these readings.
Parameters fitted_with_readings(const ArmDescription& arm, const Parameters& chosen = {});
// Says how settings differ from that: "its file says encoder steps of 0.419 mrad and a delay of 1
// ms; the settings say exact encoders and no delay"; empty if they do not, or if the file says
// nothing. For arms that slide the steps are in mm.
std::string readings_text(const ArmDescription& arm, const Parameters& p);

// Returns which of its own forces an arm's motors should take off the hand. For an arm that was
// identified: all that was found, and the usual share of its friction; else none.
CompensationSettings suggested_compensation(const ArmDescription& arm);

// Lists the keys above for people: "k_vc 1700 N m/rad, ..."; empty if they are the paper's.
std::string fit_text(const Parameters& fitted);

// Replaces values in `p` that suited `before` or are the paper's by those that suit `now`; values
// chosen otherwise stay. Null: an arm that the paper's suit.
void refit(Parameters& p, const ArmDescription* before, const ArmDescription* now);

}  // namespace limpid
