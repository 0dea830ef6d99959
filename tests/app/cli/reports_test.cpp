// Reports in lines and in JSON: each fact that was found is in both, in the unit that is named.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "app/cli/in_hands_text.h"
#include "app/cli/look_report.h"
#include "app/cli/measured_text.h"
#include "app/cli/outcome_text.h"
#include "tests/app/cli/said.h"

namespace limpid {
namespace {

using nlohmann::ordered_json;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

// A joint that turns and one that slides.
LookedDevice stick() {
  LookedDevice device;
  device.traits.name = "Stick";
  device.traits.id = "stick:1";
  device.traits.dof = 2;
  device.traits.pushes = true;
  device.traits.rate = 1000;
  device.traits.lower = {-0.5, -1};
  device.traits.upper = {0.25, 1};
  device.traits.resolution = {1e-3, 1e-3};
  device.traits.made_by = "limpid-vendor";
  device.kind = "a test";
  device.arm_why = "nobody knows another";
  device.arm.name = "two";
  device.arm.joints.resize(2);
  device.arm.joints[0].name = "turns";
  device.arm.joints[1].name = "slides";
  device.arm.joints[1].kind = Joint::Kind::prismatic;
  return device;
}

// A second of readings: the first joint goes from 0 to 0.4, beyond its range; the other one from
// `slid` to it.
std::unique_ptr<DeviceSeen> seen(const LookedDevice& device, double slid, bool complains = true) {
  auto all = std::make_unique<DeviceSeen>();
  DeviceReading reading;
  for (int k = 0; k <= 1000; ++k) {
    ++reading.count;
    reading.x[0] = 0.1 * (k / 250);
    reading.x[1] = k < 500 ? 0 : slid;
    if (complains) {
      reading.hand = k <= 750;
      reading.fault = k > 900;
      reading.calibrated = k > 250;
      reading.no_force = k > 500 ? NoForce::warm : NoForce::none;
      reading.buttons = k == 40 ? 5u : 0u;
      reading.warmth = 0.5f;
    }
    all->take(reading, true, device.traits, 100 + 1e-3 * k);
  }
  return all;
}

TEST(LookReport, SaysInLinesWhatWasSeen) {
  const LookedDevice device = stick();
  const std::string text = look_text(device, *seen(device, 0.2));
  for (const char* line :
       {"device +Stick, a test, stick:1\n", "arm +nobody knows another\n",
        "driven by +limpid-vendor\n", "motors +the device has motors; the motors got no force\n",
        "axes +as the device reports them; not checked yet\n", "joints +2\n",
        "readings +1001, 1000 per second .1000 declared.; time between two readings: median "
        "1.0[0-9] ms",
        "turns .rad. +0 to 0.4 +-0.5 to 0.25 +0.1 +0.001 ",
        "range +turns left the range that the device declares\n", "buttons +pressed: 1, 3\n",
        "hand +nobody held the switch for 0.25 s\n", "calibration +not calibrated for 0.25 s\n",
        "fault +reported for 0.10 s\n", "device.s force off +0.50 s: ",
        "warmth +at most 50 % of the hottest motor.s thermal limit"}) {
    EXPECT_THAT(text, ContainsRegex(line));
  }
  EXPECT_THAT(text, Not(HasSubstr("never moved")));
  EXPECT_THAT(text, Not(HasSubstr("slides left the range")));
  EXPECT_THAT(text, Not(HasSubstr("wrong readings")));
  EXPECT_THAT(text, HasSubstr(device_words({.no_force = NoForce::warm})));
}

TEST(LookReport, SaysThatNothingWasWrong) {
  LookedDevice device = stick();
  device.traits.pushes = false;
  device.traits.rate = 0;
  device.traits.made_by.clear();
  device.traits.upper[0] = 0.4;
  device.checked = true;
  const std::string text = look_text(device, *seen(device, 0, false));
  for (const char* line :
       {"motors +the device has no motors\n", "axes +adjusted as found in the check of the axes\n",
        "range +slides never moved: move each joint to its ends\n",
        "buttons +no button was pressed\n",
        "hand +held the switch all the time, or the device has no switch\n",
        "calibration +no problem reported\n", "fault +none\n"}) {
    EXPECT_THAT(text, ContainsRegex(line));
  }
  for (const char* none : {"driven by", "declared)", "left the range", "turns never moved",
                           "device's force off", "warmth", "wrong readings"}) {
    EXPECT_THAT(text, Not(HasSubstr(none)));
  }
}

// Positions farther than a radian beyond the range cannot be.
TEST(LookReport, CountsReadingsThatCannotBe) {
  const LookedDevice device = stick();
  const auto all = seen(device, 0.2, false);
  DeviceReading wrong;
  wrong.count = 2000;
  wrong.x[0] = 50;
  all->take(wrong, true, device.traits, 102);
  EXPECT_THAT(
      look_text(device, *all),
      ContainsRegex("wrong readings +1 readings were impossible, and are not in the table"));
  EXPECT_EQ(look_json(device, *all)["wrong_readings"], 1);
}

TEST(LookReport, HasTheSameInJson) {
  const LookedDevice device = stick();
  const ordered_json json = look_json(device, *seen(device, 0.2));
  EXPECT_EQ(json["id"], "stick:1");
  EXPECT_EQ(json["name"], "Stick");
  EXPECT_EQ(json["kind"], "a test");
  EXPECT_EQ(json["driven_by"], "limpid-vendor");
  EXPECT_EQ(json["arm"], "two");
  EXPECT_EQ(json["arm_why"], "nobody knows another");
  EXPECT_EQ(json["axes_checked"], false);
  EXPECT_EQ(json["pushes"], true);
  EXPECT_EQ(json["force_given"], false);
  EXPECT_EQ(json["readings"], 1001);
  EXPECT_NEAR(json["rate_hz"].get<double>(), 1000, 0.1);
  EXPECT_EQ(json["declared_rate_hz"], 1000);
  EXPECT_NEAR(json["median_gap_s"].get<double>(), 1e-3, 1e-4);
  EXPECT_NEAR(json["worst_gap_s"].get<double>(), 1e-3, 1e-4);
  EXPECT_EQ(json["gone"], false);
  EXPECT_EQ(json["buttons"], (std::vector<int>{1, 3}));
  EXPECT_NEAR(json["without_hand_s"].get<double>(), 0.25, 2e-3);
  EXPECT_NEAR(json["uncalibrated_s"].get<double>(), 0.25, 2e-3);
  EXPECT_NEAR(json["fault_s"].get<double>(), 0.1, 2e-3);
  EXPECT_NEAR(json["no_force_s"][static_cast<std::size_t>(NoForce::warm)].get<double>(), 0.5, 2e-3);
  EXPECT_EQ(json["warmth"], 0.5);
  EXPECT_EQ(json["wrong_readings"], 0);
  ASSERT_EQ(json["joints"].size(), 2u);
  const ordered_json &turns = json["joints"][0], &slides = json["joints"][1];
  EXPECT_EQ(turns["name"], "turns");
  EXPECT_EQ(turns["unit"], "rad");
  EXPECT_EQ(slides["unit"], "m");
  EXPECT_NEAR(turns["least"].get<double>(), 0, 1e-12);
  EXPECT_NEAR(turns["most"].get<double>(), 0.4, 1e-12);
  EXPECT_EQ(turns["declared_least"], -0.5);
  EXPECT_EQ(turns["declared_most"], 0.25);
  EXPECT_NEAR(turns["smallest_step"].get<double>(), 0.1, 1e-12);
  EXPECT_EQ(turns["declared_step"], 1e-3);
  // A slide's unit of the coordinate is a length.
  EXPECT_NEAR(slides["most"].get<double>(), 0.2 * kSlideUnit, 1e-12);
  EXPECT_NEAR(slides["declared_most"].get<double>(), kSlideUnit, 1e-12);
  LookedDevice bare = device;
  bare.traits.made_by.clear();
  bare.traits.lower.clear();
  const ordered_json less = look_json(bare, DeviceSeen());
  EXPECT_TRUE(less["driven_by"].is_null());
  EXPECT_TRUE(less["joints"][0]["least"].is_null()) << "nothing was seen";
  EXPECT_TRUE(less["joints"][0]["declared_least"].is_null());
  EXPECT_TRUE(less["joints"][0]["noise"].is_null());
}

// A value that is no number on an arm for which nothing is promised.
TEST(OutcomeReport, SaysWhatCouldNotBeMeasured) {
  Outcome outcome;
  outcome.arm = "stick";
  outcome.checks.push_back(at_most("energy", -std::nan(""), 0.1));
  outcome.checks.back().unjudged = "nothing is promised";
  testing::internal::CaptureStdout();
  print_outcome("passivity", outcome);
  EXPECT_EQ(testing::internal::GetCapturedStdout(),
            "passivity, on stick: measured\n"
            "  ----  energy: not measurable (promised for the built-in arm: <= 0.1)\n");
}

MeasuredHand a_hand() {
  MeasuredHand hand;
  hand.grip.measured = true;
  hand.grip.stiffness = {312, 12};
  hand.grip.damping = {2.5, 0.5};
  hand.grip.mass = {0.02, 0.004};
  hand.grip.moved = 0.0031;
  hand.grip.touched = 0.25;
  hand.grip.work = 0.0042;
  hand.eta_min = {0.74, 0.70, 0.78};
  return hand;
}

TEST(MeasuredReport, HasEveryNumberOfAHand) {
  const ordered_json json = measured_json(a_hand());
  const ordered_json expected{{"known", true},
                              {"why_not", nullptr},
                              {"stiffness", {{"value", 312}, {"bound", 12}}},
                              {"damping", {{"value", 2.5}, {"bound", 0.5}}},
                              {"mass", {{"value", 0.02}, {"bound", 0.004}}},
                              {"eta_min", {{"value", 0.74}, {"least", 0.70}, {"most", 0.78}}},
                              {"moved", 0.0031},
                              {"touched", 0.25},
                              {"work", 0.0042}};
  EXPECT_EQ(nlohmann::json(json), nlohmann::json(expected)) << json.dump(1);
  testing::internal::CaptureStdout();
  print_measured(a_hand());
  std::fflush(stdout);
  EXPECT_THAT(
      testing::internal::GetCapturedStdout(),
      AllOf(
          HasSubstr("the grip, measured         known; the bounds are right for 95 of 100 grips\n"),
          HasSubstr("stiffness                  312 \xC2\xB1 12 N/m\n"),
          HasSubstr("given to the hand          4.2 mJ by the measuring force; the tip "
                    "moved up to 3.1 mm\n")));
}

TEST(MeasuredReport, SaysWhyAHandIsNotKnown) {
  MeasuredHand hand;
  hand.grip.unknown = "it let go";
  const ordered_json json = measured_json(hand);
  EXPECT_EQ(json["known"], false);
  EXPECT_EQ(json["why_not"], "it let go");
  for (const char* key : {"stiffness", "damping", "mass", "eta_min"}) {
    EXPECT_TRUE(json.contains(key) && json[key].is_null()) << key;
  }
  testing::internal::CaptureStdout();
  print_measured(hand);
  std::fflush(stdout);
  EXPECT_EQ(testing::internal::GetCapturedStdout(),
            "the grip, measured         not known: it let go\n");
}

// Looks up a key with points in it.
const ordered_json* at(const ordered_json& json, std::string key) {
  const ordered_json* here = &json;
  while (true) {
    const std::size_t end = key.find('.');
    const auto found = here->find(key.substr(0, end));
    if (found == here->end()) return nullptr;
    here = &*found;
    if (end == std::string::npos) return here;
    key.erase(0, end + 1);
  }
}

// Every number of the report that has a unit is named with it, and no other.
TEST(MeasuredReport, NamesUnitsOfWhatIsThere) {
  ordered_json all;
  all["measured_grip"] = measured_json(a_hand());
  const ordered_json units = measured_units();
  EXPECT_EQ(units.size(), 8u);
  for (const auto& [key, unit] : units.items()) {
    const ordered_json* value = at(all, key);
    ASSERT_NE(value, nullptr) << key;
    EXPECT_TRUE(value->is_number()) << key;
  }
  EXPECT_EQ(units["measured_grip.stiffness.value"], "N/m");
  EXPECT_EQ(units["measured_grip.damping.bound"], "N s/m");
  EXPECT_EQ(units["measured_grip.mass.value"], "kg");
  EXPECT_EQ(units["measured_grip.work"], "J");
  EXPECT_EQ(units["measured_grip.moved"], "m");
}

InHands hands() {
  InHands found;
  found.range = {100, 3000};
  found.damping = 2;
  found.mass = 0.1;
  found.eta_min = 0.7421;
  found.eta_min_any = 0.593;
  for (LawInHands& law : found.laws) {
    law.in_range = {.up_to = 1234.0, .hand = 300.0, .why = "by theory"};
    law.in_any_hand = {.up_to = std::nullopt, .hand = {}, .why = "nobody knows"};
    law.two_port_why = "reckoned";
  }
  found.laws[1].in_range = {
      .up_to = std::numeric_limits<double>::infinity(), .hand = {}, .why = "a"};
  found.laws[1].in_any_hand = {.up_to = 0.0, .hand = {}, .why = "b"};
  found.laws[2].two_port = {.least = 0.5, .frequency = 12, .fails_from = 7.5};
  found.laws[3].two_port = {.least = 1.5, .frequency = 3, .fails_from = {}};
  found.sampled = {"Colgate", "source one", "rule one", 2000.0};
  found.stepped = {"Abbott", "source two", "rule two", std::numeric_limits<double>::infinity()};
  return found;
}

TEST(HandsReport, SaysOfEveryLawWhatIsKnown) {
  std::vector<CouplingKind> told;
  for (std::uint8_t i = 0; i < 4; ++i) told.push_back(static_cast<CouplingKind>(i));
  testing::internal::CaptureStdout();
  print_in_hands(hands(), told);
  std::fflush(stdout);
  const std::string text = testing::internal::GetCapturedStdout();
  const auto key = [](std::uint8_t i) { return std::string(kLawKeys[i]); };
  for (const std::string& line :
       {std::string("for hands with 100 to 3000 N/m, 2 N s/m and 0.1 kg\n"),
        "stable walls, " + key(0) + " +1234 N/m  by theory; the hand of 300 N/m sets this limit\n",
        "stable walls, " + key(1) + " +every wall  a\n",
        "passive walls, " + key(0) + " +not known  nobody knows\n",
        "passive walls, " + key(1) + " +none  b\n",
        std::string("eta, proposed +0.7421  the smallest eta that is stable in all these hands\n"),
        std::string("Colgate +2000 N/m  rule one\n +source one\n"),
        std::string("Abbott +no bound  rule two\n +source two\n"),
        std::string("eta_min, proposed +0.5930  equation .25.\n"),
        key(2) + " +lowest value 0.5 at 12 Hz: not fulfilled from 7.5 Hz upwards; reckoned\n",
        key(3) + " +lowest value 1.5 at 3 Hz: fulfilled; reckoned\n", key(0) + " +reckoned\n"}) {
    EXPECT_THAT(text, ContainsRegex(line));
  }
}

TEST(HandsReport, HasTheSameInJson) {
  const ordered_json json = in_hands_json(hands());
  EXPECT_EQ(json["from"], 100);
  EXPECT_EQ(json["to"], 3000);
  EXPECT_EQ(json["damping"], 2);
  EXPECT_EQ(json["mass"], 0.1);
  EXPECT_EQ(json["eta_min"], 0.7421);
  EXPECT_EQ(json["colgate_schenkel"]["wall"], 2000);
  EXPECT_EQ(json["colgate_schenkel"]["rule"], "rule one");
  EXPECT_EQ(json["colgate_schenkel"]["source"], "source one");
  EXPECT_TRUE(json["abbott_okamura"]["wall"].is_null()) << "no bound";
  const auto law = [&](std::size_t i) { return json[kLawKeys[i]]; };
  for (std::size_t i = 0; i < kLaws; ++i) EXPECT_EQ(law(i)["llewellyn_by"], "reckoned");
  EXPECT_EQ(law(0)["stable"]["wall"], 1234);
  EXPECT_EQ(law(0)["stable"]["hand"], 300);
  EXPECT_EQ(law(0)["stable"]["every_wall"], false);
  EXPECT_EQ(law(0)["stable"]["by"], "by theory");
  EXPECT_TRUE(law(0)["passive"]["every_wall"].is_null()) << "not known";
  EXPECT_EQ(law(1)["stable"]["every_wall"], true);
  EXPECT_TRUE(law(1)["stable"]["wall"].is_null());
  EXPECT_EQ(law(1)["passive"]["wall"], 0);
  EXPECT_TRUE(law(1)["llewellyn"].is_null());
  EXPECT_EQ(law(2)["llewellyn"]["least"], 0.5);
  EXPECT_EQ(law(2)["llewellyn"]["frequency"], 12);
  EXPECT_EQ(law(2)["llewellyn"]["fails_from"], 7.5);
  EXPECT_TRUE(law(3)["llewellyn"]["fails_from"].is_null());
}

}  // namespace
}  // namespace limpid
