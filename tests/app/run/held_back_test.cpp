// Sentences of a run's summary on force that the account of energy held back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "app/run/summary.h"
#include "core/coupling/laws.h"

namespace limpid {
namespace {

using testing::HasSubstr;
using testing::Not;

// Summary of 30 ticks, a third of each with all, half and none of the walls' force and of torque.
std::string summary(CouplingKind kind, bool touches) {
  const RowLayout layout(3);
  Summary summary(layout);
  std::vector<double> row(static_cast<std::size_t>(layout.stride()));
  const auto set = [&](Column c, double value) { layout.in(std::span<double>(row), c)[0] = value; };
  set(Column::kind, static_cast<double>(kind));
  set(Column::contact_torque, touches ? 0.1 : 0);
  for (int k = 0; k < 30; ++k) {
    set(Column::governor, std::vector{1.0, 0.5, 0.0}.at(static_cast<std::size_t>(k / 10)));
    set(Column::torque_governor, k < 20 ? 1 : 0.5);
    summary.add(row);
  }
  return summary.text();
}

TEST(HeldBack, AreTicksInWhichTheAccountCutForce) {
  const std::string text = summary(CouplingKind::predictive, true);
  EXPECT_THAT(text, HasSubstr("walls held back in       20 ticks"));
  EXPECT_THAT(text, HasSubstr("torque held back in      10 ticks"));
}

TEST(HeldBack, AreNoWallsWhereNoneIsTouchedOrTheLawHoldsNoneBack) {
  EXPECT_THAT(summary(CouplingKind::predictive, false), Not(HasSubstr("walls held back")));
  EXPECT_THAT(summary(CouplingKind::tank, true), Not(HasSubstr("walls held back")));
}

}  // namespace
}  // namespace limpid
