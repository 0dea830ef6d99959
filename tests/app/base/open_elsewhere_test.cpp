// Files handed to the desktop's programs, with stand-ins for xdg-open and for the file manager.
#include "app/base/open_elsewhere.h"

#include <dbus/dbus.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <future>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "app/base/session_bus.h"
#include "tests/support/private_bus.h"
#include "tests/support/temp_dir.h"
#include "tests/support/until.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

class OpenedElsewhere : public testing::Test {
 protected:
  OpenedElsewhere() {
    for (const char* name : kVariables) {
      const char* value = std::getenv(name);
      before_.emplace_back(value != nullptr ? value : "");
    }
    unsetenv("DBUS_SESSION_BUS_ADDRESS");
    unsetenv("XDG_RUNTIME_DIR");
    setenv("PATH", (dir_ / "").c_str(), 1);
  }
  ~OpenedElsewhere() override {
    for (std::size_t i = 0; i < before_.size(); ++i) {
      before_[i].empty() ? unsetenv(kVariables[i]) : setenv(kVariables[i], before_[i].c_str(), 1);
    }
  }
  // Puts a program in place that notes its first word.
  void have_xdg_open() const {
    const fs::path program = dir_ / "xdg-open";
    std::ofstream(program) << "#!/bin/sh\nprintf %s \"$1\" >'" + (dir_ / "part").string() +
                                  "'\n/bin/mv '" + (dir_ / "part").string() + "' '" +
                                  (dir_ / "opened").string() + "'\n";
    fs::permissions(program, fs::perms::owner_all);
  }
  std::string opened() const {
    test::until([this] { return fs::exists(dir_ / "opened"); });
    std::ifstream in(dir_ / "opened");
    return {std::istreambuf_iterator<char>(in), {}};
  }

  const test::TempDir dir_;

 private:
  static constexpr std::array kVariables{"PATH", "DBUS_SESSION_BUS_ADDRESS", "XDG_RUNTIME_DIR"};
  std::vector<std::string> before_;
};

TEST_F(OpenedElsewhere, AreFilesOfAnyName) {
  have_xdg_open();
  EXPECT_TRUE(open_elsewhere("/a b/it's $HOME; `x`.pdf"));
  EXPECT_EQ(opened(), "/a b/it's $HOME; `x`.pdf");
}

TEST_F(OpenedElsewhere, IsNothingWithoutXdgOpen) {
  EXPECT_FALSE(open_elsewhere("/a.pdf"));
  EXPECT_FALSE(show_in_folder("/a/b.pdf"));
}

TEST_F(OpenedElsewhere, IsTheFolderWhereThereIsNoFileManager) {
  have_xdg_open();
  EXPECT_TRUE(show_in_folder("/a/b.pdf"));
  EXPECT_EQ(opened(), "/a");
}

TEST_F(OpenedElsewhere, IsSelectedByTheFileManager) {
  setenv("PATH", "/usr/bin:/bin", 1);
  const test::PrivateBus daemon;
  if (!daemon.runs()) GTEST_SKIP() << "no dbus-daemon here";
  const Bus manager = session_bus();
  ASSERT_TRUE(manager);
  dbus_bus_request_name(manager.get(), "org.freedesktop.FileManager1", 0, nullptr);
  auto shown = std::async(std::launch::async, [] { return show_in_folder("/a b/c.png"); });
  std::string method, item;
  int count = 0;
  while (shown.wait_for(0s) != std::future_status::ready) {
    dbus_connection_read_write(manager.get(), 10);
    const BusMessage call(dbus_connection_pop_message(manager.get()));
    char** items = nullptr;
    const char* startup = nullptr;
    if (!call ||
        dbus_message_get_args(call.get(), nullptr, DBUS_TYPE_ARRAY, DBUS_TYPE_STRING, &items,
                              &count, DBUS_TYPE_STRING, &startup, DBUS_TYPE_INVALID) == FALSE) {
      continue;
    }
    method = dbus_message_get_member(call.get());
    if (count > 0) item = items[0];
    dbus_free_string_array(items);
    const BusMessage reply(dbus_message_new_method_return(call.get()));
    dbus_connection_send(manager.get(), reply.get(), nullptr);
  }
  EXPECT_TRUE(shown.get());
  EXPECT_EQ(method, "ShowItems");
  EXPECT_EQ(count, 1);
  EXPECT_EQ(item, "file:///a%20b/c.png");
}

}  // namespace
}  // namespace limpid
