#include "app/base/session_bus.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <string>
#include <utility>

namespace limpid {
namespace {

namespace fs = std::filesystem;

TEST(UriOfAFile, NamesWhatIsOutsideOfLettersByTheirBytes) {
  EXPECT_EQ(uri_of("/home/ann/arm-2_b.urdf~"), "file:///home/ann/arm-2_b.urdf~");
  EXPECT_EQ(uri_of("/a b/100%/\xc3\xa4?#.toml"), "file:///a%20b/100%25/%C3%A4%3F%23.toml");
}

TEST(UriOfAFile, LeadsBackToTheFile) {
  std::string all = "/";
  for (int byte = 1; byte < 256; ++byte) all += static_cast<char>(byte);
  EXPECT_EQ(file_of(uri_of(all)), fs::path(all));
}

// RFC 8089 allows an absent computer name or localhost; hexadecimal digits may be lower case.
TEST(FileOfAUri, IsReadInAllItsForms) {
  EXPECT_EQ(file_of("file:///a%c3%a4"), fs::path("/a\xc3\xa4"));
  EXPECT_EQ(file_of("file://localhost/a+b"), fs::path("/a+b"));
}

TEST(FileOfAUri, IsNothingWhereItIsNoFileOfThisComputer) {
  for (const char* uri : {"", "file://", "file:/", "http://host/a", "sftp://host/a",
                          "file://host/a", "file://localhostile/a", "/a", "file:///a%",
                          "file:///a%2", "file:///a%zz", "file:///a%+1", "file:///a%00b"}) {
    EXPECT_FALSE(file_of(uri)) << uri;
  }
}

// Restores the environment variables after each test.
class SessionBus : public testing::Test {
 protected:
  void TearDown() override {
    for (const auto& [name, value] : before_) {
      value.empty() ? unsetenv(name) : setenv(name, value.c_str(), 1);
    }
  }
  static std::string value_of(const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr ? value : "";
  }

 private:
  std::array<std::pair<const char*, std::string>, 2> before_{
      {{"DBUS_SESSION_BUS_ADDRESS", value_of("DBUS_SESSION_BUS_ADDRESS")},
       {"XDG_RUNTIME_DIR", value_of("XDG_RUNTIME_DIR")}}};
};

TEST_F(SessionBus, IsNotStartedWhereThereIsNone) {
  unsetenv("DBUS_SESSION_BUS_ADDRESS");
  unsetenv("XDG_RUNTIME_DIR");
  EXPECT_FALSE(has_session_bus());
  EXPECT_FALSE(session_bus());
  setenv("XDG_RUNTIME_DIR", testing::TempDir().c_str(), 1);
  EXPECT_FALSE(has_session_bus());
  setenv("DBUS_SESSION_BUS_ADDRESS", "", 1);
  EXPECT_FALSE(has_session_bus());
}

TEST_F(SessionBus, IsNoneWhereNobodyServesIt) {
  setenv("DBUS_SESSION_BUS_ADDRESS", "unix:path=/nowhere/bus", 1);
  EXPECT_TRUE(has_session_bus());
  EXPECT_FALSE(session_bus());
}

}  // namespace
}  // namespace limpid
