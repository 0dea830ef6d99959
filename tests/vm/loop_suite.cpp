// Runs the loop's tests in the virtual machine; with an argument, is the program that some of them
// kill.
#include <gtest/gtest.h>
#include <sys/prctl.h>

#include <optional>
#include <string>

#include "app/base/interrupt.h"
#include "tests/vm/desk.h"
#include "tests/vm/models.h"

namespace {

// Holds the device and pushes when it leans on the gate, until interrupted or killed.
template <class Model>
int drive() {
  using namespace limpid;
  LiveLoop loop({});
  Controls controls;
  loop.open(test::joystick_arm(), test::joystick_gate().scene, controls.parameters(),
            test::Desk<Model>::connect());
  catch_interrupts();
  loop.arm();
  for (; !interrupted; test::wait(std::chrono::milliseconds(16))) loop.set(controls);
  return 0;
}

template <class... Model>
std::optional<int> drive_named(const std::string& word, testing::Types<Model...>) {
  std::optional<int> result;
  const auto try_one = [&]<class One>(One*) {
    if (word == std::string("drive-") + limpid::test::kName<One>) result = drive<One>();
  };
  (try_one(static_cast<Model*>(nullptr)), ...);
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  prctl(PR_SET_TIMERSLACK, 1);
  if (argc > 1) {
    if (const auto driven = drive_named(argv[1], limpid::test::Models{})) return *driven;
  }
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
