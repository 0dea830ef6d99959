#include "app/desktop/base/notices.h"

#include <gtest/gtest.h>

#include <string>

namespace limpid {
namespace {

TEST(Notices, AreSaidInTheirOrder) {
  Notices notices;
  notices.say("first");
  notices.say("second", true);
  notices.forget_old();
  ASSERT_EQ(notices.all().size(), 2u);
  EXPECT_EQ(notices.all()[0].text, "first");
  EXPECT_FALSE(notices.all()[0].bad);
  EXPECT_TRUE(notices.all()[1].bad);
  EXPECT_GT(notices.all()[1].until, notices.all()[0].until) << "a bad one stays for longer";
}

TEST(Notices, AreThereOnceHoweverOftenTheyAreSaid) {
  Notices notices;
  for (const char* text : {"kept", "saved", "kept"}) notices.say(text);
  ASSERT_EQ(notices.all().size(), 2u);
  EXPECT_EQ(notices.all().back().text, "kept") << "the last one that was said";
}

// A failure in every frame would fill the window.
TEST(Notices, AreNotRepeatedWhileTheyAreSaid) {
  Notices notices;
  for (int frame = 0; frame < 3; ++frame) notices.say_once("no room on the disk", true);
  notices.say_once("something else", true);
  EXPECT_EQ(notices.all().size(), 2u);
}

// Notices that leave the window stay among what was said, up to a number.
TEST(Notices, AreRememberedWithTheirTimeUntilThereAreTooMany) {
  Notices notices;
  const auto before = std::chrono::system_clock::now();
  const auto began = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < Notices::kKept; ++i) notices.say(std::to_string(i), i % 2 == 1);
  EXPECT_EQ(notices.past().size(), Notices::kKept);
  EXPECT_EQ(notices.past().front().text, "0") << "none has left yet";
  notices.say("one more", true);
  EXPECT_EQ(notices.past().size(), Notices::kKept);
  EXPECT_EQ(notices.past().front().text, "1");
  EXPECT_TRUE(notices.past().front().bad);
  EXPECT_EQ(notices.past().back().text, "one more");
  EXPECT_GE(notices.past().back().said, before);
  EXPECT_LE(notices.past().back().said, std::chrono::system_clock::now());
  EXPECT_EQ(notices.all().size(), Notices::kKept + 1) << "the window shows all of them";
  const auto stays = notices.all().back().until - began;
  EXPECT_GE(stays, std::chrono::seconds(10));
  EXPECT_LT(stays, std::chrono::seconds(70));
  notices.forget_old();
  EXPECT_EQ(notices.all().size(), Notices::kKept + 1) << "their time is not over";
  notices.clear();
  EXPECT_TRUE(notices.all().empty());
  EXPECT_EQ(notices.past().size(), Notices::kKept);
  notices.say_once("one more", true);
  EXPECT_EQ(notices.all().size(), 1u) << "it is not shown any more";
}

}  // namespace
}  // namespace limpid
