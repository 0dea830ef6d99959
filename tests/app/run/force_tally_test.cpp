#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/run/summary.h"
#include "core/tick/arming.h"

namespace limpid {
namespace {

using testing::HasSubstr;
using testing::Not;

// Tally of so many ticks of 2 ms in each state, in this order.
std::string tally(std::initializer_list<std::pair<ForceState, int>> states) {
  const RowLayout layout(3);
  ForceTally tally(layout);
  std::vector<double> row(static_cast<std::size_t>(layout.stride()));
  for (const auto& [state, ticks] : states) {
    layout.in(std::span<double>(row), Column::force_state)[0] = static_cast<double>(state);
    for (int k = 0; k < ticks; ++k) tally.add(row);
  }
  return tally.text(0.002);
}

TEST(ForceTally, SaysThatTheForceWasOnAllTheTime) {
  const std::string text = tally({{ForceState::on, 100}});
  EXPECT_THAT(text, HasSubstr("on all the time"));
  EXPECT_THAT(text, Not(HasSubstr("without")));
}

TEST(ForceTally, OfNoRowsSaysThatNothingWasRecorded) {
  const std::string text = tally({});
  EXPECT_THAT(text, HasSubstr("nothing was recorded"));
  EXPECT_THAT(text, Not(HasSubstr("all the time")));
}

TEST(ForceTally, HasTheSecondsWithoutForceAndEachReason) {
  const std::string text = tally({{ForceState::on, 500},
                                  {ForceState::off, 250},
                                  {ForceState::on, 100},
                                  {ForceState::lost, 50},
                                  {ForceState::off, 50},
                                  {ForceState::too_fast, 50}});
  EXPECT_THAT(text, HasSubstr("0.800 s of 2.000 s"));
  EXPECT_THAT(text, HasSubstr("0.600 s         force off: not armed"));
  EXPECT_THAT(text, HasSubstr("0.100 s         force off: the device is not connected"));
  EXPECT_THAT(text, HasSubstr("0.100 s         force held back: the device moves too fast"));
}

}  // namespace
}  // namespace limpid
