// Taps of a wall under any law on any arm: what came of them, and the stiffest wall that is felt as
// set and quiet.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/experiments/experiment.h"
#include "core/dynamics/arm_description.h"

namespace limpid {

inline constexpr double kHardest = 4;        // of a press, at most; half of what motors bear [N]
inline constexpr double kCommonWall = 2000;  // the wall of all laws' taps [N/m]
inline constexpr double kLeastWall = 50, kMostWall = 20000;  // walls tried [N/m]
inline constexpr double kQuiet = 0.02;   // speed above 20 Hz of a quiet tip [m/s]
inline constexpr double kFeltOff = 0.2;  // felt stiffness off the set one [-]

// A law is told by its ink, and without colours by the dash of its lines and the mark of its
// points.
struct BenchLaw {
  CouplingKind kind;
  const char* ink;
  const char* dash;
  int mark;

  Series line() const {
    Series line{info(kind).key, ink, Series::Style::line, {}};
    line.dash = dash;
    return line;
  }
  Series points() const {
    Series points{info(kind).key, ink, Series::Style::points, {}};
    points.mark = mark;
    return points;
  }
};
inline constexpr std::array kBenchLaws{
    BenchLaw{CouplingKind::standard, kStandardInk, "1", 6},
    BenchLaw{CouplingKind::proposed, kProposedInk, "(12,4)", 5},
    BenchLaw{CouplingKind::predictive, kPredictiveInk, "1", 15},
    BenchLaw{CouplingKind::tank, kTankInk, "1", 4},
    BenchLaw{CouplingKind::direct, kFamilyInk[3], "(6,6)", 2},
    BenchLaw{CouplingKind::eba, kFamilyInk[0], "(8,3,2,3)", 9},
    BenchLaw{CouplingKind::popc, kFamilyInk[2], "(6,2,2,2,2,2)", 13},
    BenchLaw{CouplingKind::sfa, kFamilyInk[1], "(4,4)", 11}};
const BenchLaw& bench_law(CouplingKind kind);

struct BenchHand {
  double stiffness, damping;  // [N/m, N s/m]

  void holds(Parameters& p) const {
    p.hand_stiffness = stiffness;
    p.hand_damping = damping;
  }
};
inline constexpr std::array kHands{BenchHand{300, 2}, BenchHand{3000, 2}, BenchHand{300, 0},
                                   BenchHand{3000, 0}};
inline constexpr std::size_t kDamped = 2;  // so many of them damp; they come first

// An arm by its file in assets/devices, as it is or altered.
struct BenchArm {
  const char* name;
  const char* file;
  double heavier = 1;               // all its links [-]
  std::optional<double> step = {};  // of the encoders, for the file's [rad]
  std::optional<double> late = {};  // beyond the tick, for the file's [s]

  // Errors: FileError.
  ArmDescription arm() const;
};

struct ArmUnderLaw {
  ArmDescription arm;
  Parameters parameters;
};

// A tap on a wall before the arm's rest pose, in the hand of its parameters.
struct ArmTap {
  ArmUnderLaw at;
  double wall;        // [N/m]
  double hold = 0.5;  // [s]
};

struct Came {
  double port = 0;     // most that the hand was given [J]
  double total = 0;    // highest E_c [J]
  double felt = 0;     // force on the hand over the depth of the tip, over the stiffness set [-]
  double chatter = 0;  // rms speed of the tip above 20 Hz [m/s]

  bool well() const { return chatter <= kQuiet && std::abs(felt - 1) <= kFeltOff; }
};

std::vector<Came> tap_arms(TrialRunner& lab, const std::vector<ArmTap>& taps);

// Judges a wall for each of many cases [N/m]: true if it is rendered well.
using WallsJudge = std::function<std::vector<bool>(const std::vector<double>& walls)>;
// For each of `count` cases the stiffest wall of kLeastWall to kMostWall that is rendered well, by
// bisection of its logarithm [N/m]; kLeastWall if none is. The search ends within 5 %.
std::vector<double> stiffest_of(std::size_t count, const WallsJudge& judge);

// For each the stiffest wall that is rendered well in both hands that damp [N/m]; kLeastWall if not
// even that one is. The search ends within 5 %.
std::vector<double> stiffest_quiet_walls(TrialRunner& lab, const std::vector<ArmUnderLaw>& all);

// Checks that a direct wall's stiffness by (b_d + b_h)/(T/2 + delay) is where the search finds the
// end of quiet.
std::array<Check, 2> by_direct_theory(const std::string& what, double ratio);

// A tap of kCommonWall under a law.
struct LawCame {
  CouplingKind kind;
  Came came;
};
// Panel of the energy given over the stiffness felt, a point a tap.
FigurePanel energy_panel(const std::string& title, std::span<const LawCame> all);

}  // namespace limpid
