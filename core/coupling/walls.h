// Bounds of the stiffness of walls that an arm's tip touches, in closed form.
#pragma once

#include "core/coupling/predictor.h"
#include "core/math/sizes.h"

namespace limpid {

// An arm's tip along one direction n.
struct TipAlong {
  double mass = 0;     // free to give way across n: 1 / (n' J M^-1 J' n) [kg]
  double damping = 0;  // by all joints' own dampers [N s/m]
  double lever2 = 0;   // |J' n|^2: a joint's stiffness or damping divided by the tip's [m^2]
  double led = 0;      // mass led along n, as a hand leads it: n' (J M^-1 J')^-1 n [kg]
};

// Computes a tip along n (unit). J: of the tip (3 x n) [m]; M: of the device (n x n) [kg m^2]; b_d:
// n, above 0 [N m s/rad].
TipAlong tip_along(const Eigen::MatrixXd& J, const Eigen::MatrixXd& M, const Eigen::VectorXd& b_d,
                   const Vec3& n);
// Gain of joints that are all alike which does at the tip along n what gains of these weights do,
// over the gain of weight 1 [-]. weights: of every joint, at least 1.
double weight_at_tip(const Eigen::MatrixXd& J, const Eigen::VectorXd& weights, const Vec3& n);
// The same for the direction with the longest lever.
double longest_levers_weight(const Eigen::MatrixXd& J, const Eigen::VectorXd& weights);
// Mass of the easiest direction, and the longest lever.
TipMoved easiest(const Eigen::MatrixXd& J, const Eigen::MatrixXd& M);
// Coulomb friction with which joints hold the tip, however it is pushed: the least of each joint's
// over its lever [N]. friction: of each joint [N m].
double friction_at_tip(const Eigen::MatrixXd& J, const Eigen::VectorXd& friction);
// Unit vector along which the joints' own dampers hold the tip least: there walls are hardest to
// render. Without dampers the one along which the joints have the longest levers.
Vec3 least_damped(const Eigen::MatrixXd& J, const Eigen::VectorXd& b_d);

// Settings of a wall's joints, all alike, and of the hand at the tip.
struct WallSetting {
  double T = 0.001;          // [s]
  double k_vc = 0, b_v = 0;  // [N m/rad, N m s/rad]
  double eta = 1;
  double hand_damping = 0;  // [N s/m]
  double hand_mass = 0;     // [kg]
  double delay = 0;         // from a reading to its answering torque, beyond the tick [s]
};

// Stiffest wall of the proposed coupling [N/m]: the present damping against the lag of its contact,
// half a tick, b_v/k_vc and the device's delay.
double proposed_wall(const TipAlong& tip, const WallSetting& s);
// Stiffest wall that a plain spring renders passively in every hand, with its torque a delay late
// [N/m]: b_d / (T/2 + delay) (Colgate and Schenkel 1997). A law of another shape may show more.
double every_hands_wall(const TipAlong& tip, double T, double delay = 0);
// Stiffest wall on the device itself that stays quiet in this hand [N/m]: (b_d + b_h) / (T/2 +
// delay).
double direct_wall(const TipAlong& tip, const WallSetting& s);
// Stiffest wall that energy bounding shows to a slow hand [N/m]: 2 b_d / (T + delay).
double bounded_wall(const TipAlong& tip, const WallSetting& s);
// Stiffest wall of the passivity controller, whose damper is at most `part` of m_n / (T + delay)
// [N/m].
double braked_wall(const TipAlong& tip, const WallSetting& s, double part);
// Force of a step q of the encoder at the tip [m] that a wall on the device may make: what friction
// f_c holds (Abbott and Okamura 2005), or what a hand hardly feels. Stiffest wall for it [N/m];
// infinite without steps.
double stepped_wall(double q, double friction);
// Stiffest wall of a prediction that takes the arm to move alone while a mass is in the hand. It is
// bounded by the energy that this error gives away; infinite without a mass.
double mistaken_wall(const TipAlong& tip, const WallSetting& s);

// Further settings that bound a wall of the predictive coupling.
struct PredictiveWallSetting {
  WallSetting at;
  double encoder_step = 0;    // [rad]
  double friction = 0;        // see friction_at_tip() [N]
  double mass_foreseen = 0;   // mass of the hand in the predictor [kg]
  double delay_foreseen = 0;  // delay known to the predictor [s]
  double inertia_ratio = 0;   // M2 / M1 [-]
};
enum class WallBound {
  tried,     // no stiffer wall was tried
  quick,     // the tip's mass moves too far in a tick for a prediction that does not know the hand
  proxy,     // the proxy's inertia is felt through the spring k_vc
  step,      // a step of the encoder pushes the hand
  cell,      // the tip moves inside a cell of the encoder, where no reading tells of it
  friction,  // as before, and friction no longer stops it
  hand,      // the hand is heavier than foreseen
  delay,
};
struct BoundedWall {
  double stiffness;  // [N/m]
  WallBound by;
};
// Stiffest wall that the predictive coupling renders without rattle and to 5 % as set, whatever its
// direction. tip: along the easiest direction.
BoundedWall predictive_wall(const TipMoved& tip, const PredictiveWallSetting& s);

// Stiffness at the tip of a spring k_vc behind a line of impedance b and delay t, at every joint
// [N/m].
double line_at_tip(const TipAlong& tip, double k_vc, double b, double t);
// Stiffness at the tip of a spring k_vc at every joint: any wall felt through it is softer [N/m].
double spring_at_tip(const TipAlong& tip, double k_vc);

}  // namespace limpid
