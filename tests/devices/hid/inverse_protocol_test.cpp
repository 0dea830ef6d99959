// Messages to the Haply Inverse Service and readings from its answers, against the messages in its
// documentation.
#include "devices/hid/inverse_protocol.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "devices/hid/hid_transport.h"
#include "tests/support/fake_hid.h"

namespace limpid {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using test::FakeHid;
using test::FakeTransport;

json device(const std::string& id, double x, double y, double z) {
  return {{"device_id", id},
          {"state",
           {{"cursor_position", {{"x", x}, {"y", y}, {"z", z}}},
            {"cursor_velocity", {{"x", 0}, {"y", 0}, {"z", 0}}},
            {"mode", "idle"}}},
          {"status",
           {{"calibrated", true},
            {"in_use", false},
            {"power_supply", true},
            {"ready", true},
            {"started", true}}}};
}

json message(const std::vector<json>& devices) {
  return {{"session_id", 7}, {"inverse3", devices}};
}

Report report(const std::string& text) {
  Report bytes{0};
  bytes.insert(bytes.end(), text.begin(), text.end());
  return bytes;
}
Report report(const json& value) { return report(value.dump()); }

struct AnInverse3 : testing::Test {
  void open(const json& list, const std::string& id = {}) {
    protocol.emplace(id);
    hid->send(report(list));
    protocol->open(transport);
  }
  void open() { open(message({device("049D", 0, -0.12, 0.16)})); }
  Decoded decode(const Report& bytes) { return protocol->decode(bytes, reading); }
  Decoded decode(const json& value) { return decode(report(value)); }
  // Messages sent for this torque at this time.
  std::vector<json> encode(const Vec3& torque, nanoseconds now) {
    std::vector<json> sent;
    protocol->encode({torque.data(), 3}, now, [&](std::span<const std::uint8_t> bytes) {
      sent.push_back(json::parse(bytes.begin() + 1, bytes.end()));
    });
    return sent;
  }
  std::string why_not(const json& list, const std::string& id = {}) {
    try {
      open(list, id);
    } catch (const HidError& error) {
      return error.what();
    }
    return "opened";
  }

  std::shared_ptr<FakeHid> hid = std::make_shared<FakeHid>();
  FakeTransport transport{hid};
  std::optional<InverseProtocol> protocol;
  DeviceReading reading;
};

json force(const std::string& id, double x, double y, double z) {
  const json values{{"x", x}, {"y", y}, {"z", z}};
  const json device{{"device_id", id}, {"commands", {{"set_cursor_force", {{"values", values}}}}}};
  return {{"inverse3", json::array({device})}};
}

TEST_F(AnInverse3, HasItsCursorForJoints) {
  open();
  const DeviceTraits& traits = protocol->traits();
  EXPECT_EQ(traits.dof, 3);
  EXPECT_TRUE(traits.pushes);
  EXPECT_TRUE(traits.guarded);
  EXPECT_THAT(traits.effort, testing::Each(testing::DoubleNear(0.4, 1e-12)));  // 4 N
  ASSERT_EQ(decode(message({device("049D", 0.01, -0.11, 0.162)})), Decoded::reading);
  EXPECT_NEAR(reading.x[0], 0.1, 1e-12);  // a slide's 1 is 10 cm
  EXPECT_NEAR(reading.x[1], -1.1, 1e-12);
  EXPECT_NEAR(reading.x[2], 1.62, 1e-12);
  EXPECT_TRUE(reading.hand);
  EXPECT_FALSE(reading.fault);
}

TEST_F(AnInverse3, IsTheOneThatIsNamedOrTheFirst) {
  const json both = message({device("049D", 0, 0, 0.1), device("04BA", 0.1, 0, 0.1)});
  open(both, "04BA");
  ASSERT_EQ(decode(both), Decoded::reading);
  EXPECT_NEAR(reading.x[0], 1, 1e-12);
  open(both);
  ASSERT_EQ(decode(both), Decoded::reading);
  EXPECT_NEAR(reading.x[0], 0, 1e-12);
  EXPECT_THAT(inverse_ids(report(both)), testing::ElementsAre("049D", "04BA"));
}

TEST_F(AnInverse3, ThatIsNotThereIsRefusedWithTheReason) {
  EXPECT_THAT(why_not(message({})), testing::HasSubstr("no Inverse3"));
  EXPECT_THAT(why_not(message({device("049D", 0, 0, 0.1)}), "04BA"), testing::HasSubstr("04BA"));
  EXPECT_THAT(why_not(json::array()), testing::HasSubstr("3.1 to 3.5"));
  EXPECT_THAT(why_not(json("hello")), testing::HasSubstr("does not list"));
  protocol.emplace("");
  EXPECT_THROW(protocol->open(transport), HidError) << "a silent service";
}

TEST_F(AnInverse3, ThatItsServiceTurnsOrScalesIsRefused) {
  const auto with = [&](const char* part, const json& what) {
    json one = device("049D", 0, 0, 0.1);
    one[part].merge_patch(what);
    return why_not(message({one}));
  };
  const json scale{{"scale", {{"x", 2}, {"y", 2}, {"z", 2}}}};
  EXPECT_THAT(with("config", {{"basis", {{"permutation", "XZY"}}}}), testing::HasSubstr("XZY"));
  EXPECT_THAT(with("config", {{"preset", "arm_front_centered"}}), testing::HasSubstr("arm_front"));
  EXPECT_THAT(with("config", {{"mount", scale}}), testing::HasSubstr("scaled"));
  EXPECT_THAT(with("config", {{"mount", {{"transform", scale}}}}), testing::HasSubstr("scaled"));
  EXPECT_THAT(with("state", {{"transform", scale}}), testing::HasSubstr("scaled"));
  const json at_first{{"position", {{"x", 0}, {"y", 0}, {"z", 0}}},
                      {"rotation", {{"w", 1}, {"x", 0}, {"y", 0}, {"z", 0}}},
                      {"scale", {{"x", 1}, {"y", 1}, {"z", 1}}}};
  EXPECT_EQ(
      with("config",
           {{"basis", {{"permutation", "XYZ"}}}, {"preset", "defaults"}, {"mount", at_first}}),
      "opened");
}

TEST_F(AnInverse3, TakesNothingFromMessagesThatMakeNoSense) {
  open();
  const Report good = report(message({device("049D", 0, -0.12, 0.16)}));
  const auto patched = [](const json& patch) {
    json one = device("049D", 0, -0.12, 0.16);
    one.merge_patch(patch);
    return report(message({one}));
  };
  const auto cursor = [&](const json& x) {
    return patched({{"state", {{"cursor_position", {{"x", x}}}}}});
  };
  const std::vector<Report> bad{
      {},
      {0},
      report(std::string("{")),
      report(std::string(good.begin() + 1, good.end() - 20)),
      report(std::string(R"({"inverse3":[{"device_id":"049D","state":{"cursor_position":)"
                         R"({"x":NaN,"y":0,"z":0}}}]})")),
      report(std::string(2000, '[')),
      report(json(3)),
      report(message({})),
      report(message({device("04BA", 0, -0.12, 0.16)})),
      cursor(nullptr),  // merge_patch: left out
      cursor("0.1"),
      cursor(true),
      cursor(1e300),
      cursor(-1.5),
      cursor(0.2),  // 20 cm from the reading before
      patched({{"state", nullptr}}),
      patched({{"state", 3}}),
      patched({{"device_id", 1181}}),
  };
  for (const Report& bytes : bad) {
    ASSERT_EQ(decode(good), Decoded::reading);
    const DeviceReading before = reading;
    EXPECT_EQ(decode(bytes), Decoded::unusable) << std::string(bytes.begin(), bytes.end());
    EXPECT_EQ(reading.x, before.x);
  }
}

TEST_F(AnInverse3, MayHaveMovedFarWhileItWasNotSeen) {
  open();
  encode(Vec3::Zero(), 1s);
  ASSERT_EQ(decode(message({device("049D", 0, -0.12, 0.16)})), Decoded::reading);
  encode(Vec3::Zero(), 1s + 1ms);
  EXPECT_EQ(decode(message({device("049D", 0.1, -0.12, 0.16)})), Decoded::unusable);
  encode(Vec3::Zero(), 1s + 50ms);
  EXPECT_EQ(decode(message({device("049D", 0.1, -0.12, 0.16)})), Decoded::reading);
}

TEST_F(AnInverse3, IsAtFaultUntilItsServiceSaysThatItIsWell) {
  open();
  for (const char* word : {"ready", "calibrated", "power_supply"}) {
    json one = device("049D", 0, -0.12, 0.16);
    one["status"][word] = false;
    ASSERT_EQ(decode(message({one})), Decoded::reading);
    EXPECT_TRUE(reading.fault) << word;
    one.erase("status");
    ASSERT_EQ(decode(message({one})), Decoded::reading);
    EXPECT_TRUE(reading.fault) << "nothing new is said of it";
    ASSERT_EQ(decode(message({device("049D", 0, -0.12, 0.16)})), Decoded::reading);
    EXPECT_FALSE(reading.fault);
  }
}

TEST_F(AnInverse3, HasTheButtonsOfItsGrip) {
  open();
  json all = message({device("049D", 0, -0.12, 0.16)});
  const json buttons{{"a", false}, {"b", true}, {"c", true}};
  const json grip{{"device_id", "61548"}, {"state", {{"buttons", buttons}}}};
  all["wireless_verse_grip"] = json::array({grip});
  ASSERT_EQ(decode(all), Decoded::reading);
  EXPECT_EQ(reading.buttons, 6u);
  EXPECT_EQ(reading.buttons_known, 7u);
  const json other{{"device_id", "3"}, {"state", {{"buttons", {{"a", true}, {"b", false}}}}}};
  all["wireless_verse_grip"] = json::array({other, grip});
  ASSERT_EQ(decode(all), Decoded::reading);
  EXPECT_EQ(reading.buttons, 6u) << "the grip that was there first";
  all["wireless_verse_grip"] = json::array({other});
  ASSERT_EQ(decode(all), Decoded::reading);
  EXPECT_EQ(reading.buttons_known, 0u) << "another hand's";
  all.erase("wireless_verse_grip");
  ASSERT_EQ(decode(all), Decoded::reading);
  EXPECT_EQ(reading.buttons, 0u);
  EXPECT_EQ(reading.buttons_known, 0u);
}

TEST_F(AnInverse3, HasNoButtonsAmongSeveralGrips) {
  open();
  json all = message({device("049D", 0, -0.12, 0.16)});
  for (const char* id : {"61548", "3"}) {
    all["wireless_verse_grip"].push_back(
        {{"device_id", id}, {"state", {{"buttons", {{"a", true}, {"b", true}}}}}});
  }
  ASSERT_EQ(decode(all), Decoded::reading);
  EXPECT_EQ(reading.buttons_known, 0u);
  all["wireless_verse_grip"].erase(0);
  ASSERT_EQ(decode(all), Decoded::reading);
  EXPECT_EQ(reading.buttons_known, 0u) << "the other grip may have gone to sleep";
}

TEST_F(AnInverse3, GetsItsTorqueAsAForceOnTheCursor) {
  open();
  EXPECT_THAT(encode(Vec3(0.1, -0.25, 0.4), 0ms), testing::ElementsAre(force("049D", 1, -2.5, 4)));
}

// Otherwise a slow service would get a queue of old forces.
TEST_F(AnInverse3, GetsNoFurtherForceBeforeItHasAnswered) {
  open();
  const json answer = message({device("049D", 0, -0.12, 0.16)});
  EXPECT_EQ(encode(Vec3(0.1, 0, 0), 1ms).size(), 1u);
  EXPECT_EQ(encode(Vec3(0.2, 0, 0), 2ms).size(), 0u);
  EXPECT_EQ(encode(Vec3(0.2, 0, 0), 3ms).size(), 0u);
  decode(answer);
  EXPECT_THAT(encode(Vec3(0.3, 0, 0), 4ms), testing::ElementsAre(force("049D", 3, 0, 0)));
}

TEST_F(AnInverse3, GetsTheZeroAfterAForceWithoutHavingAnswered) {
  open();
  EXPECT_EQ(encode(Vec3(0.1, 0, 0), 1ms).size(), 1u);
  EXPECT_THAT(encode(Vec3::Zero(), 2ms), testing::ElementsAre(force("049D", 0, 0, 0)));
  EXPECT_EQ(encode(Vec3::Zero(), 3ms).size(), 0u);
}

TEST_F(AnInverse3, IsAskedAgainAfterLongSilence) {
  open();
  EXPECT_EQ(encode(Vec3::Zero(), 1ms).size(), 1u);
  EXPECT_EQ(encode(Vec3::Zero(), 100ms).size(), 0u);
  EXPECT_EQ(encode(Vec3::Zero(), 101ms).size(), 1u);
  EXPECT_EQ(encode(Vec3::Zero(), 102ms).size(), 0u);
  decode(message({device("049D", 0, -0.12, 0.16)}));
  EXPECT_EQ(encode(Vec3::Zero(), 103ms).size(), 1u) << "one answer was lost for good";
}

TEST_F(AnInverse3, IsStoppedByAForceOfZero) {
  open(message({device("a\"b", 0, 0, 0.1)}));
  ASSERT_EQ(protocol->stop_reports().size(), 1u);
  const Report& stop = protocol->stop_reports()[0];
  EXPECT_EQ(json::parse(stop.begin() + 1, stop.end()), force("a\"b", 0, 0, 0));
}

// The service lets other programs turn, move and scale its frame at any time.
TEST_F(AnInverse3, IsAtFaultWhileAMessageSaysAnotherFrame) {
  const json turned{{"config", {{"basis", {{"permutation", "XZY"}}}}}};
  const json preset{{"config", {{"preset", "led_front"}}}};
  const json mount{
      {"config", {{"mount", {{"transform", {{"position", {{"x", 0.1}, {"y", 0}, {"z", 0}}}}}}}}}};
  const json workspace{{"state", {{"transform", {{"scale", {{"x", 1}, {"y", 2}, {"z", 1}}}}}}}};
  const json usual{{"config",
                    {{"basis", {{"permutation", "XYZ"}}},
                     {"preset", "defaults"},
                     {"mount", {{"position", {{"x", 0}, {"y", 0}, {"z", 0}}}}}}},
                   {"state", {{"transform", {{"scale", {{"x", 1}, {"y", 1}, {"z", 1}}}}}}}};
  const auto said = [](const json& more) {
    json one = device("049D", 0, -0.12, 0.16);
    one.merge_patch(more);
    return message({one});
  };
  for (const json& other : {turned, preset, mount, workspace}) {
    open();
    EXPECT_EQ(decode(said(json::object())), Decoded::reading);
    EXPECT_FALSE(reading.fault);
    EXPECT_EQ(decode(said(other)), Decoded::reading);
    EXPECT_TRUE(reading.fault) << other;
    decode(said(json::object()));
    EXPECT_TRUE(reading.fault) << "what is not said again has not changed: " << other;
    decode(said(usual));
    EXPECT_FALSE(reading.fault) << other;
  }
}

// The other frame may move the cursor too far for a believable position.
TEST_F(AnInverse3, IsAtFaultAtOnceWhereTheOtherFrameMovesIt) {
  open();
  EXPECT_EQ(decode(message({device("049D", 0, -0.12, 0.16)})), Decoded::reading);
  json moved = device("049D", 0, 0.12, 0.16);
  EXPECT_EQ(decode(message({moved})), Decoded::unusable);
  EXPECT_FALSE(reading.fault);
  moved["config"]["preset"] = "led_front";
  EXPECT_EQ(decode(message({moved})), Decoded::status);
  EXPECT_TRUE(reading.fault);
}

TEST_F(AnInverse3, RepeatsAZeroThatDidNotLeaveAtTheNextChance) {
  open();
  EXPECT_EQ(encode({0.1, 0, 0}, 0ms).size(), 1u);
  EXPECT_EQ(encode({0, 0, 0}, 1ms).size(), 1u);
  EXPECT_TRUE(encode({0, 0, 0}, 2ms).empty()) << "it has left";
  protocol->undelivered();
  const auto again = encode({0, 0, 0}, 3ms);
  ASSERT_EQ(again.size(), 1u);
  EXPECT_EQ(again[0], force("049D", 0, 0, 0));
  EXPECT_TRUE(encode({0, 0, 0}, 4ms).empty());
}

// Two forces could queue up at a slow service.
TEST_F(AnInverse3, RepeatsNoForceThatDidNotLeave) {
  open();
  EXPECT_EQ(encode({0.1, 0, 0}, 0ms).size(), 1u);
  protocol->undelivered();
  EXPECT_TRUE(encode({0.1, 0, 0}, 1ms).empty());
  EXPECT_EQ(encode({0.1, 0, 0}, InverseProtocol::kAskAgain).size(), 1u);
}

}  // namespace
}  // namespace limpid
