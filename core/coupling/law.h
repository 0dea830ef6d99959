// Interface of a coupling law: its inputs in a tick, its verbs, and its report. laws.h lists all
// laws with their settings.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "core/coupling/decomposition.h"
#include "core/dynamics/arm.h"

namespace limpid {

struct LawSettings;
template <int N>
class Proxy;
template <int N>
class ProxyLink;
template <int N>
class Ledger;
enum class Owed : std::uint8_t;  // see Ledger

// State in which a law begins: device and proxy as they are.
template <int N>
struct LawStart {
  const Vec<N>& x1;      // as measured [rad]
  const Vec<N>& v1;      // [rad/s]
  const Vec<N>& f1_hat;  // human torque, if known [N m]
  // Energy that the human may still be given [J]; none: as left by the loop so far.
  std::optional<double> reserve{};
  Owed owed{};
  bool takes_over = false;  // another law has been in force until now
};

// Reading of the device at t_k.
template <int N>
struct LawReading {
  const Vec<N>& x1;     // as measured [rad]
  const Vec<N>& v1;     // estimated velocity [rad/s]
  double elapsed;       // since the previous reading; 0 for the first one [s]
  double encoder_step;  // [rad]
};

// State of the device as a law estimates it.
template <int N>
struct DeviceEstimate {
  Vec<N> x, v;  // [rad, rad/s]
};

// Input of a law at t_k.
template <int N>
struct LawInput {
  const Vec<N>& x1;           // position of the device, as measured [rad]
  const Vec<N>& v1;           // (x1_k - x1_k-1) / T [rad/s]
  const Dynamics<N>& device;  // M1, C1 and the velocity as the controller believes them
  const Vec<N>& f1_hat;       // human torque, as observed [N m]
  const Vec<N>& vbar2;        // mean velocity of the proxy over the previous tick [rad/s]
  double T;                   // length of the tick that begins [s]
  // The rest is for laws that model the device.
  const typename Arm<N>::Frames& frames;  // frames of the device, where the law locates it
  const Vec<N>& b_d;                      // damping of the device itself [N m s/rad]
  const Vec<N>& b_d_sure;                 // lower bound of b_d that is sure
  const Vec<N>& limit;                    // limit of its motors [N m]
  double authority;                       // share of a torque that reaches the motors, 0 to 1
  double tick;                            // nominal length of a tick [s]
  double encoder_step;                    // [rad]
  int delay_most;                         // largest delay between command and motor [ticks]
  ProxyLink<N>* link = nullptr;           // link between device and proxy; null: none
  Ledger<N>* ledger = nullptr;            // account of energy that all laws share
  bool armed_anew = false;                // force was off and has just been requested
  // Largest force that the motors may make at the tip, beside `limit` [N].
  double tip_force = std::numeric_limits<double>::infinity();
  double alpha = std::numeric_limits<double>::infinity();  // gain of f1_hat's observer [N m s/rad]
};

// Way in which a law solved a tick.
enum class TickSolve : std::uint8_t {
  usual,
  limited,     // motors' limits and contacts all together
  together,    // contacts together, as they did not settle one after the other
  stood_still  // not at all: the proxy does not move for the tick, which only takes energy
};

// Report of a law on a tick.
struct LawReport {
  // Energy left in the law's ledger; infinite without one, and before its first tick [J].
  double reserve = std::numeric_limits<double>::infinity();
  double contact_governor = 1;  // share of the contact force let through
  double damping_governor = 1;  // share of the damping that may be cancelled
  double torque_governor = 1;   // share of all torque that leaves
  TickSolve solved = TickSolve::usual;
  int unsettled = 0;  // ticks so far in which the proxy stood still for want of a solution
};

// A coupling law, in the order of its verbs in a tick.
template <int N>
class Law {
 public:
  // Reserve below which the ledger forgives what the law gives [E0]. A law of springs and dampers
  // returns what was put in, unless its gains are beyond condition (3); then its debt has an end.
  static constexpr double kSpringsLeastLeft = -4;

  Law() = default;
  Law(const Law&) = delete;
  Law& operator=(const Law&) = delete;
  virtual ~Law() = default;

  virtual void start(const LawStart<N>&) {}
  // Locates the device as the law models it.
  virtual DeviceEstimate<N> locate(const LawSettings&, const LawReading<N>& in) {
    return {in.x1, in.v1};
  }
  // Steps the proxy over the tick; returns the torque asked of the motors [N m].
  virtual Vec<N> step(const LawSettings& p, const LawInput<N>& in, Proxy<N>& proxy) = 0;
  // Takes the torque that really left, for the tick that begins [N m].
  virtual void applied(const Vec<N>&) {}
  virtual LawReport report() const { return {}; }

  // Whether the law books its own ticks in the ledger, as one that locates the device between the
  // encoders' steps does.
  virtual bool books_itself() const { return false; }
  virtual double least_left() const { return kSpringsLeastLeft; }
};

}  // namespace limpid
