// The examples of the library, run as they stand: what they say is what theory says.
#include <gtest/gtest.h>
#include <limpid/limpid.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <span>
#include <string>
#include <thread>

#include "tests/support/until.h"

// Their programs are functions here. All headers that they include stand above.
#define main run_example
namespace example_of_objects {
#include "app/library/examples/objects.cpp"
}
namespace example_of_own_loop {
#include "app/library/examples/own_loop.cpp"
}
namespace example_of_callbacks {
#include "app/library/examples/callback_device.cpp"
}
#undef main

namespace limpid {
namespace {

// Runs an example; returns what it said.
std::string said_by(const std::function<int()>& example, int status) {
  testing::internal::CaptureStdout();
  const int ended = example();
  std::fflush(stdout);
  std::string said = testing::internal::GetCapturedStdout();
  EXPECT_EQ(ended, status) << said;
  return said;
}

// The hand pushes the block by less than it goes itself, 3 cm to y = 25 mm; nothing pushes the
// ball.
TEST(LibraryExamples, PushABlockAndLeaveABallWhereItLies) {
  const std::string said = said_by(example_of_objects::run_example, 0);
  double block = 0, ball = 0, given = 0;
  ASSERT_EQ(std::sscanf(said.c_str(),
                        "the block moved from y = 20.0 mm to %lf mm, the ball lies at %lf mm\n"
                        "given to objects: %lf mJ",
                        &block, &ball, &given),
            3)
      << said;
  // The block's near side, 10 mm before its middle, is where the tip has pushed it, 25 mm at most.
  EXPECT_GT(block, 30);
  EXPECT_LT(block, 36);
  EXPECT_NEAR(ball, -30, 0.1);
  // Friction of 0.2 on 50 g along the way takes at least half of what is given.
  const double friction = 0.2 * 0.05 * 9.81 * 1e-3 * (block - 20);
  EXPECT_GT(given, 1e3 * 0.5 * friction);
  EXPECT_LT(given, 1e3 * 10 * friction);
}

// A slide of 100 g, a hand of 300 N/m that wants to be 2 cm in a wall of 1500 N/m.
TEST(LibraryExamples, RestWhereTwoSpringsInARowDo) {
  const std::string said = said_by(example_of_own_loop::run_example, 0);
  double deepest = 0, rest = 0, theory = 0, energy = 0;
  ASSERT_EQ(std::sscanf(said.c_str(),
                        "deepest point %lf mm, at rest %lf mm (theory of two springs: %lf mm), "
                        "E_c %lf mJ",
                        &deepest, &rest, &theory, &energy),
            4)
      << said;
  EXPECT_NEAR(theory, 1e3 * 300 * 0.02 / 1800, 0.006);
  EXPECT_NEAR(rest, theory, 0.05);
  EXPECT_GE(deepest, rest - 0.01);
  EXPECT_LT(deepest, 2 * theory) << "even without damping a step goes no deeper";
  EXPECT_LT(energy, 1) << "a law gives nothing";
}

// A busy computer may make ticks late, which ends the force; then it is tried again.
TEST(LibraryExamples, GetForceBehindCallbacks) {
  std::string said;
  int ended = 1;
  test::until([&] {
    testing::internal::CaptureStdout();
    ended = example_of_callbacks::run_example();
    std::fflush(stdout);
    said = testing::internal::GetCapturedStdout();
    return ended == 0;
  });
  EXPECT_EQ(ended, 0) << said;
  int readings = 0;
  double most = -1;
  const std::size_t at = said.find("readings, force ");
  ASSERT_NE(at, std::string::npos) << said;
  const std::string line = said.substr(said.rfind('\n', at) + 1);
  char force[80] = "";
  ASSERT_EQ(std::sscanf(line.c_str(), "%d readings, force %79[^,], at most %lf N m", &readings,
                        force, &most),
            3)
      << said;
  EXPECT_GT(readings, 500);
  EXPECT_LE(readings, 1010) << "one each millisecond of a second";
  EXPECT_GE(most, 0);
  EXPECT_LT(most, 1);
}

}  // namespace
}  // namespace limpid
