// Known faults in how bodies move. The experiment measures what they spoil and does not judge it.
#pragma once

#include "app/experiments/body_bench.h"

namespace limpid {

inline constexpr BodyFault kRollsThrough{
    true,
    "Known fault: the contact points of a cylinder or a capsule turn along with it, each tick's "
    "are "
    "new, and depth that nobody pressed in pushes nothing: it is braked, sinks, and goes through "
    "the ground."};
inline constexpr BodyFault kBouncesTooHigh{
    true,
    "Known fault: the damper of a contact is at most 0.7 of critical, and is chosen as if the "
    "contact could pull; and the first tick of a contact is stepped by the midpoint rule, which "
    "turns the speed of a light body around before the damper acts."};
inline constexpr BodyFault kFastSpinIsOff{
    true,
    "Known fault: the midpoint rule of a free spin takes the spin in the middle of the tick from "
    "its start, not from the tick itself, so angular momentum slowly changes its size."};
inline constexpr BodyFault kSleepsInMotion{
    true,
    "Known fault: what is slower than 1 mm/s and 0.02 rad/s for half a second falls asleep, also "
    "where weight, springs or dampers drive it."};
inline constexpr BodyFault kLinksTakeEnergy{
    true,
    "Known fault: a body that a joint's links hold is stepped with more weight on the end of the "
    "tick than on its start, as if it were in contact, and the links' dampers work against every "
    "stretch: both take energy."};
inline constexpr BodyFault kJointsDiverge{
    true,
    "Known fault: where a joint between light and heavy bodies meets its stop, the sweeps do not "
    "settle, and their last forces are used as they are."};
inline constexpr BodyFault kStopsDiverge{
    true,
    "Known fault: a joint that turns by a radian a tick against its stop gains energy without "
    "end."};
inline constexpr BodyFault kLightBodiesShake{
    true, "Known fault: a box of some milligrams shakes on its four points and never rests."};

// The sentence while the fault stands, else none.
inline std::string spoiled_by(const BodyFault& fault) { return fault.stands ? fault.sentence : ""; }

}  // namespace limpid
