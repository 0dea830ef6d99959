// omega, delta, sigma, lambda and Falcon through Force Dimension's DHD and DRD libraries.
//
// Its axes: x towards the person, y to the right, z up, in metres.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <vector>

#include "devices/vendor/back_end.h"
#include "devices/vendor/library.h"
#include "devices/vendor/tool_frame.h"

namespace limpid {
namespace {

// Models by the beginning of their names: radius of the workspace [m], largest force [N].
struct Model {
  const char* name;
  double radius, force;
};
constexpr std::array kModels{Model{"delta", 0.15, 20}, Model{"omega", 0.075, 12},
                             Model{"sigma", 0.075, 12}, Model{"lambda", 0.1125, 12},
                             Model{"falcon", 0.04, 8}};

constexpr int kMostStatus = 64;  // more than any version of the library has
constexpr int kStatusForce = 5, kStatusForceOffCause = 14;
constexpr int kCauses = 7;               // of no force, numbered as NoForce
constexpr unsigned char kWatchdog = 17;  // [125 us]
constexpr double kMostForce = 10;        // as Limpid allows at the tip [N]
constexpr double kResolution = 1e-5;     // [m]
constexpr int kStatusEvery = 8;          // frames
constexpr unsigned char kOn = 1, kOff = 0;

constexpr const char* kOwner =
    "the owner of the device gets it from Force Dimension, with the SDK for Linux; Limpid looks "
    "for it in /usr/lib, /usr/local/lib and $FORCEDIM_SDK/lib";

// Functions of the libraries, by their names there. The last argument is the device.
struct Functions {
  int (*drdOpenID)(char);
  int (*drdClose)(char);
  bool (*drdIsInitialized)(char);
  int (*drdAutoInit)(char);
  int (*drdStop)(bool, char);
  int (*dhdGetDeviceCount)();
  const char* (*dhdGetSystemName)(char);
  int (*dhdGetSerialNumber)(unsigned short*, char);
  bool (*dhdHasGripper)(char);
  int (*dhdSetBrakes)(int, char);
  int (*dhdSetGravityCompensation)(int, char);
  int (*dhdSetMaxForce)(double, char);
  int (*dhdEmulateButton)(unsigned char, char);
  int (*dhdEnableExpertMode)();
  int (*dhdSetWatchdog)(unsigned char, char);
  int (*dhdEnableForce)(unsigned char, char);
  int (*dhdStop)(char);
  int (*dhdGetPosition)(double*, double*, double*, char);
  int (*dhdGetOrientationFrame)(double (*)[3], char);
  bool (*dhdHasWrist)(char);
  int (*dhdGetButtonMask)(char);
  int (*dhdSetForce)(double, double, double, char);
  int (*dhdGetStatus)(int*, char);
  const char* (*dhdErrorGetLastStr)();
  void (*dhdEnableSimulator)(bool) = nullptr;  // newer libraries have it
  void (*dhdGetSDKVersion)(int*, int*, int*, int*) = nullptr;
};

std::vector<std::string> places_of(const std::string& name) {
  std::vector<std::string> all{name};
  if (const char* sdk = std::getenv("FORCEDIM_SDK"))
    all.push_back(fmt::format("{}/lib/{}", sdk, name));
  all.push_back("/usr/local/lib/" + name);
  all.push_back("/usr/lib/" + name);
  return all;
}

class ForceDimension final : public VendorBackEnd {
 public:
  VendorLibrary load() override {
    dhd_library_.load(places_of("libdhd.so.3"), kOwner);
    drd_library_.load(places_of("libdrd.so.3"), kOwner);
    // The second one may have all functions of the first, with a state of their own.
    const auto find = [&](const char* name, auto& function) { find_function(name, function); };
    find("drdOpenID", sdk_.drdOpenID);
    find("drdClose", sdk_.drdClose);
    find("drdIsInitialized", sdk_.drdIsInitialized);
    find("drdAutoInit", sdk_.drdAutoInit);
    find("drdStop", sdk_.drdStop);
    find("dhdGetDeviceCount", sdk_.dhdGetDeviceCount);
    find("dhdGetSystemName", sdk_.dhdGetSystemName);
    find("dhdGetSerialNumber", sdk_.dhdGetSerialNumber);
    find("dhdHasGripper", sdk_.dhdHasGripper);
    find("dhdSetBrakes", sdk_.dhdSetBrakes);
    find("dhdSetGravityCompensation", sdk_.dhdSetGravityCompensation);
    find("dhdSetMaxForce", sdk_.dhdSetMaxForce);
    find("dhdEmulateButton", sdk_.dhdEmulateButton);
    find("dhdEnableExpertMode", sdk_.dhdEnableExpertMode);
    find("dhdSetWatchdog", sdk_.dhdSetWatchdog);
    find("dhdEnableForce", sdk_.dhdEnableForce);
    find("dhdStop", sdk_.dhdStop);
    find("dhdGetPosition", sdk_.dhdGetPosition);
    find("dhdGetOrientationFrame", sdk_.dhdGetOrientationFrame);
    find("dhdHasWrist", sdk_.dhdHasWrist);
    find("dhdGetButtonMask", sdk_.dhdGetButtonMask);
    find("dhdSetForce", sdk_.dhdSetForce);
    find("dhdGetStatus", sdk_.dhdGetStatus);
    find("dhdErrorGetLastStr", sdk_.dhdErrorGetLastStr);
    drd_library_.find_if_any("dhdEnableSimulator", sdk_.dhdEnableSimulator);
    dhd_library_.find_if_any("dhdGetSDKVersion", sdk_.dhdGetSDKVersion);
    return {drd_library_.path(), version()};
  }

  std::vector<VendorListed> list(const VendorOptions& options) override {
    look_at_simulator(options);
    std::vector<VendorListed> all;
    const int count = sdk_.dhdGetDeviceCount();
    for (int i = 0; i < count; ++i) {
      all.push_back({std::to_string(i), fmt::format("Force Dimension device {}", i), {}});
    }
    return all;
  }

  VendorTraits open(const std::string& name, const VendorOptions& options) override {
    look_at_simulator(options);
    int which = -1;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), which);
    if (error != std::errc{} || end != name.data() + name.size() || which < 0 || which > 15) {
      throw VendorError(fmt::format("\"{}\" is not the name of a device; allowed: 0 to 15", name));
    }
    const int opened = sdk_.drdOpenID(static_cast<char>(which));
    if (opened < 0) throw VendorError(fmt::format("it cannot be opened: {}", why()));
    id_ = static_cast<char>(opened);
    opened_ = true;
    enabled_ = true;  // nobody knows: the first frame switches it off
    const char* const said = sdk_.dhdGetSystemName(id_);
    const std::string system = said != nullptr ? said : "";
    const Model* const model = model_of(system);
    if (model == nullptr) {
      close();
      throw VendorError(
          fmt::format("range and force of the model \"{}\" are not known; known models: delta, "
                      "omega, sigma, lambda and Falcon",
                      system));
    }
    unsigned short serial = 0;
    sdk_.dhdGetSerialNumber(&serial, id_);
    VendorTraits traits;
    traits.name = fmt::format("{} {}", system, serial);
    if (serial != 0) traits.serial = std::to_string(serial);
    has_wrist_ = sdk_.dhdHasWrist(id_);
    traits.made_by = fmt::format("libdrd.so.3 {}", version());
    traits.lower.fill(-model->radius);
    traits.upper.fill(model->radius);
    traits.resolution = kResolution;
    traits.force = std::min(model->force, kMostForce);
    most_ = traits.force;
    return traits;
  }

  std::string needs_calibration() override {
    if (sdk_.drdIsInitialized(id_)) return {};
    return "the device must find its zero position. To do this, it moves by itself through its "
           "whole range for some seconds. Keep hands and things away from the device";
  }

  void calibrate() override {
    demand(sdk_.drdAutoInit(id_), "the device does not find its zero position");
    if (!sdk_.drdIsInitialized(id_)) throw VendorError("the device did not find its zero position");
  }

  void begin(Servo& servo) override {
    // Leaves the motors to us, without force.
    demand(sdk_.drdStop(true, id_), "the device's own control cannot be stopped");
    demand(sdk_.dhdEnableForce(kOff, id_), "its force cannot be switched off");
    demand(sdk_.dhdSetBrakes(kOff, id_), "its brakes cannot be released");
    demand(sdk_.dhdSetGravityCompensation(kOn, id_),
           "the motors cannot be set to hold the device's own weight");
    demand(sdk_.dhdSetMaxForce(most_, id_), "its force cannot be limited");
    if (sdk_.dhdHasGripper(id_)) sdk_.dhdEmulateButton(kOn, id_);
    // Without expert mode the watchdog is refused and nothing is said.
    demand(sdk_.dhdEnableExpertMode(),
           "its expert mode, which its watchdog needs, cannot be switched on");
    demand(sdk_.dhdSetWatchdog(kWatchdog, id_), "its watchdog cannot be set");
    enabled_ = false;
    VendorBackEnd::begin(servo);
  }

  void read(VendorReading& reading) override {
    double x = 0, y = 0, z = 0;
    demand(sdk_.dhdGetPosition(&x, &y, &z, id_), "the device does not report its position");
    reading.x = {-x, -y, z};
    if (has_wrist_) read_wrist(reading);
    const int buttons = sdk_.dhdGetButtonMask(id_);
    reading.buttons = static_cast<std::uint32_t>(buttons);
    if (frames_++ % kStatusEvery != 0) return;
    std::array<int, kMostStatus> status{};
    demand(sdk_.dhdGetStatus(status.data(), id_), "the device does not report its state");
    reading.no_force = why_off(status[kStatusForce] != 0, status[kStatusForceOffCause]);
  }

  void write(const VendorForce& force) override {
    const bool kept_off = force.enabled && withheld_ != NoForce::none;
    if (force.enabled != enabled_ && !kept_off) {
      demand(sdk_.dhdEnableForce(force.enabled ? kOn : kOff, id_),
             "its force cannot be switched on or off");
      enabled_ = force.enabled;
    }
    const TipVector& f = force.force;
    demand(sdk_.dhdSetForce(-f[0], -f[1], f[2], id_), "the device accepts no force");
  }

  void close() noexcept override {
    if (!opened_) return;
    opened_ = false;
    sdk_.dhdStop(id_);
    sdk_.drdClose(id_);
  }

 private:
  // Without a wrist the library's frame never turns, which says nothing of the tool.
  void read_wrist(VendorReading& reading) const {
    double rows[3][3] = {};
    demand(sdk_.dhdGetOrientationFrame(rows, id_), "the device does not report its orientation");
    const Mat3 turned = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(&rows[0][0]);
    // Limpid's axes in the library's: forward is away from the person, left is against y.
    reading.orientation = tool_orientation(Vec3(-1, -1, 1).asDiagonal(), turned);
  }

  // The reason why the motors are off that were switched on. The watchdog's is our own lateness:
  // the next force switches them on again. Any other one is left to the device and the person,
  // whose button it may be: until the device has force again, nobody else switches its motors on.
  NoForce why_off(bool on, int cause) {
    if (on) withheld_ = NoForce::none;
    if (on || !enabled_ || withheld_ != NoForce::none) return withheld_;
    const NoForce why = cause > 0 && cause < kCauses ? static_cast<NoForce>(cause) : NoForce::other;
    if (why == NoForce::watchdog) {
      enabled_ = false;
    } else {
      withheld_ = why;
    }
    return why;
  }

  template <class Function>
  void find_function(const char* name, Function& function) const {
    Function found = nullptr;
    drd_library_.find_if_any(name, found);
    if (found == nullptr) dhd_library_.find(name, found);
    function = found;
  }

  // Empty where the library has no function that says it.
  std::string version() const {
    if (sdk_.dhdGetSDKVersion == nullptr) return {};
    int major = 0, minor = 0, release = 0, revision = 0;
    sdk_.dhdGetSDKVersion(&major, &minor, &release, &revision);
    return fmt::format("{}.{}.{}.{}", major, minor, release, revision);
  }

  void look_at_simulator(const VendorOptions& options) const {
    if (!options.simulator) return;
    if (sdk_.dhdEnableSimulator == nullptr) {
      throw VendorError("this version of the library has no simulator");
    }
    sdk_.dhdEnableSimulator(true);
  }

  static const Model* model_of(std::string system) {
    std::ranges::transform(system, system.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const auto found = std::ranges::find_if(
        kModels, [&](const Model& model) { return system.find(model.name) != std::string::npos; });
    return found == kModels.end() ? nullptr : &*found;
  }

  std::string why() const {
    const char* const said = sdk_.dhdErrorGetLastStr();
    return said != nullptr ? said : "no reason given";
  }

  // Negative answers are errors; positive ones are remarks.
  void demand(int answer, const char* what) const {
    if (answer < 0) throw VendorError(fmt::format("{}: {}", what, why()));
  }

  Library dhd_library_, drd_library_;
  Functions sdk_{};
  char id_ = -1;
  bool opened_ = false, enabled_ = false, has_wrist_ = false;
  NoForce withheld_ = NoForce::none;  // why the device has switched its motors off by itself
  double most_ = 0;                   // [N]
  unsigned frames_ = 0;
};

}  // namespace

std::unique_ptr<VendorBackEnd> make_forcedimension() { return std::make_unique<ForceDimension>(); }

}  // namespace limpid
