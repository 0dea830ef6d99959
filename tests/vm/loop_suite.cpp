// The loop's tests in the virtual machine, or, with an argument, the program that some of them
// kill.
#include <gtest/gtest.h>
#include <sys/prctl.h>

#include "app/interrupt.h"
#include "tests/vm/desk.h"

namespace {

// Pushes whatever leans on the gate, until it is interrupted or killed.
template <class Model>
int drive() {
  using namespace limpid;
  LiveLoop loop({});
  Controls controls;
  loop.open(test::joystick_arm(), test::joystick_gate(), controls.parameters,
            test::Desk<Model>::connect());
  catch_interrupts();
  loop.arm();
  for (; !interrupted; test::wait(std::chrono::milliseconds(16))) loop.set(controls);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  prctl(PR_SET_TIMERSLACK, 1);
  const std::string word = argc > 1 ? argv[1] : "";
  if (word == "drive-pid") return drive<limpid::test::PidJoystickModel>();
  if (word == "drive-raw") return drive<limpid::test::RawDeviceModel>();
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
