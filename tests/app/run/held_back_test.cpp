// Sentences of a run's summary on what was held back: force, and mechanisms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "app/run/summary.h"
#include "core/coupling/laws.h"
#include "tests/support/built_in.h"

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

TEST(HeldBack, AreMechanismsThatStoodStillOrTurnedLess) {
  const RowLayout layout(3, 2);
  std::vector<double> row(static_cast<std::size_t>(layout.stride()));
  Summary quiet(layout), moved(layout);
  for (int k = 0; k < 9; ++k) {
    quiet.add(row);
    layout.in(std::span<double>(row), Column::objects_stood_still)[0] = k / 4;
    layout.in(std::span<double>(row), Column::objects_turned_less)[0] = k;
    moved.add(row);
    layout.in(std::span<double>(row), Column::objects_stood_still)[0] = 0;
    layout.in(std::span<double>(row), Column::objects_turned_less)[0] = 0;
  }
  EXPECT_THAT(quiet.text(), Not(HasSubstr("objects turned less")));
  EXPECT_THAT(moved.text(), HasSubstr("objects stood still      2 ticks"));
  EXPECT_THAT(moved.text(), HasSubstr("objects turned less      8 ticks"));
}

// An arm whose second motor has a model warms up by a hundredth in each tick of 2 ms.
std::string warmed(bool has_model, double reported) {
  ArmDescription arm = test::omni();
  if (has_model) arm.joints[1].continuous = 0.1;
  const RowLayout layout(3);
  Summary summary(layout, arm);
  std::vector<double> row(static_cast<std::size_t>(layout.stride()));
  for (int k = 0; k < 76; ++k) {
    layout.in(std::span<double>(row), Column::time)[0] = 2e-3 * k;
    layout.in(std::span<double>(row), Column::motor_warmth)[0] = reported;
    layout.in(std::span<double>(row), Column::motor_warmth)[1] = 0.01 * k;
    summary.add(row);
  }
  return summary.text();
}

TEST(HeldBack, IsTorqueOfMotorsThatAreMoreThanHalfAsWarmAsTheyMayBe) {
  const std::string text = warmed(true, 0.9);
  EXPECT_THAT(text,
              HasSubstr("warmth of the motors     at most 75 % of the limit for hours of use ("));
  EXPECT_THAT(text,
              HasSubstr(test::omni().joints[1].name + "); the full torque was not available for"));
  EXPECT_THAT(text, HasSubstr("for 0.050 s")) << "ticks 51 to 75";
  EXPECT_THAT(warmed(false, 0.9), Not(HasSubstr("warmth"))) << "the file limits no motor";
}

}  // namespace
}  // namespace limpid
