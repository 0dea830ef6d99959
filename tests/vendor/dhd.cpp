// Stand-in for Force Dimension's DHD library, and for the functions of DRD that open devices: those
// are in a second library, which needs this one. Axes: x towards the person, y right, z up [m].
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <limits>
#include <thread>

#include "tests/vendor/stand_in.h"

namespace {

using namespace limpid::stand_in;

struct Device {
  Faults faults;
  Arm arm;
  std::atomic<bool> on{false}, open{false}, expert{false};
  std::atomic<int> cause{0};
  std::atomic<std::int64_t> watchdog{0}, commanded{0};  // [ns]
  std::atomic<bool> initialised{true};
  double leap = 0;
  Three force{};
  std::thread box;  // the electronics of the device, which have a watchdog of their own

  Device() {
    if (faults.due("prints")) std::puts("{\"a line\": \"of the library\"}");
    if (faults.due("calibration")) initialised = false;
  }
  ~Device() {
    open = false;
    if (box.joinable()) box.join();
  }
  void switch_on() {
    faults.start();
    open = true;
    box = std::thread([this] {
      while (open) {
        if (watchdog > 0 && on && now() - commanded > watchdog) cut(3);
        if (on && faults.due("button_off") && !faults.due("button_on")) cut(1);
        if (faults.due_once("button_on")) give_back();
        sleep_ms(0.1);
      }
    });
  }
  void cut(int why) {
    on = false;
    cause = why;
    arm.hold({}, false);
  }
  // The person's button on the device gives the force back, without the library.
  void give_back() {
    commanded = now();
    cause = 0;
    on = true;
    arm.hold({}, true);
  }
  void meet() {
    if (faults.due("hang")) wait_for_ever();
    if (faults.due("crash")) std::raise(SIGSEGV);
  }
};

Device& device() {
  static Device one;
  return one;
}
[[maybe_unused]] const Device& loaded = device();

}  // namespace

extern "C" {

int stand_in_open(char which) {
  Device& own = device();
  if (own.faults.due("prints")) std::puts("opens");
  if (own.faults.due("no_device")) return -1;
  own.switch_on();
  return which;
}
int stand_in_close(char) {
  device().open = false;
  if (device().box.joinable()) device().box.join();
  device().cut(4);
  return 0;
}
bool stand_in_initialised() { return device().initialised; }
int stand_in_find_zero() {
  std::puts("the stand-in moves");
  device().initialised = true;
  return 0;
}

void dhdGetSDKVersion(int* major, int* minor, int* release, int* revision) {
  *major = 3, *minor = 17, *release = 1, *revision = 20;
}
int dhdGetDeviceCount() { return device().faults.due("no_device") ? 0 : 1; }
const char* dhdGetSystemName(char) {
  return device().faults.due("unknown_model") ? "epsilon" : "omega.3";
}
int dhdGetSerialNumber(unsigned short* serial, char) {
  *serial = 12;
  return 0;
}
bool dhdHasGripper(char) { return false; }
int dhdSetBrakes(int, char) { return 0; }
int dhdSetGravityCompensation(int, char) { return 0; }
int dhdSetMaxForce(double, char) { return 0; }
int dhdEmulateButton(unsigned char, char) { return 0; }
int dhdEnableExpertMode() {
  device().expert = true;
  return 0;
}
int dhdSetWatchdog(unsigned char units, char) {
  if (device().expert) device().watchdog = units * 125'000;
  return 0;
}
int dhdEnableForce(unsigned char on, char) {
  Device& own = device();
  own.commanded = now();
  own.cause = on != 0 ? 0 : 4;
  own.on = on != 0;
  own.arm.hold({}, own.on);
  return 0;
}
int dhdStop(char) {
  device().cut(4);
  return 0;
}
int dhdGetPosition(double* x, double* y, double* z, char) {
  Device& own = device();
  own.meet();
  if (own.faults.due("unplug")) return -1;
  if (own.faults.due_once("jump")) own.leap = 0.05;
  const Three place = own.arm.place();
  *x = place[0] + own.leap;
  *y = place[1];
  *z = place[2];
  if (own.faults.due("nan")) *x = std::numeric_limits<double>::quiet_NaN();
  return 0;
}
bool dhdHasWrist(char) { return device().faults.due("turned"); }
int dhdGetOrientationFrame(double (*rows)[3], char) {
  // The handle is turned a quarter about the library's y, which is to the right: x goes to -z, so
  // that what pointed away from the person points up.
  const double frame[3][3] = {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}};
  std::memcpy(rows, frame, sizeof frame);
  return 0;
}
int dhdGetButtonMask(char) { return 0; }
int dhdSetForce(double x, double y, double z, char) {
  Device& own = device();
  if (own.faults.due_once("stop")) sleep_ms(own.faults.value("stop", 10));
  if (own.faults.due_once("frame_error")) return -1;
  own.commanded = now();
  if (own.on) own.arm.hold({x, y, z}, true);
  return 0;
}
int dhdGetStatus(int* status, char) {
  std::memset(status, 0, 16 * sizeof *status);
  status[5] = device().on ? 1 : 0;
  status[14] = device().cause;
  return 0;
}
const char* dhdErrorGetLastStr() { return "an error of the stand-in"; }
void dhdEnableSimulator(bool) {}

}  // extern "C"
