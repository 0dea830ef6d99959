// The loop's tests in the virtual machine, or, with an argument, the program that some of them
// kill.
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <unistd.h>

#include "tests/vm/desk.h"

namespace {

// Pushes whatever leans on the gate, until it is killed.
template <class Model>
[[noreturn]] void drive() {
  using namespace limpid;
  LiveLoop loop({});
  Controls controls;
  loop.open(test::joystick_arm(), test::joystick_gate(), controls.parameters,
            test::Desk<Model>::connect());
  loop.set(controls);
  while (true) pause();
}

}  // namespace

int main(int argc, char** argv) {
  prctl(PR_SET_TIMERSLACK, 1);
  const std::string word = argc > 1 ? argv[1] : "";
  if (word == "drive-pid") drive<limpid::test::PidJoystickModel>();
  if (word == "drive-raw") drive<limpid::test::RawDeviceModel>();
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
