// Touch, Touch X, Omni and Premium through OpenHaptics' HD library.
//
// The library has a thread of its own for the frames, about 1000 a second. Its axes: x to the
// right, y up, z towards the person, in millimetres.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "devices/vendor/back_end.h"
#include "devices/vendor/library.h"
#include "devices/vendor/servo.h"
#include "devices/vendor/tool_frame.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

using Handle = unsigned;
struct ErrorInfo {
  unsigned code;
  int internal;
  Handle device;
};

constexpr Handle kNoDevice = 0xFFFFFFFF;
constexpr unsigned kVersion = 0x2500, kModel = 0x2501, kSerial = 0x2504, kCalibrationStyle = 0x2555;
constexpr unsigned kCalibrated = 0x5000, kNeedsUpdate = 0x5001;  // else it needs a person
constexpr unsigned kForceOutput = 0x4000;
constexpr unsigned kPosition = 0x2050, kTransform = 0x2052, kJointAngles = 0x2100;
constexpr unsigned kButtons = 0x2000, kSafetySwitch = 0x2001, kInkwell = 0x2002;
constexpr unsigned kTemperatures = 0x2605, kMostForce = 0x2603, kWorkspace = 0x2551;
constexpr unsigned kForce = 0x2700;
constexpr unsigned kWarm = 0x200, kForceError = 0x201, kImpulse = 0x202, kVelocity = 0x203,
                   kForceType = 0x204;
constexpr unsigned kContinue = 1, kDone = 0;
constexpr unsigned short kFirst = 65535;  // priority

constexpr double kMetre = 1000;         // [mm]
constexpr double kResolution = 5.5e-5;  // at the tip of an Omni [m]
constexpr double kLink = 133.35;        // upper arm and forearm of an Omni and a Touch [mm]
constexpr int kMostErrors = 16;         // taken in a frame
constexpr int kMotors = 6;
constexpr int kReasonStays = 50;  // frames for which a reason is told, so that it is seen

constexpr const char* kOwner =
    "the owner of the device gets it from 3D Systems, with OpenHaptics for Linux and the Touch "
    "Device Driver";
constexpr const char* kDefault = "Default Device";
constexpr const char* kLibrary = "libHD.so.3.4";

// Functions of the library, by their names there.
struct Functions {
  Handle (*hdInitDevice)(const char*);
  void (*hdDisableDevice)(Handle);
  void (*hdMakeCurrentDevice)(Handle);
  ErrorInfo (*hdGetError)();
  const char* (*hdGetString)(unsigned);
  void (*hdGetIntegerv)(unsigned, int*);
  void (*hdGetBooleanv)(unsigned, unsigned char*);
  void (*hdGetDoublev)(unsigned, double*);
  void (*hdSetDoublev)(unsigned, const double*);
  unsigned (*hdCheckCalibration)();
  void (*hdUpdateCalibration)(unsigned);
  void (*hdEnable)(unsigned);
  void (*hdDisable)(unsigned);
  void (*hdBeginFrame)(Handle);
  void (*hdEndFrame)(Handle);
  unsigned long (*hdScheduleAsynchronous)(unsigned (*)(void*), void*, unsigned short);
  void (*hdUnschedule)(unsigned long);
  void (*hdStartScheduler)();
  void (*hdStopScheduler)();
};

// Names of the devices that the driver was told of, each in a file of its own.
std::set<std::string> configured() {
  std::set<std::string> names;
  const auto look = [&](const fs::path& folder) {
    std::error_code none;
    for (fs::directory_iterator entry(folder, none), end; !none && entry != end;
         entry.increment(none)) {
      if (entry->path().extension() == ".config") names.insert(entry->path().stem().string());
    }
  };
  if (const char* home = std::getenv("HOME")) look(fs::path(home) / ".3dsystems/config");
  if (const char* driver = std::getenv("GTDD_HOME")) {
    look(driver);
    look(fs::path(driver) / "config");
  }
  return names;
}

// Place of the tip by the joint angles, from where the first two axes meet, in the library's axes
// [mm]: turn to the left, the upper arm's rise, and the forearm from where it hangs.
std::array<double, 3> tip_by_joints(const std::array<double, 3>& q) {
  const double out = kLink * (std::cos(q[1]) + std::sin(q[2]));
  const double up = kLink * (std::sin(q[1]) - std::cos(q[2]));
  return {-std::sin(q[0]) * out, up, std::cos(q[0]) * out};
}

// Comparison of two readings of the tip that have different origins: how much their difference
// changes, which is nothing if both are right.
class TipsCompared {
 public:
  void add(const std::array<double, 3>& one, const std::array<double, 3>& other) {
    for (std::size_t i = 0; i < one.size(); ++i) {
      const double off = one[i] - other[i];
      least_[i] = frames_ > 0 ? std::min(least_[i], off) : off;
      most_[i] = frames_ > 0 ? std::max(most_[i], off) : off;
      came_from_[i] = frames_ > 0 ? std::min(came_from_[i], one[i]) : one[i];
      came_to_[i] = frames_ > 0 ? std::max(came_to_[i], one[i]) : one[i];
    }
    ++frames_;
  }
  std::uint64_t frames() const { return frames_; }
  double apart() const { return largest(least_, most_); }       // over all frames
  double way() const { return largest(came_from_, came_to_); }  // of the first reading

 private:
  static double largest(const std::array<double, 3>& from, const std::array<double, 3>& to) {
    return std::max({to[0] - from[0], to[1] - from[1], to[2] - from[2]});
  }
  std::array<double, 3> least_{}, most_{}, came_from_{}, came_to_{};
  std::uint64_t frames_ = 0;
};

class OpenHaptics final : public VendorBackEnd {
 public:
  VendorLibrary load() override {
    const std::array<std::string, 2> names{kLibrary, "libHD.so"};
    library_.load(names, kOwner);
    const auto find = [&](const char* name, auto& function) { library_.find(name, function); };
    find("hdInitDevice", hd_.hdInitDevice);
    find("hdDisableDevice", hd_.hdDisableDevice);
    find("hdMakeCurrentDevice", hd_.hdMakeCurrentDevice);
    find("hdGetError", hd_.hdGetError);
    find("hdGetString", hd_.hdGetString);
    find("hdGetIntegerv", hd_.hdGetIntegerv);
    find("hdGetBooleanv", hd_.hdGetBooleanv);
    find("hdGetDoublev", hd_.hdGetDoublev);
    find("hdSetDoublev", hd_.hdSetDoublev);
    find("hdCheckCalibration", hd_.hdCheckCalibration);
    find("hdUpdateCalibration", hd_.hdUpdateCalibration);
    find("hdEnable", hd_.hdEnable);
    find("hdDisable", hd_.hdDisable);
    find("hdBeginFrame", hd_.hdBeginFrame);
    find("hdEndFrame", hd_.hdEndFrame);
    find("hdScheduleAsynchronous", hd_.hdScheduleAsynchronous);
    find("hdUnschedule", hd_.hdUnschedule);
    find("hdStartScheduler", hd_.hdStartScheduler);
    find("hdStopScheduler", hd_.hdStopScheduler);
    return {library_.path(), {}};
  }

  // The devices that the driver was told of. Nobody asks the devices, as that would open them.
  std::vector<VendorListed> list(const VendorOptions&) override {
    std::vector<VendorListed> all;
    for (const std::string& name : configured()) {
      all.push_back({name, fmt::format("{} (OpenHaptics)", name), {}});
    }
    return all;
  }

  VendorTraits open(const std::string& name, const VendorOptions&) override {
    device_ = hd_.hdInitDevice(name == kDefault ? nullptr : name.c_str());
    std::string wrong;
    for (int i = 0; i < kMostErrors; ++i) {
      const ErrorInfo error = hd_.hdGetError();
      if (error.code == 0) break;
      wrong += fmt::format("{}0x{:x}", wrong.empty() ? "" : ", ", error.code);
    }
    if (device_ == kNoDevice || !wrong.empty()) {
      if (device_ != kNoDevice) close();
      throw VendorError(
          fmt::format("{}: the library cannot open the device ({}); check that it is plugged in "
                      "and switched on, that this user may read and write its port, and that the "
                      "maker's own diagnostic program finds it",
                      name, wrong.empty() ? "no error reported" : "error " + wrong));
    }
    opened_ = true;
    hd_.hdMakeCurrentDevice(device_);
    VendorTraits traits;
    const std::string model = text(kModel);
    traits.serial = text(kSerial);
    traits.name = fmt::format("{} {}", model, traits.serial);
    has_switch_ = model.find("Touch X") != std::string::npos;
    known_links_ = !has_switch_ && (model.find("Touch") != std::string::npos ||
                                    model.find("Omni") != std::string::npos);
    hd_.hdGetIntegerv(kCalibrationStyle, &style_);
    // The least corner, then the greatest, in the library's axes.
    std::array<double, 6> room{};
    hd_.hdGetDoublev(kWorkspace, room.data());
    const TipVector a = of_tip({room[0], room[1], room[2]});
    const TipVector b = of_tip({room[3], room[4], room[5]});
    for (std::size_t i = 0; i < a.size(); ++i) {
      traits.lower[i] = std::min(a[i], b[i]) / kMetre;
      traits.upper[i] = std::max(a[i], b[i]) / kMetre;
    }
    traits.resolution = kResolution;
    hd_.hdGetDoublev(kMostForce, &traits.force);
    throw_errors("open");
    const std::string version = text(kVersion);
    traits.made_by = version.empty() ? kLibrary : fmt::format("{} {}", kLibrary, version);
    take_errors();  // whoever does not know its version may still drive the device
    return traits;
  }

  std::string needs_calibration() override {
    // Nothing moves by itself: a person puts the pen into its inkwell, and there is no force
    // before.
    if (hd_.hdCheckCalibration() == kNeedsUpdate) calibrate();
    return {};
  }

  void calibrate() override { hd_.hdUpdateCalibration(static_cast<unsigned>(style_)); }

  void read(VendorReading& reading) override {
    const unsigned state = hd_.hdCheckCalibration();
    if (state == kNeedsUpdate) calibrate();
    reading.calibrated = state == kCalibrated;
    std::array<double, 3> place{};
    hd_.hdGetDoublev(kPosition, place.data());
    if (known_links_ && reading.calibrated) {
      std::array<double, 3> angles{};
      hd_.hdGetDoublev(kJointAngles, angles.data());
      compared_.add(place, tip_by_joints(angles));
    }
    reading.x = of_tip(place);
    for (double& each : reading.x) each /= kMetre;
    // Column by column.
    std::array<double, 16> frame{};
    hd_.hdGetDoublev(kTransform, frame.data());
    const Mat3 turned = Eigen::Map<const Eigen::Matrix4d>(frame.data()).topLeftCorner<3, 3>();
    reading.orientation = tool_orientation(axes(), turned);
    int buttons = 0;
    hd_.hdGetIntegerv(kButtons, &buttons);
    reading.buttons = static_cast<std::uint32_t>(buttons);
    unsigned char docked = 0, held = 1;
    hd_.hdGetBooleanv(kInkwell, &docked);
    if (has_switch_) hd_.hdGetBooleanv(kSafetySwitch, &held);
    reading.hand = docked == 0 && held != 0;
    std::array<double, kMotors> warmth{};
    hd_.hdGetDoublev(kTemperatures, warmth.data());
    reading.warmth = static_cast<float>(*std::ranges::max_element(warmth));
    reading.no_force = reason_for_ > 0 ? reason_ : NoForce::none;
    if (reason_for_ > 0) --reason_for_;
  }

  void write(const VendorForce& force) override {
    if (force.enabled != enabled_) {
      force.enabled ? hd_.hdEnable(kForceOutput) : hd_.hdDisable(kForceOutput);
      enabled_ = force.enabled;
    }
    // The inverse of of_tip().
    const TipVector& f = force.force;
    const std::array<double, 3> own{-f[1], f[2], -f[0]};
    hd_.hdSetDoublev(kForce, own.data());
  }

  void begin(Servo& servo) override {
    servo_ = &servo;
    scheduled_ = true;
    task_ = hd_.hdScheduleAsynchronous(
        [](void* self) { return static_cast<OpenHaptics*>(self)->turn(); }, this, kFirst);
    hd_.hdStartScheduler();
    throw_errors("start");
  }

  void end() noexcept override {
    if (!scheduled_) return;
    scheduled_ = false;
    hd_.hdStopScheduler();
    hd_.hdUnschedule(task_);
  }

  // Nobody has seen yet whether a real Touch's joint angles are what they are said to be. Its
  // position is what counts in any case.
  std::string remark() const override {
    if (compared_.frames() == 0) return {};
    return fmt::format(
        "its joint angles (two links of {} mm) and its position were up to {:.2f} mm apart while "
        "it moved {:.0f} mm, in {} frames; Limpid uses the position",
        kLink, compared_.apart(), compared_.way(), compared_.frames());
  }

  void close() noexcept override {
    end();
    if (!opened_) return;
    opened_ = false;
    hd_.hdDisableDevice(device_);
  }

 private:
  // A frame, in the library's own thread.
  unsigned turn() noexcept {
    hd_.hdBeginFrame(device_);
    const bool more = servo_->frame(*this);
    hd_.hdEndFrame(device_);
    const std::string error = take_errors();
    if (error.empty()) return more ? kContinue : kDone;
    hd_.hdBeginFrame(device_);
    write({});
    hd_.hdEndFrame(device_);
    servo_->fail(error);
    return kDone;
  }

  // Limpid's axes in the library's, as of_tip() has them.
  static Mat3 axes() {
    Mat3 rows;
    rows << 0, 0, -1, -1, 0, 0, 0, 1, 0;
    return rows;
  }

  // Forward is away from the person, left is against x.
  static TipVector of_tip(const std::array<double, 3>& own) { return {-own[2], -own[0], own[1]}; }

  std::string text(unsigned which) const {
    const char* const found = hd_.hdGetString(which);
    return found != nullptr ? found : "";
  }

  // Takes the errors of the frame. Warnings become the reason for no force; returns any other one.
  std::string take_errors() noexcept {
    for (int i = 0; i < kMostErrors; ++i) {
      const ErrorInfo error = hd_.hdGetError();
      switch (error.code) {
        case 0: return {};
        case kWarm: say(NoForce::warm); break;
        case kVelocity: say(NoForce::velocity); break;
        case kForceError:
        case kImpulse:
        case kForceType: say(NoForce::other); break;
        default: return fmt::format("the library reports error 0x{:x}", error.code);
      }
    }
    return {};
  }
  void say(NoForce reason) {
    reason_ = reason;
    reason_for_ = kReasonStays;
  }
  void throw_errors(const char* when) {
    if (const std::string error = take_errors(); !error.empty()) {
      throw VendorError(fmt::format("{}: {}", when, error));
    }
  }

  Library library_;
  Functions hd_{};
  Handle device_ = kNoDevice;
  bool opened_ = false, scheduled_ = false, enabled_ = false, has_switch_ = false;
  bool known_links_ = false;
  TipsCompared compared_;
  int style_ = 0;
  unsigned long task_ = 0;
  Servo* servo_ = nullptr;
  NoForce reason_ = NoForce::none;
  int reason_for_ = 0;
};

}  // namespace

std::unique_ptr<VendorBackEnd> make_openhaptics() { return std::make_unique<OpenHaptics>(); }

}  // namespace limpid
