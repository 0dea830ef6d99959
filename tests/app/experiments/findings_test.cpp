// Results of an identification, and their comparison with the next one's.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "app/experiments/identification.h"
#include "app/experiments/identify_report.h"
#include "devices/files/urdf_file.h"
#include "devices/identify/unlike_device.h"
#include "tests/support/built_in.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

using testing::HasSubstr;

ArmDescription paddle() { return read_urdf(test::assets_dir() / "devices/paddle.urdf"); }

Identification identified(const ArmDescription& truth, double scale, double load) {
  IdentifyRequest order;
  order.guess = paddle();
  order.load = load;
  const Unlikeness bench{.encoder_step = 1e-4, .delay = 1, .torque_scale = scale};
  const auto run = [&](const ArmDescription& arm) {
    UnlikeDevice device(arm, bench);
    IdentifyProgress progress;
    return simulate_identification(device, order.guess, order.plan, progress);
  };
  return identification("a paddle", order, run(truth),
                        load > 0 ? run(loaded(truth, load)) : IdentifyRun{});
}

ArmDescription with_friction(double friction) {
  ArmDescription arm = paddle();
  arm.joints[0].friction = friction;
  return arm;
}

TEST(Identification, IsInTheTorquesThatTheMotorsGive) {
  const ArmDescription truth = with_friction(0.02);
  const Identification done = identified(truth, 1.25, 0.03);
  ASSERT_TRUE(done.torque_scale);
  EXPECT_NEAR(done.torque_scale->value, 1.25, 0.03);
  EXPECT_NEAR(done.found.joints[0].coulomb.value, 0.02, 0.001);
  EXPECT_NEAR(profile_of(done).torque_scale, 1.25, 0.03);
  const Identification told = identified(truth, 1.25, 0);
  EXPECT_FALSE(told.torque_scale);
  EXPECT_NEAR(told.found.joints[0].coulomb.value, 0.02 / 1.25, 0.001);
}

TEST(Findings, AreReadAsTheyWereWritten) {
  const Identification done = identified(with_friction(0.02), 1, 0);
  const auto again = read_findings(findings_text(done, R"({"more": 1})"));
  ASSERT_TRUE(again);
  ASSERT_EQ(again->joints.size(), 1U);
  for (const FindingInfo& info : kFindings) {
    EXPECT_EQ((again->joints[0].*info.field).value, (done.found.joints[0].*info.field).value);
    EXPECT_EQ((again->joints[0].*info.field).deviation,
              (done.found.joints[0].*info.field).deviation);
  }
  EXPECT_EQ(again->delay.value, done.found.delay.value);
  for (const char* text : {"", "{}", "[1", R"({"delay": 1, "joints": 2})"}) {
    EXPECT_FALSE(read_findings(text)) << text;
  }
}

TEST(Findings, SayWhatHasChangedAndOnlyThat) {
  const auto before = read_findings(findings_text(identified(with_friction(0.02), 1, 0)));
  for (const Drift& d : drift(*before, identified(with_friction(0.02), 1, 0))) {
    EXPECT_FALSE(d.certain) << d.what;
  }
  int changed = 0;
  for (const Drift& d : drift(*before, identified(with_friction(0.024), 1, 0))) {
    if (!d.certain) continue;
    ++changed;
    EXPECT_EQ(d.what, "paddle friction");
    EXPECT_NEAR(d.now.value - d.before.value, 4, 0.2) << d.unit;
  }
  EXPECT_EQ(changed, 1);
}

TEST(IdentifyReport, HoldsArmFiguresMotionAndWhatHasChanged) {
  const test::TempDir dir;
  const auto before = read_findings(findings_text(identified(with_friction(0.02), 1, 0)));
  const Identification done = identified(with_friction(0.03), 1, 0.03);
  write_motion(done.bare, dir / kMotionFile);
  write_motion(done.with_load, dir / kLoadedMotionFile);
  write_identification(done, before, dir / "");
  std::ifstream page(dir / "report.html");
  const std::string html{std::istreambuf_iterator<char>(page), {}};
  EXPECT_THAT(html, HasSubstr("Since last time"));
  EXPECT_THAT(html, HasSubstr("changed</td>"));
  EXPECT_THAT(html, HasSubstr("a load of 0.03 kg at the tip"));
  EXPECT_NEAR(read_urdf(dir / "identified.urdf").joints[0].friction, 0.03, 0.003);
  for (const char* name :
       {"identified.json", "identified.csv", "motion.csv", "motion-with-load.csv"}) {
    EXPECT_TRUE(std::filesystem::exists(dir / name)) << name;
  }
}

TEST(IdentifyText, HasTheDigitsThatTheDeviationLeaves) {
  EXPECT_EQ(text_of({0.0012348, 0.00002}, 1e-3), "1.235 +- 0.020");
  EXPECT_EQ(text_of({12.3456, 0.2}, 1), "12.35 +- 0.20");
  EXPECT_EQ(text_of({-0.00001, 0.1}, 1), "0.00 +- 0.10");
  EXPECT_EQ(text_of({250, 30}, 1), "250 +- 30");
}

// A value has the digits that its deviation leaves, and no deviation is shown as zero.
TEST(FoundText, ShowsNoDeviationSmallerThanItIs) {
  EXPECT_EQ(text_of({0.01234, 0.0021}, 1), "0.0123 +- 0.0021");
  EXPECT_EQ(text_of({0.01234, 0.0000031}, 1), "0.0123 +- 0.0001");
  EXPECT_EQ(text_of({12.34, 0.0021}, 1), "12.34 +- 0.01");
  EXPECT_EQ(text_of({1234.5, 87}, 1), "1235 +- 87");
  EXPECT_EQ(text_of({0.001, 0.0002}, 1e-3), "1.00 +- 0.20");
  EXPECT_EQ(text_of({-0.00001, 0.0002}, 1), "0.0000 +- 0.0002") << "no -0";
}

}  // namespace
}  // namespace limpid
