// Taps on a table top: hand, trial and result; and the stiffest wall that a coupling renders well.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/experiments/experiment.h"
#include "app/experiments/signals.h"
#include "app/run/wall_trial.h"
#include "core/coupling/walls.h"

namespace limpid {

struct TapSetting {
  CouplingKind kind = CouplingKind::predictive;
  double eta = 1;
  double tick = 0.001;         // [s]
  double encoder_step = 0;     // [rad]; 0: the arm's
  double hand_mass = 0;        // at the tip [kg]
  bool expects_a_mass = true;  // whether the law has a second predictor, for a hand with mass
  double press = 4;            // force of the hand while it holds, if the wall bears it [N]
  double torque_limit = 100;   // of every motor, out of reach [N m]
  bool own_motors = false;     // the arm's own limits instead
  double delay = 0;            // of the device [ticks]; 0: the arm's
  bool knows_delay = true;     // whether the law knows the delay
  int link = 0;                // delay between device and proxy, each way [ticks]
  bool fits_link = false;      // gains by condition (3) for the link, else the paper's
  double hold = 0.5;           // duration of the hold [s]

  friend bool operator==(const TapSetting&, const TapSetting&) = default;
};

// Result of a trial; if it diverged, all values are infinite but the stiffness, which is zero.
struct Touch {
  double energy = 0;   // highest E_c [J]
  double port = 0;     // most that the human was given [J]
  double chatter = 0;  // rms speed of the tip above 20 Hz while it is held [m/s]
  double felt = 0;     // the wall's force over the device's depth, over the stiffness set [-]
  double torque = 0;   // the contact's largest torque on any joint [N m]
  double moving = 0;   // rms speed of the tip while it is held [m/s]
};

class TapBench {
 public:
  static constexpr double kSpeed = 0.15;                    // [m/s]
  static constexpr double kGripDamping = 2;                 // [N s/m]
  static constexpr double kSurface = -0.04, kAbove = 0.02;  // the table; the hand's start above [m]
  static constexpr double kFast = 20;  // lowest frequency that counts as chatter [Hz]

  // A wall of stiffness `wall` in a hand of stiffness `grip` [N/m]. Keeps a reference to the arm.
  TapBench(const ExperimentArm& on, const TapSetting& setting, double wall, double grip, int taps);

  Parameters parameters() const;
  Trial trial() const;
  Touch touch(const TrialResult& result) const;

 private:
  double start_of_hold() const { return kRest + down_ / kSpeed; }
  double period() const { return kRest + 2 * down_ / kSpeed + setting_.hold + kRest; }
  double height(double t) const;  // height of the hand below its start [m]

  static constexpr double kRest = 0.1;    // [s]
  static constexpr double kJudged = 0.2;  // duration of the judged end of the hold [s]

  const ExperimentArm* on_;
  TapSetting setting_;
  double wall_, grip_, down_;
  int taps_;
};

// Kinematics of the tip where it meets the table, along the table's normal.
TipAlong tip_at_table(const ExperimentArm& on);
// The stiffest wall at the table that the setting's law renders well by `limpid analyze` [N/m].
double named_wall(const ExperimentArm& on, const TapSetting& setting);

// Bounds for a well rendered wall.
struct WellRendered {
  static constexpr double kPort = 5e-5;    // largest energy given to the human [J]
  static constexpr double kEnergy = 5e-5;  // E_c, with exact encoders [J]
  static constexpr double kChatter = HeldWall::kChatter;
  static constexpr double kFelt = HeldWall::kFelt;
};
bool well_rendered(const Touch& touch, bool exact_encoder);

inline constexpr double kSoftest = 100, kStiffest = 20000;  // walls that are tried [N/m]
inline constexpr double kGrips[] = {300, 3000};  // grips in which a wall must be good [N/m]
inline constexpr int kBisections = 6;

// Grips in which a wall is tapped, and the test it has to pass.
struct WallTest {
  std::span<const double> grips = kGrips;  // [N/m]
  bool (*good)(const Touch& touch, bool exact_encoder) = well_rendered;
};

// For each setting the stiffest good wall between kSoftest and kStiffest [N/m], by bisection of its
// logarithm; kSoftest if not even that one is good. All settings run side by side.
std::vector<double> stiffest_walls(TrialRunner& lab, std::span<const TapSetting> settings,
                                   const WallTest& test = {});

}  // namespace limpid
