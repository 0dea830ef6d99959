// Everything a person can set, with the paper's values as defaults.
//
// One table describes the parameters once, for the command line, configuration files, sliders,
// tooltips and help: key, unit, range and meaning.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>

namespace limpid {

enum class CouplingKind : std::uint8_t { standard, proposed };
enum class VelocitySource : std::uint8_t { raw, lowpass, adaptive };

// Not a number stands for "as the arm's file says".
inline constexpr double kFromArm = std::numeric_limits<double>::quiet_NaN();

struct Parameters {
  CouplingKind kind = CouplingKind::proposed;
  double k_vc = 10;      // [N m/rad]
  double b_vc = 0.001;   // [N m s/rad]
  double b_v = 0.012;    // [N m s/rad]
  double eta = 1;        // [-]
  double alpha = 0.035;  // [N m s/rad]
  bool anti_windup = true;
  VelocitySource velocity = VelocitySource::raw;
  double inertia_ratio = 1e-4;  // M2 = ratio * M(x2) [-]
  double inertia_error = 1;     // factor on the M1, C1 the controller believes [-]
  double hand_stiffness = 300;  // [N/m]
  double hand_damping = 2;      // [N s/m]
  double tick = 0.001;          // T [s]
  int substeps = 20;
  double encoder_step = 0;         // [rad]
  double friction = kFromArm;      // Coulomb, every joint [N m]
  double damping = kFromArm;       // b_d, every joint [N m s/rad]
  double torque_limit = kFromArm;  // every joint [N m]

  friend bool operator==(const Parameters& a, const Parameters& b);
};

// One key of the table.
struct ParameterInfo {
  using Field = std::variant<double Parameters::*, int Parameters::*, bool Parameters::*,
                             CouplingKind Parameters::*, VelocitySource Parameters::*>;
  const char* key;    // "coupling.eta"
  const char* label;  // short, for a slider
  Field field;
  const char* unit;  // "-" for none
  double minimum;    // allowed
  double maximum;
  double slider_minimum;  // the part of it worth a slider
  double slider_maximum;
  bool logarithmic;     // the slider
  bool live;            // may change while the loop runs
  const char* meaning;  // one or two sentences with the equation's number
};

std::span<const ParameterInfo> parameter_table();
const ParameterInfo* find_parameter(std::string_view key);

// Choices of the two enumerations, as the files spell them.
const char* name(CouplingKind kind);
const char* name(VelocitySource source);

// A value as configuration files and `--set` give it.
using ParameterValue = std::variant<bool, std::int64_t, double, std::string>;

// Thrown for a key that does not exist or a value that is not allowed; what() names the key, what
// was found and what is allowed.
struct ParameterError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

void set_parameter(Parameters& p, std::string_view key, const ParameterValue& value);
// As TOML would spell it; empty where the value is left to the arm.
std::string parameter_text(const Parameters& p, const ParameterInfo& info);

}  // namespace limpid
