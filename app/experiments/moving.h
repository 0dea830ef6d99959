// Runs with moving bodies: scenes, verdicts and the hand's part.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/experiments/experiment.h"
#include "app/experiments/signals.h"

namespace limpid {

// A box that moves, as a scene's text has it.
struct BoxText {
  std::string name = "block";
  Vec3 size = Vec3::Constant(0.03);  // [m]
  double mass = 0.05;                // [kg]
  Vec3 at = Vec3::Zero();            // its middle [m]
  double stiffness = 2000;           // for the tip [N/m]
  double friction = 0;               // [-]
  std::string more = {};             // further lines
};
std::string scene_of(const std::vector<BoxText>& boxes, const std::string& before);

// Verdict on a run; if it diverged, all energies are infinite.
struct MovingVerdict {
  double energy = 0;  // highest E_c [J]
  double beyond = 0;  // most that the human was given beyond what bodies gave [J]
  double gain = 0;  // most that bodies had beyond their initial energy and what they were given [J]
  double reserve = 0;   // the ledger's lowest value less its first [J]
  double governor = 1;  // the least share of the contact's force that the ledger let through [-]
  double sweeps = 0;    // most iterations over contacts between bodies in a tick
  double unsolved = 0;  // ticks for which the proxy stood still
};
MovingVerdict judge_moving(const TrialResult& result);

// The energy `beyond` up to row k, for a curve [J].
double beyond_at(const Session& session, std::size_t k);

// The device's tip at each tick, and the hand's mean force there over the tick that follows.
struct TipRecord {
  double tick = 0;          // [s]
  std::vector<Vec3> tip;    // one more than `force` [m]
  std::vector<Vec3> force;  // [N]
};
// Precondition: an arm of three joints, whose tip every force moves.
TipRecord tip_record(const ArmDescription& arm, const Session& session);

// Mass that the hand feels at frequency f [Hz], from tick `from` on, over whole periods: its force
// in phase with the tip's acceleration, along the tip's own motion [kg].
double felt_mass(const TipRecord& record, std::size_t from, double f);

// Whether a motion dies away: the last fifth of `speeds` is slower than the second.
bool dies_away(const std::vector<double>& speeds);

}  // namespace limpid
