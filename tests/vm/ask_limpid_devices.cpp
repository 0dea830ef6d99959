// Plugs the three kinds of devices in and asks the program itself what it finds.
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

Answer ask_program() {
  Answer answer;
  FILE* const pipe = popen("./limpid devices 2>&1", "r");
  if (pipe == nullptr) return answer;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) {
    answer.text += static_cast<char>(c);
  }
  answer.status = pclose(pipe);
  return answer;
}

}  // namespace

int main() {
  SpaceMouseModel mouse;
  PidJoystickModel joystick;
  RawDeviceModel raw;
  const UhidDevice a(mouse), b(joystick), c(raw);
  const Answer answer = ask_program();
  std::printf("%s", answer.text.c_str());
  bool all = answer.status == 0;
  for (const ReferenceDevice* device :
       {static_cast<const ReferenceDevice*>(&mouse), static_cast<const ReferenceDevice*>(&joystick),
        static_cast<const ReferenceDevice*>(&raw)}) {
    const HidIdentity& identity = device->identity();
    for (const std::string& wanted : {identity.name, ":" + identity.serial}) {
      if (answer.text.find(wanted) != std::string::npos) continue;
      std::printf("missing: %s\n", wanted.c_str());
      all = false;
    }
  }
  return all ? 0 : 1;
}
