// Stand-in for OpenHaptics' HD library. Axes: x to the right, y up, z towards the person [mm].
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <limits>
#include <thread>

#include "tests/vendor/stand_in.h"

namespace {

using namespace limpid::stand_in;

constexpr unsigned kDevice = 0, kNoDevice = 0xFFFFFFFF;
constexpr double kMetre = 1000;

struct ErrorInfo {
  unsigned code;
  int internal;
  unsigned device;
};

struct Library {
  Faults faults;
  Arm arm;
  Three force{};
  std::atomic<bool> on{false}, runs{false};
  bool updated = false;
  unsigned error = 0;
  double leap = 0;  // [m]
  unsigned (*callback)(void*) = nullptr;
  void* data = nullptr;
  std::thread thread;

  Library() {
    if (faults.due("prints")) std::puts("{\"a line\": \"of the library\"}");
  }
  void schedule() {
    runs = true;
    thread = std::thread([this] {
      while (runs && callback != nullptr && callback(data) == 1) sleep_ms(1);
    });
  }
  void meet() {
    if (faults.due("hang")) wait_for_ever();
    if (faults.due("crash")) std::raise(SIGSEGV);
  }
};

Library& library() {
  static Library one;
  return one;
}
[[maybe_unused]] const Library& loaded = library();

// Angles of two links of 133.35 mm, from a place 168.35 mm behind the origin and 23.35 mm above it,
// that put the tip there: the law of cosines. The forearm's angle is from where it hangs.
void joints_at(const Three& tip, double* angles) {
  constexpr double kBehind = 0.16835, kAbove = 0.02335, kLink = 0.13335;
  const double out = std::hypot(tip[0], tip[2] + kBehind), up = tip[1] - kAbove;
  const double rise = std::atan2(up, out);
  const double open = std::acos(std::hypot(out, up) / (2 * kLink));
  angles[0] = std::atan2(-tip[0], tip[2] + kBehind);
  angles[1] = rise + open;
  angles[2] = rise - open + std::atan2(1, 0);
}

}  // namespace

extern "C" {

unsigned hdInitDevice(const char* name) {
  Library& own = library();
  if (own.faults.due("prints")) std::printf("opens %s\n", name != nullptr ? name : "the default");
  if (own.faults.due("no_device")) {
    own.error = 0x301;
    return kNoDevice;
  }
  own.faults.start();
  return kDevice;
}
void hdDisableDevice(unsigned) { library().arm.hold({}, false); }
void hdMakeCurrentDevice(unsigned) {}

ErrorInfo hdGetError() {
  Library& own = library();
  const unsigned error = own.error;
  own.error = 0;
  return {error, 0, kDevice};
}

const char* hdGetString(unsigned which) {
  if (which == 0x2501) return "Touch";
  if (which != 0x2500) return "S1";
  if (!library().faults.due("no_version")) return "3.40.0";
  library().error = 0x100;
  return nullptr;
}

void hdGetIntegerv(unsigned which, int* value) {
  *value = which == 0x2555 ? 4 : library().faults.due("button") ? 2 : 0;
}
void hdGetBooleanv(unsigned which, unsigned char* value) {
  *value = which == 0x2002 && library().faults.due("inkwell") ? 1 : 0;
}

void hdGetDoublev(unsigned which, double* values) {
  Library& own = library();
  if (which == 0x2050) {
    own.meet();
    if (own.faults.due_once("jump")) own.leap = 0.05;
    const Three x = own.arm.place();
    for (std::size_t i = 0; i < 3; ++i) {
      values[i] = kMetre * (x[i] + own.leap);
      if (own.faults.due("nan")) values[i] = std::numeric_limits<double>::quiet_NaN();
    }
  } else if (which == 0x2100) {
    joints_at(own.arm.place(), values);
    if (own.faults.due("bent")) values[1] *= 0.9;
  } else if (which == 0x2052) {
    if (!own.faults.due("turned")) return;  // zeros say nothing
    // The pen points to the right: a quarter turn clockwise about the library's y, which is up,
    // takes z to -x. Column by column.
    const double frame[16] = {0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 0, 1};
    std::copy(frame, frame + 16, values);
  } else if (which == 0x2551) {
    const double room[6] = {-160, -100, -70, 160, 120, 70};
    std::copy(room, room + 6, values);
  } else if (which == 0x2603) {
    *values = 3.3;
  } else if (which == 0x2605) {
    for (int i = 0; i < 6; ++i) values[i] = own.faults.due("warm") ? 0.95 : 0.25;
  }
}

void hdSetDoublev(unsigned which, const double* values) {
  if (which == 0x2700) std::copy(values, values + 3, library().force.begin());
}

unsigned hdCheckCalibration() {
  Library& own = library();
  if (own.faults.due("update") && !own.updated) return 0x5001;
  const bool waits = own.faults.value("calibration", -1) >= 0 && !own.faults.due("calibrated");
  return waits ? 0x5002 : 0x5000;
}
void hdUpdateCalibration(unsigned) { library().updated = true; }

void hdEnable(unsigned) { library().on = true; }
void hdDisable(unsigned) { library().on = false; }
void hdBeginFrame(unsigned) {}
void hdEndFrame(unsigned) {
  Library& own = library();
  own.arm.hold(own.force, own.on);
  if (own.faults.due_once("stop")) sleep_ms(own.faults.value("stop", 10));
  if (own.faults.due("warm")) own.error = 0x200;
  if (own.faults.due_once("frame_error")) own.error = 0x302;
  if (own.faults.due("unplug")) own.error = 0x303;
}

unsigned long hdScheduleAsynchronous(unsigned (*callback)(void*), void* data, unsigned short) {
  library().callback = callback;
  library().data = data;
  return 1;
}
void hdUnschedule(unsigned long) {}
void hdStartScheduler() { library().schedule(); }
void hdStopScheduler() {
  library().runs = false;
  if (library().thread.joinable()) library().thread.join();
}

}  // extern "C"
