#include "app/desktop/base/notices.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace limpid
