// Plugs the three kinds of devices in and asks the program itself what it finds; then has it look
// at the two that have joints, whose own logs say whether it pushed.
#include <cmath>
#include <cstdio>
#include <string>

#include "tests/support/hid/pid_joystick_model.h"
#include "tests/support/hid/raw_device_model.h"
#include "tests/support/hid/space_mouse_model.h"
#include "tests/support/hid/uhid_device.h"

namespace {

using namespace limpid::test;

struct Answer {
  std::string text;
  int status = -1;
};

Answer ask_program(const std::string& words) {
  Answer answer;
  FILE* const pipe = popen(("./limpid " + words + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return answer;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) {
    answer.text += static_cast<char>(c);
  }
  answer.status = pclose(pipe);
  return answer;
}

// Whether all of these words are in the text; says which are not.
bool has_all(const std::string& text, std::initializer_list<std::string> wanted) {
  bool all = true;
  for (const std::string& each : wanted) {
    if (text.find(each) != std::string::npos) continue;
    std::printf("missing: %s\n", each.c_str());
    all = false;
  }
  return all;
}

// Looks at a device for two seconds: it has to be read, and never pushed.
bool look(ReferenceDevice& model, UhidDevice& plugged, const std::string& more) {
  const HidIdentity& identity = model.identity();
  char id[200];
  std::snprintf(id, sizeof id, "%04x:%04x:%s", identity.vendor, identity.product,
                identity.serial.c_str());
  const Answer answer =
      ask_program(std::string("devices look ") + id + " --record /tmp/look.h5 --force --seconds 2");
  std::printf("%s", answer.text.c_str());
  bool well = answer.status == 0 && has_all(answer.text, {id, "got no force", more});
  plugged.with([&](Time) {
    const double largest = model.forces().largest();
    std::printf("%s: %zu commands, largest torque %g, %zu violations\n", identity.name.c_str(),
                model.forces().samples().size(), largest, model.violations().size());
    well = well && largest == 0 && model.violations().empty();
  });
  return well;
}

}  // namespace

int main() {
  SpaceMouseModel mouse;
  PidJoystickModel joystick;
  RawDeviceModel raw;
  raw.hand().axis(0).path = [](double t) { return 0.2 * std::sin(6 * t); };
  UhidDevice a(mouse), b(joystick), c(raw);
  const Answer answer = ask_program("devices");
  std::printf("%s", answer.text.c_str());
  bool all = answer.status == 0;
  for (const ReferenceDevice* device :
       {static_cast<const ReferenceDevice*>(&mouse), static_cast<const ReferenceDevice*>(&joystick),
        static_cast<const ReferenceDevice*>(&raw)}) {
    const HidIdentity& identity = device->identity();
    all = has_all(answer.text, {identity.name, ":" + identity.serial}) && all;
  }
  // The raw one moves one joint of three.
  all = look(raw, c, "shoulder never moved") && all;
  all = look(joystick, b, "joints") && all;
  return all ? 0 : 1;
}
