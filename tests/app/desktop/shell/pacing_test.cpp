#include "app/desktop/shell/pacing.h"

#include <gtest/gtest.h>

#include <array>

namespace limpid {
namespace {

using std::chrono::milliseconds;

TEST(Pacing, BelievesADisplayThatMakesExchangesWait) {
  const double refresh = 1.0 / 60;
  EXPECT_TRUE(display_paces(std::array{0.0166, 0.0167, 0.0168}, refresh));
  EXPECT_FALSE(display_paces(std::array{0.0166, 0.0021, 0.0168}, refresh));
  EXPECT_FALSE(display_paces(std::array{0.0166, 0.0167}, 0));
  EXPECT_FALSE(display_paces({}, refresh));
}

TEST(Liveliness, DrawsAfterATouchAndNowAndThenWithoutOne) {
  Liveliness window;
  const SteadyClock::time_point start{};
  const auto at = [&](int ms) { return start + milliseconds(100'000 + ms); };
  window.drawn(at(0));
  EXPECT_FALSE(window.due(at(16)));
  EXPECT_TRUE(window.due(at(600)));
  window.touch(at(600));
  window.drawn(at(600));
  EXPECT_TRUE(window.due(at(616)));
  window.drawn(at(1400));
  EXPECT_FALSE(window.due(at(1416)));
}

}  // namespace
}  // namespace limpid
