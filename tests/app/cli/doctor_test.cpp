// Findings of the doctor about a computer that the test has changed: folders, tools, displays,
// devices.
#include "app/doctor/doctor.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <fstream>
#include <map>

#include "app/base/folders.h"
#include "tests/app/cli/said.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using test::Said;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::StartsWith;

class Doctor : public test::Program {
 protected:
  Doctor() {
    for (const char* name : {"PATH", "DISPLAY", "WAYLAND_DISPLAY", "DBUS_SESSION_BUS_ADDRESS"}) {
      const char* value = std::getenv(name);
      if (value != nullptr) before_[name] = value;
    }
  }
  ~Doctor() override {
    for (const char* name : {"PATH", "DISPLAY", "WAYLAND_DISPLAY", "DBUS_SESSION_BUS_ADDRESS"}) {
      before_.contains(name) ? setenv(name, before_[name].c_str(), 1) : unsetenv(name);
    }
  }
  // The finding about a thing.
  static Finding about(const DoctorFindings& all, const std::string& what) {
    for (const Finding& each : all) {
      if (each.what == what) return each;
    }
    ADD_FAILURE() << "nothing about " << what;
    return {};
  }
  static void expect_fine(const Finding& finding, const std::string& found) {
    EXPECT_EQ(finding.state, Finding::State::fine) << finding.what << finding.found;
    EXPECT_EQ(finding.found, found) << finding.what;
    EXPECT_EQ(finding.cost, "") << finding.what;
    EXPECT_EQ(finding.mend, "") << finding.what;
  }
  void tool(const fs::path& file, fs::perms may) const {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << "#!/bin/sh\n";
    fs::permissions(file, may);
  }

 private:
  std::map<std::string, std::string> before_;
};

TEST_F(Doctor, FindsFilesProgramsAndFolders) {
  const DoctorFindings all = look_at_files();
  for (const Finding& each : all) EXPECT_EQ(each.area, "files");
  expect_fine(about(all, "assets"), data_dir().string());
  const fs::path beside = fs::canonical("/proc/self/exe").parent_path();
  for (const auto& [name, cost] :
       {std::pair("limpid-session", "recordings and tables of sweeps are not read"),
        {"limpid-model", "models other than glTF are not read"},
        {"limpid-video", "no videos"},
        {"limpid-vendor", "devices whose makers have their own library are not found"}}) {
    const Finding finding = about(all, name);
    if (access((beside / name).c_str(), X_OK) == 0) {
      expect_fine(finding, (beside / name).string());
      continue;
    }
    EXPECT_EQ(finding.state, Finding::State::broken) << name;
    EXPECT_EQ(finding.found, (beside / name).string() + " is missing");
    EXPECT_EQ(finding.cost, cost);
    EXPECT_THAT(finding.mend, StartsWith("sudo apt install --reinstall limpid; or `cmake"));
  }
  for (const auto& [what, folder] : {std::pair("settings", user_config_dir()),
                                     {"data", user_data_dir()},
                                     {"cache", user_cache_dir()}}) {
    expect_fine(about(all, what), folder.string());
  }
  const Finding room = about(all, "disk");
  const double left = static_cast<double>(fs::space(temp_ / "home").available) / 1e9;
  double said = -1;
  ASSERT_EQ(std::sscanf(room.found.c_str(), "%lf GB left at ", &said), 1) << room.found;
  EXPECT_NEAR(said, left, 0.06 + 0.05 * left);
  EXPECT_THAT(room.found, testing::EndsWith((temp_ / "home").string())) << "the folder above";
  const bool fine = left > 1;
  EXPECT_EQ(room.state == Finding::State::fine, fine);
  EXPECT_EQ(room.cost.empty(), fine);
  fs::create_directories(user_data_dir());
  EXPECT_THAT(about(look_at_files(), "disk").found, testing::EndsWith(user_data_dir().string()));
}

TEST_F(Doctor, LooksForToolsWhereTheShellDoes) {
  setenv("PATH", ((temp_ / "none").string() + ":" + (temp_ / "tools").string()).c_str(), 1);
  const Finding none = about(look_at_files(), "gnuplot");
  EXPECT_EQ(none.state, Finding::State::better);
  EXPECT_EQ(none.found, "not installed");
  EXPECT_EQ(none.cost, "experiments and sweeps draw no figures");
  EXPECT_EQ(none.mend, "sudo apt install gnuplot-nox");
  tool(temp_ / "tools/gnuplot", fs::perms::owner_read);
  EXPECT_EQ(about(look_at_files(), "gnuplot").state, Finding::State::better) << "no program";
  fs::permissions(temp_ / "tools/gnuplot", fs::perms::owner_all);
  expect_fine(about(look_at_files(), "gnuplot"), (temp_ / "tools/gnuplot").string());
}

TEST_F(Doctor, SaysWhichFoldersCannotBeWritten) {
  std::ofstream(temp_ / "file") << "x";
  setenv("XDG_DATA_HOME", (temp_ / "file").c_str(), 1);
  setenv("XDG_CACHE_HOME", "/proc/limpid-none", 1);
  const DoctorFindings all = look_at_files();
  const Finding data = about(all, "data");
  EXPECT_EQ(data.state, Finding::State::broken);
  EXPECT_EQ(data.found, (temp_ / "file/limpid").string() + " cannot be written");
  EXPECT_EQ(data.cost, "nothing is stored for the next start");
  EXPECT_EQ(data.mend, fmt::format("rm {}    # it is not a folder", (temp_ / "file").string()));
  expect_fine(about(all, "settings"), user_config_dir().string());
  if (geteuid() == 0) return;  // who may write everywhere
  const Finding cache = about(all, "cache");
  EXPECT_EQ(cache.state, Finding::State::broken);
  EXPECT_EQ(cache.mend, "sudo chown -R \"$USER\" /proc");
}

TEST_F(Doctor, KnowsThatThereIsNoDisplay) {
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  setenv("DBUS_SESSION_BUS_ADDRESS", "", 1);
  const DoctorFindings none = look_at_picture();
  for (const Finding& each : none) EXPECT_EQ(each.area, "picture");
  const Finding window = about(none, "window");
  EXPECT_EQ(window.state, Finding::State::better);
  EXPECT_EQ(window.found, "no display (DISPLAY is not set)");
  EXPECT_EQ(window.cost, "the window does not open; all commands that need no window work");
  EXPECT_EQ(window.mend, "start it from a desktop, or over `ssh -X`");
  expect_fine(about(none, "file dialog"),
              "Limpid's own dialog: no session bus connects Limpid to the desktop");
  const Finding offscreen = about(none, "without display");
  EXPECT_EQ(offscreen.state, Finding::State::fine) << offscreen.found;
  EXPECT_NE(offscreen.found, "");
  EXPECT_EQ(offscreen.mend, "");
  setenv("DISPLAY", "", 1);
  EXPECT_THAT(about(look_at_picture(), "window").found, HasSubstr("is not set"));
  setenv("DISPLAY", ":4711", 1);
  const Finding wrong = about(look_at_picture(), "window");
  EXPECT_EQ(wrong.state, Finding::State::broken) << wrong.found;
  EXPECT_EQ(wrong.cost, "the window does not open");
  EXPECT_EQ(wrong.mend, "sudo apt install libgl1 libegl1 libgl1-mesa-dri");
  setenv("DBUS_SESSION_BUS_ADDRESS", "unix:path=/none/bus", 1);
  expect_fine(about(look_at_picture(), "file dialog"),
              "Limpid's own dialog: the desktop has no portal for file dialogs");
}

TEST_F(Doctor, ListsDevicesOnSockets) {
  setenv("XDG_RUNTIME_DIR", (temp_ / "run").c_str(), 1);
  fs::create_directories(temp_ / "run/limpid");
  const DoctorFindings none = look_at_devices();
  for (const Finding& each : none) EXPECT_EQ(each.area, "devices");
  std::error_code unknown;
  std::size_t nodes = 0;
  for (fs::directory_iterator at("/sys/class/hidraw", unknown), end; !unknown && at != end; ++at) {
    ++nodes;
  }
  const Finding hid = about(none, "HID");
  EXPECT_EQ(hid.state == Finding::State::fine, !unknown) << hid.found;
  EXPECT_EQ(hid.found, unknown ? "the kernel has no /sys/class/hidraw"
                               : fmt::format("{} hidraw nodes", nodes));
  EXPECT_EQ(hid.cost.empty(), !unknown);
  const Finding rule = about(none, "udev rule");
  if (rule.state == Finding::State::fine) {
    EXPECT_TRUE(fs::exists(rule.found)) << rule.found;
  } else {
    EXPECT_EQ(rule.found, "not installed");
    EXPECT_EQ(rule.cost, "only root may talk to HID devices");
    EXPECT_THAT(
        rule.mend,
        AllOf(StartsWith("sudo cp " + (data_dir() / "assets/udev/70-limpid.rules").string()),
              HasSubstr(" /etc/udev/rules.d/ && sudo udevadm control --reload")));
  }
  if (nodes == 0) {
    expect_fine(about(none, "haptic device"),
                "no device is plugged in; the virtual arm works without one");
  }
  const int listens = socket(AF_UNIX, SOCK_SEQPACKET, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = temp_ / "run/limpid/pen.device";
  path.copy(address.sun_path, sizeof(address.sun_path) - 1);
  ASSERT_EQ(bind(listens, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  ASSERT_EQ(listen(listens, 1), 0);
  const DoctorFindings one = look_at_devices();
  close(listens);
  expect_fine(about(one, "pen (socket:pen)"), "device on a socket at " + path);
  EXPECT_EQ(std::ranges::count(one, "haptic device", &Finding::what), 0);
  const auto nobody = std::ranges::count(none, "haptic device", &Finding::what);
  EXPECT_EQ(one.size() + static_cast<std::size_t>(nobody), none.size() + 1);
}

TEST_F(Doctor, KnowsKernelTimersAndLimits) {
  const DoctorFindings all = look_at_real_time();
  std::vector<std::string> things;
  for (const Finding& each : all) {
    EXPECT_EQ(each.area, "real time");
    things.push_back(each.what);
    EXPECT_EQ(each.state == Finding::State::fine, each.cost.empty()) << each.what;
    EXPECT_EQ(each.cost.empty(), each.mend.empty()) << each.what;
  }
  EXPECT_EQ(things, (std::vector<std::string>{"priority", "memory", "timers", "clock", "kernel"}));
  utsname name{};
  uname(&name);
  const std::string version = name.version;
  const bool whole = version.find("PREEMPT_RT") != std::string::npos;
  EXPECT_THAT(about(all, "kernel").found, StartsWith(fmt::format("Linux {}, ", name.release)));
  EXPECT_EQ(about(all, "kernel").found.find("linux-image-rt-amd64") == std::string::npos, whole);
  const auto limit = [](auto which, rlim_t per, const char* unit) {
    rlimit it{};
    getrlimit(which, &it);
    return it.rlim_cur == RLIM_INFINITY ? std::string("unlimited")
                                        : fmt::format("{}{}", it.rlim_cur / per, unit);
  };
  EXPECT_THAT(about(all, "priority").found,
              testing::EndsWith(fmt::format("(RLIMIT_RTPRIO {})", limit(RLIMIT_RTPRIO, 1, ""))));
  EXPECT_THAT(
      about(all, "memory").found,
      testing::EndsWith(fmt::format("(RLIMIT_MEMLOCK {})", limit(RLIMIT_MEMLOCK, 1024, " KiB"))));
  EXPECT_THAT(about(all, "timers").found, ContainsRegex("^every [0-9]+ ns, slack [0-9]+ ns$"));
  timespec resolution{};
  clock_getres(CLOCK_MONOTONIC, &resolution);
  EXPECT_THAT(about(all, "timers").found,
              StartsWith(fmt::format("every {} ns", resolution.tv_nsec)));
  if (!fs::exists("/sys/devices/system/cpu/cpu0/cpufreq")) {
    expect_fine(about(all, "clock"), "the kernel does not control the processor's frequency");
  }
}

}  // namespace
}  // namespace limpid
