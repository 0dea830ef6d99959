// The parameters that people can set, with the paper's values as defaults.
//
// One table describes each of them once, for the command line, configuration files, sliders,
// tooltips and help: key, unit, range and meaning.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/coupling/laws.h"
#include "core/coupling/observer_settings.h"

namespace limpid {

// NaN, which stands for "as the arm's file says".
inline constexpr double kFromArm = std::numeric_limits<double>::quiet_NaN();

// Direction of "down" in the base's frame.
enum class Down : std::uint8_t { as_file, minus_z, plus_z, minus_x, plus_x, minus_y, plus_y };
inline constexpr std::array<const char*, 7> kDowns{"file", "-z", "+z", "-x", "+x", "-y", "+y"};

// The device's own forces that the motors take off the hand, see compensation.h.
struct CompensationSettings {
  bool holds_weight = false;
  double friction_share = 0;  // s, share of the Coulomb friction [-]
  bool holds_springs = false;

  static constexpr double kUsualShare = 0.7, kMostShare = 0.95;
  friend bool operator==(const CompensationSettings&, const CompensationSettings&) = default;

  template <class P>
  static constexpr std::array<Field<P>, 3> settings() {
    return {
        {{"model.gravity", "hold the weight", "Motors hold the weight", &P::holds_weight, "-", 0, 1,
          0, 1, false, true,
          "On: the motors hold the arm's own weight, as given by the arm's file and device.down. "
          "Off: the device holds its weight without the motors, for example by counterweights."},
         {"model.friction", "friction taken off", "Friction that motors cancel", &P::friction_share,
          "-", 0, kMostShare, 0, kMostShare, false, true,
          "Share of the joints' Coulomb friction that the motors cancel. The device stays passive "
          "while the motors cancel less than the true friction: leave a margin for the friction "
          "that you do not know."},
         {"model.springs", "hold the springs", "Motors hold the springs", &P::holds_springs, "-", 0,
          1, 0, 1, false, true,
          "The motors cancel the torque of the device's own springs, as given by the arm's "
          "file."}}};
  }
};

// The coupling and its model of the device. A second run on the same hand has its own.
struct ControllerSettings : LawSettings, ObserverSettings, CompensationSettings {
  CouplingKind kind = CouplingKind::proposed;
  double inertia_error = 1;  // factor on the M1, C1 that the controller believes [-]

  template <class P>
  static constexpr auto settings() {
    constexpr std::array<Field<P>, 1> kKind{
        {{"coupling.kind", "coupling", "Coupling", choice<P, &P::kind>(kLawKeys), "-", 0, kLaws - 1,
          0, kLaws - 1, false, true, kLawMeanings.data()}}};
    constexpr std::array<Field<P>, 1> kBelief{
        {{"model.inertia_error", "inertia error", "Error of the model's inertia", &P::inertia_error,
          "-", 0.01, 100, 0.1, 10, true, true,
          "The controller assumes this factor times the true device inertia (section 3.2 of the "
          "paper)."}}};
    return joined(kKind, law_settings<P>(), ObserverSettings::settings<P>(), kBelief,
                  CompensationSettings::settings<P>());
  }
};

// The loop, the link to the proxy, and the proxy.
struct LoopSettings : LinkSettings {
  double inertia_ratio = 1e-4;  // M2 = ratio * M(x2) [-]
  double tick = 0.001;          // T [s]

  template <class P>
  static constexpr auto settings() {
    constexpr std::array<Field<P>, 2> kOwn{
        {{"proxy.inertia_ratio", "M\xE2\x82\x82/M\xE2\x82\x81",
          "Proxy inertia M\xE2\x82\x82/M\xE2\x82\x81", &P::inertia_ratio, "-", 1e-8, 100, 1e-5, 1,
          true, true,
          "Inertia of the proxy divided by the device's inertia (section 4.1 of the paper: 1e-4)."},
         {"loop.tick", "tick T", "tick T", &P::tick, "s", 1e-5, 0.1, 1e-4, 0.01, true, false,
          "Time between two ticks of the loop, T."}}};
    return joined(LinkSettings::settings<P>(), kOwn);
  }
};

struct HandSettings {
  double hand_stiffness = 300;  // [N/m]
  double hand_damping = 2;      // [N s/m]
  double hand_mass_at_tip = 0;  // mass of hand and handle, at the tip [kg]

  template <class P>
  static constexpr std::array<Field<P>, 3> settings() {
    return {
        {{"hand.stiffness", "grip stiffness", "Grip stiffness", &P::hand_stiffness, "N/m", 0, 1e5,
          10, 3000, true, true, "Spring between the hand's target and the tip of the device."},
         {"hand.damping", "grip damping", "Grip damping", &P::hand_damping, "N s/m", 0, 1e3, 0, 20,
          false, true, "Damper between the hand's target and the tip of the device."},
         {"hand.mass", "hand mass", "Hand mass", &P::hand_mass_at_tip, "kg", 0, 2, 0, 0.5, false,
          true, "Point mass of hand and handle at the tip of the virtual device."}}};
  }
};

inline constexpr double kMostEncoderStep = 0.1;  // [rad]

struct DeviceSettings {
  int substeps = 20;
  int device_delay = 0;            // between command and motor [ticks]
  double encoder_step = 0;         // [rad]
  double friction = kFromArm;      // Coulomb, every joint [N m]
  double damping = kFromArm;       // b_d, every joint [N m s/rad]
  double torque_limit = kFromArm;  // every joint [N m]
  bool weighs = false;   // the virtual arm has the weight of its file; else it counts as held
  bool springy = false;  // the virtual arm has the springs of its file
  Down down = Down::as_file;

  template <class P>
  static constexpr std::array<Field<P>, 9> settings() {
    return {
        {{"device.substeps", "substeps", "substeps", &P::substeps, "-", 1, 1000, 1, 100, true,
          false,
          "Integration steps of the virtual device per tick. The motor torque stays constant in a "
          "tick."},
         {"device.delay", "delay", "Device delay", &P::device_delay, "ticks", 0, kMostDelay, 0, 5,
          false, true,
          "Delay from a command to the torque of the virtual device's motors. model.delay tells "
          "the predictive coupling the delay to expect."},
         {"device.encoder_step", "encoder step", "Encoder step", &P::encoder_step, "rad", 0,
          kMostEncoderStep, 0, 2e-3, false, true,
          "Step of the joint encoders; 0: exact encoders. An Omni has 4e-4 rad. For a real device "
          "Limpid never uses a smaller step than the device reports."},
         {"device.friction", "friction", "Device friction", &P::friction, "N m", 0, 100, 0, 0.05,
          false, true, "Coulomb friction of every joint. Default: from the arm's file."},
         {"device.damping", "b_d", "Device damping b_d", &P::damping, "N m s/rad", 0, 100, 1e-4,
          0.1, true, true,
          "The device's own viscous damping, b_d of equation (1); the motors do not make it. "
          "Condition (3) asks for at least 2 b_vc + k_vc T. Default: from the arm's file."},
         {"device.torque_limit", "torque limit", "Motors' largest torque", &P::torque_limit, "N m",
          1e-6, 1e4, 0.01, 5, true, true,
          "Largest torque of every motor (section 3.1 of the paper). Default: from the arm's "
          "file."},
         {"device.gravity", "weight", "Virtual arm has weight", &P::weighs, "-", 0, 1, 0, 1, false,
          true,
          "On: the virtual arm has the weight given by its file. The arm falls if no hand holds "
          "it, unless model.gravity is on: then the motors hold it. Off: counterweights hold the "
          "arm."},
         {"device.springs", "springs", "Virtual arm has springs", &P::springy, "-", 0, 1, 0, 1,
          false, true,
          "On: the virtual arm has the springs given by its file (the file of an identified arm "
          "has springs). If model.springs is on, the motors cancel the torque of these springs. "
          "Off: the arm has no springs."},
         {"device.down", "down", "Down, in the base's frame", choice<P, &P::down>(kDowns), "-", 0,
          6, 0, 6, false, true,
          "Direction of gravity in the frame of the arm's base, for an arm that hangs or lies on "
          "its side. file: the direction in the arm's file, or -z if the file has none."}}};
  }
};

// Imperfections of the virtual arm, as real devices have them and no law knows; none by default.
// The equations are in devices/simulated/plant.h.
struct PlantSettings {
  double torque_scale = 1;      // torque that the motors give over what they are told [-]
  double current_loop = 0;      // bandwidth of the motors' current loop [Hz]; 0: at once
  double resonance = 0;         // of each motor on its transmission, joint held [Hz]; 0: rigid
  double cogging = 0;           // amplitude, every joint [N m]
  double unknown_friction = 0;  // Coulomb, every joint, besides device.friction [N m]
  double eccentricity = 0;      // amplitude of the encoders' error [rad]
  double zero_error = 0;        // of every encoder [rad]

  template <class P>
  static constexpr std::array<Field<P>, 7> settings() {
    return {
        {{"plant.torque_scale", "torque scale", "Scale of the motors' torque", &P::torque_scale,
          "-", 0.1, 10, 0.5, 2, true, true,
          "Torque that the virtual arm's motors give, divided by the commanded torque. No law "
          "knows this setting, nor any other plant setting."},
         {"plant.current_loop", "current loop", "Bandwidth of the current loop", &P::current_loop,
          "Hz", 0, 1e4, 0, 1000, false, true,
          "The motors' torque follows the command with a first-order lag of this bandwidth; 0: "
          "without lag. Real amplifiers have 200 to 2000 Hz."},
         {"plant.resonance", "resonance", "Resonance of the transmission", &P::resonance, "Hz", 0,
          1000, 0, 300, false, true,
          "Each motor drives its joint through a spring, and the encoder is on the motor. This "
          "setting is the motor's resonance frequency while the joint is held. A part of the arm's "
          "inertia is counted as motor inertia. 0: the transmission is rigid."},
         {"plant.cogging", "cogging", "Cogging torque", &P::cogging, "N m", 0, 10, 0, 0.02, false,
          true, "Amplitude of the motors' cogging torque, 60 periods per turn of the joint."},
         {"plant.friction", "unknown friction", "Friction that no law knows", &P::unknown_friction,
          "N m", 0, 100, 0, 0.05, false, true,
          "Coulomb friction of every joint, in addition to device.friction."},
         {"plant.eccentricity", "eccentricity", "Eccentricity of the encoders", &P::eccentricity,
          "rad", 0, 0.05, 0, 0.01, false, true,
          "Amplitude of an error of every encoder. The error repeats ten times per turn of the "
          "joint, for example if the encoder disc of a motor with a 10:1 gear is eccentric."},
         {"plant.zero", "zero", "Error of the encoders' zero", &P::zero_error, "rad", -0.5, 0.5,
          -0.1, 0.1, false, true,
          "Every encoder shows an angle that is too large by this value, for example after a wrong "
          "calibration. A change while the loop runs has the effect of an encoder that slips."}}};
  }
};

struct Parameters : ControllerSettings, LoopSettings, HandSettings, DeviceSettings, PlantSettings {
  friend bool operator==(const Parameters& a, const Parameters& b);
};

// Largest delay between command and motor [ticks]: as set; else the virtual arm's own; else of a
// real device one tick more than `identified` [s], or 3.
int most_delay(const Parameters& p, std::optional<double> identified, bool real);

using ParameterInfo = Field<Parameters>;

std::span<const ParameterInfo> parameter_table();

// Keys of limits of motors and of their energy: less is stricter. A person alone raises them.
inline constexpr std::array kMotorLimits{"device.torque_limit", "ledger.energy", "tank.energy",
                                         "tank.most"};
const ParameterInfo* find_parameter(std::string_view key);
bool of_controller(const ParameterInfo& info);

inline const char* name(CouplingKind kind) { return info(kind).key; }
inline const char* name(VelocitySource source) {
  return kVelocitySources[static_cast<std::size_t>(source)];
}

using ParameterValue = FieldValue;
// Thrown if a key does not exist or a value is not allowed; what() names the key, the value found
// and what is allowed.
using ParameterError = FieldError;

void set_parameter(Parameters& p, std::string_view key, const ParameterValue& value);
// A parameter as a number: choices by their place, bool as 0 or 1, kFromArm for the arm's own.
inline double parameter_number(const Parameters& p, const ParameterInfo& info) {
  return number_of(info, p);
}
// Inverse of parameter_number(); clamps to the allowed range.
inline void set_parameter_number(Parameters& p, const ParameterInfo& info, double number) {
  set_number(info, p, number);
}
// A parameter in TOML's spelling; empty where the value is left to the arm.
std::string parameter_text(const Parameters& p, const ParameterInfo& info);

}  // namespace limpid
