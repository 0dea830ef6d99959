// Everything a person can set, with the paper's values as defaults.
//
// One table describes the parameters once, for the command line, configuration files, sliders,
// tooltips and help: key, unit, range and meaning.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>

#include "core/coupling/laws.h"

namespace limpid {

// Not a number stands for "as the arm's file says".
inline constexpr double kFromArm = std::numeric_limits<double>::quiet_NaN();

// Where down is, in the base's frame.
enum class Down : std::uint8_t { as_file, minus_z, plus_z, minus_x, plus_x, minus_y, plus_y };
inline constexpr std::array<const char*, 7> kDowns{"file", "-z", "+z", "-x", "+x", "-y", "+y"};

struct CompensationSettings {
  bool holds_weight = false;
  Down down = Down::as_file;
  double friction_share = 0;  // s, of the Coulomb friction [-]
  bool holds_springs = false;

  static constexpr double kUsualShare = 0.7, kMostShare = 0.95;
  friend bool operator==(const CompensationSettings&, const CompensationSettings&) = default;

  template <class P>
  static constexpr std::array<Setting<P>, 4> settings() {
    return {
        {{"model.gravity", "hold the weight", &P::holds_weight, "-", 0, 1, 0, 1, false, true,
          "The motors hold the arm's own weight, as its file and device.down have it. Off: the "
          "device does it by itself, as by counterweights."},
         {"device.down", "down", choice<P, &P::down>(kDowns), "-", 0, 6, 0, 6, false, true,
          "Where down is in the frame of the arm's base, for an arm that hangs or lies on its "
          "side; file: as its file says, else -z."},
         {"model.friction", "friction taken off", &P::friction_share, "-", 0, kMostShare, 0,
          kMostShare, false, true,
          "Share of the Coulomb friction that the motors take off the hand. Passive while that is "
          "less than the friction that there is: leave what it may be wrong by."},
         {"model.springs", "hold the springs", &P::holds_springs, "-", 0, 1, 0, 1, false, true,
          "The motors hold against the device's own springs, as its file has them."}}};
  }
};

struct Parameters : LawSettings, ObserverSettings, LinkSettings, CompensationSettings {
  CouplingKind kind = CouplingKind::proposed;
  double inertia_ratio = 1e-4;  // M2 = ratio * M(x2) [-]
  double inertia_error = 1;     // factor on the M1, C1 the controller believes [-]
  double hand_stiffness = 300;  // [N/m]
  double hand_damping = 2;      // [N s/m]
  double hand_mass_at_tip = 0;  // of hand and handle, at the tip [kg]
  double tick = 0.001;          // T [s]
  int substeps = 20;
  int device_delay = 0;            // between command and motor [ticks]
  double encoder_step = 0;         // [rad]
  double friction = kFromArm;      // Coulomb, every joint [N m]
  double damping = kFromArm;       // b_d, every joint [N m s/rad]
  double torque_limit = kFromArm;  // every joint [N m]
  bool weighs = false;             // the virtual arm, as its file says; else it counts as held
  bool springy = false;            // it has the springs of its file

  friend bool operator==(const Parameters& a, const Parameters& b);
};

// The most that the delay between command and motor may be [ticks]: as it is set, else of the
// virtual arm as it is, of a real device a tick more than was identified [s], or 3.
int most_delay(const Parameters& p, std::optional<double> identified, bool real);

using ParameterInfo = Setting<Parameters>;

std::span<const ParameterInfo> parameter_table();
const ParameterInfo* find_parameter(std::string_view key);

inline const char* name(CouplingKind kind) { return info(kind).key; }
inline const char* name(VelocitySource source) {
  return kVelocitySources[static_cast<std::size_t>(source)];
}

// A value as configuration files and `--set` give it.
using ParameterValue = std::variant<bool, std::int64_t, double, std::string>;

// Thrown for a key that does not exist or a value that is not allowed; what() names the key, what
// was found and what is allowed.
struct ParameterError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

void set_parameter(Parameters& p, std::string_view key, const ParameterValue& value);
// As a number: choices by their place, bool as 0 or 1, kFromArm for the arm's own.
double parameter_number(const Parameters& p, const ParameterInfo& info);
// Inverse of it; held within the allowed range.
void set_parameter_number(Parameters& p, const ParameterInfo& info, double number);
// As TOML would spell it; empty where the value is left to the arm.
std::string parameter_text(const Parameters& p, const ParameterInfo& info);

}  // namespace limpid
