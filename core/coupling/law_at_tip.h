// Limits of a coupling law at the tip of an arm, without simulating: its stiffest wall, and what it
// lets be felt in free motion. Each law's own file tells both.
#pragma once

#include <complex>
#include <cstdint>
#include <string>

#include "core/coupling/felt.h"
#include "core/coupling/inertia_network.h"
#include "core/coupling/spring_damper.h"
#include "core/coupling/walls.h"

namespace limpid {

enum class CouplingKind : std::uint8_t;
struct LawSettings;

// Stiffest wall that a law renders well, or that can be felt through it, and what bounds it.
struct TipWall {
  double stiffness = 0;  // [N/m]
  std::string bound;     // in words
};

// Mass and damping felt at a frequency.
struct FeltAtTip {
  double mass = 0;     // [kg]
  double damping = 0;  // [N s/m]
};
// Reads them from an impedance Z [N s/m] at f [Hz].
FeltAtTip felt_mass(std::complex<double> Z, double f);

// Arm, hand and loop as they meet at the tip.
struct LawAtTip {
  TipAlong tip;               // along the direction in which the arm's own dampers hold it least
  TipMoved easiest{};         // over all directions
  double weight = 1;          // of gains per joint along the tip's direction, see weight_at_tip()
  double easiest_weight = 1;  // the same for the longest lever over all directions
  WallSetting loop;           // gains that do along the tip what those of the joints do; its delay
                              // is the device's
  LinkSettings link;          // between device and proxy
  Condition3 condition3;      // of spring, damper, delays and link
  double encoder_step = 0;    // [rad]
  double friction = 0;        // that still holds the tip, see friction_at_tip() [N]
  double hand_stiffness = 0;  // [N/m]
  double inertia_ratio = 0;   // M2 / M1 [-]
  FeltJoint felt;             // the tip in free motion, in kg, N s/m, N/m
  double w_f = 0;             // of the observer at the tip [rad/s]
  AddedMass added{};          // of the predictive law: eta as the possible delay leaves it

  // Limits that several laws share: what is felt of the arm alone, and through spring and damper; a
  // wall that is felt through the spring k_vc of the settings [N m/rad]; and a wall on the device
  // itself [N/m], unless an encoder's step bounds it first.
  FeltAtTip arm_alone() const { return {tip.led, tip.damping}; }
  FeltAtTip behind_spring(double f) const { return felt_mass(felt.standard(f), f); }
  TipWall through_spring(double k_vc) const;
  TipWall on_device(double stiffness, const char* bound) const;
};

// The limits of a law, as its file tells them; f [Hz].
TipWall wall_at_tip(CouplingKind kind, const LawSettings& p, const LawAtTip& at);
FeltAtTip felt_at_tip(CouplingKind kind, const LawSettings& p, const LawAtTip& at, double f);

}  // namespace limpid
