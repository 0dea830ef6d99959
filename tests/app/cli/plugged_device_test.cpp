// Commands on a device that is plugged in: here a program in Python, of three joints in a trembling
// hand.
#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>

#include "app/base/interrupt.h"
#include "devices/files/session/session.h"
#include "tests/app/cli/beside.h"
#include "tests/app/cli/said.h"
#include "tests/support/line_client.h"
#include "tests/support/until.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::lines_of;
using test::Said;
using test::text_of;
using testing::AllOf;
using testing::ContainsRegex;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

// The device trembles by 1 mrad about the arm's middle, and its first and third button are pressed.
constexpr const char* kPen = R"(
import math, os, sys, time
sys.path.insert(0, sys.argv[1])
from limpid_device import LimpidDevice
device = LimpidDevice(sys.argv[2], [-1, -1.735, 0.15], [1, 0.165, 2.9916], [0.64, 0.64, 0.45], version=2)
parent = os.getppid()
while os.getppid() == parent:
    s = 1e-3 * math.sin(20 * time.monotonic())
    device.exchange([s, s - 0.78, s + 1.57], buttons=5, warmth=0.25)
    time.sleep(1e-3)
)";

// Presses Ctrl-C in the process that has started this one, once the file is there.
int interrupt_at(const char* file) {
  test::until([&] { return fs::exists(file); });
  return kill(getppid(), SIGINT);
}

class PluggedDevice : public test::Program {
 protected:
  PluggedDevice() : terminal_(dup(STDIN_FILENO)) {
    const int nothing = open("/dev/null", O_RDONLY);
    dup2(nothing, STDIN_FILENO);
    close(nothing);
    allow_signals();
    fs::create_directories(temp_ / "home/limpid");
    fs::permissions(temp_ / "home/limpid", fs::perms::owner_all);
  }
  ~PluggedDevice() override {
    for (const pid_t each : programs_) {
      kill(each, SIGKILL);
      waitpid(each, nullptr, 0);
    }
    dup2(terminal_, STDIN_FILENO);
    close(terminal_);
    allow_signals();
  }
  void plug(const char* name = "pen") {
    const char* words[] = {"python3", "-c", kPen, LIMPID_ASSETS_DIR "/python", name, nullptr};
    pid_t program = -1;
    ASSERT_EQ(posix_spawn(&program, "/usr/bin/python3", nullptr, nullptr,
                          const_cast<char* const*>(words), environ),
              0);
    programs_.push_back(program);
    ASSERT_TRUE(test::until([&] { return fs::exists(socket_of(name)); }));
  }
  std::string socket_of(const std::string& name) const {
    return temp_ / "home/limpid" / (name + ".device");
  }
  // Notes that the axes of the device were checked.
  void check(const std::string& more = "") const {
    write("home/limpid/devices.toml", "[device.\"socket:pen\"]\nchecked = true\n" + more);
  }
  // Runs a command of which a busy computer may take the force, until it has not.
  static Said with_force(const std::vector<std::string>& words) {
    Said said;
    test::until([&] {
      said = run(words);
      const bool late = said.err.find("no reading for 5 ms") != std::string::npos ||
                        said.err.find("loop stood still") != std::string::npos;
      return !late;
    });
    return said;
  }

 private:
  // A shell starts programs in the background with Ctrl-C ignored, and commands leave that so.
  static void allow_signals() {
    interrupted = false;
    for (const int each : {SIGINT, SIGTERM, SIGHUP}) std::signal(each, SIG_DFL);
  }

  int terminal_;
  std::vector<pid_t> programs_;
};

TEST_F(PluggedDevice, IsListedWithItsArm) {
  plug();
  const std::string rows =
      fmt::format("pen\n  device on a socket, socket:pen at {}", socket_of("pen"));
  const std::string text = done({"devices"});
  EXPECT_THAT(text, HasSubstr(rows + "\n  "));
  EXPECT_THAT(text, HasSubstr("\n  arm: a built-in arm, with little force, until you choose"));
  EXPECT_THAT(text, Not(HasSubstr("no haptic device is plugged in")));
  EXPECT_THAT(text, Not(HasSubstr("driven by")));
  EXPECT_THAT(text, Not(HasSubstr("in use")));
  const json told = json::parse(done({"devices", "--json"}));
  ASSERT_EQ(told["devices"].size(), 1u);
  const json& pen = told["devices"][0];
  const json expected{{"id", "socket:pen"},
                      {"name", "pen"},
                      {"kind", "device on a socket"},
                      {"path", socket_of("pen")},
                      {"in_use", false},
                      {"in_use_by", ""},
                      {"library", ""},
                      {"library_version", ""},
                      {"missing", ""}};
  for (const auto& [key, value] : expected.items()) {
    EXPECT_EQ(pen[key], value) << key;
  }
  EXPECT_THAT(text, HasSubstr("  " + pen["arm"].get<std::string>() + "\n"));
  write("home/limpid/devices.toml", "in_use = \"socket:pen\"\n");
  EXPECT_THAT(done({"devices"}), HasSubstr(rows + ", in use\n"));
  EXPECT_EQ(json::parse(done({"devices", "--json"}))["devices"][0]["in_use"], true);
  write("home/limpid/devices.toml", "in_use = 7\n");
  const Said wrong = run({"devices"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.out, HasSubstr(rows)) << "it is listed all the same";
  EXPECT_THAT(wrong.err, HasSubstr("devices.toml"));
}

TEST_F(PluggedDevice, IsToldItsArm) {
  plug();
  const std::string omni = std::string(LIMPID_ASSETS_DIR) + "/devices/omni.urdf";
  EXPECT_EQ(done({"devices", "--arm", "omni.urdf"}),
            "pen is used as the arm omni: this arm was chosen for the device.\n");
  EXPECT_THAT(done({"devices"}), HasSubstr("\n  arm: " + omni + ", as chosen\n"));
  EXPECT_THAT(text_of(temp_ / "home/limpid/devices.toml"), HasSubstr("pen, 3 joints"));
  EXPECT_THAT(text_of(temp_ / "home/limpid/devices.toml"), Not(HasSubstr("in_use = 'socket")));
  EXPECT_EQ(done({"devices", "socket:pen", "--arm", "built-in"}),
            "pen is used as the arm omni: this arm was chosen for the device.\n");
  EXPECT_THAT(done({"devices"}), HasSubstr("\n  arm: a built-in arm, as chosen\n"));
  EXPECT_EQ(done({"devices", "--arm", "unsaid"}), "no arm is chosen for this device any more\n");
  EXPECT_THAT(done({"devices"}), HasSubstr("until you choose"));
  const std::string before = text_of(temp_ / "home/limpid/devices.toml");
  const std::string stick = std::string(LIMPID_ASSETS_DIR) + "/devices/joystick.urdf";
  EXPECT_THAT(refused({"devices", "--arm", stick}),
              AllOf(StartsWith("limpid: --arm: pen was chosen to be the arm "),
                    HasSubstr(" of 2 joints. The device has 3 joints now.")));
  EXPECT_THAT(refused({"devices", "--arm", "none.urdf"}),
              StartsWith("limpid: none.urdf: no such file"));
  EXPECT_EQ(text_of(temp_ / "home/limpid/devices.toml"), before) << "nothing is stored";
  fs::copy_file(omni, "mine.urdf");
  done({"devices", "--arm", "mine.urdf", "--tip", "tip"});
  EXPECT_THAT(
      done({"devices"}),
      HasSubstr("\n  arm: " + (fs::current_path() / "mine.urdf").string() + ", as chosen\n"))
      << "from wherever it is called";
  write("home/limpid/devices.toml", "[device.\"socket:pen\"]\narm = \"/found.urdf\"\n");
  EXPECT_THAT(done({"devices"}), HasSubstr("\n  arm: the identified arm, /found.urdf\n"));
  EXPECT_THAT(refused({"devices", "--arm", omni}),
              HasSubstr("--arm: pen was identified; `limpid identify --forget` removes"));
}

TEST_F(PluggedDevice, IsNamedWhereThereAreSeveral) {
  plug();
  EXPECT_THAT(refused({"devices", "look", "socket:brush", "--record", "l.h5"}),
              HasSubstr("socket:brush: is not connected; connected devices: socket:pen\n"));
  plug("brush");
  EXPECT_THAT(refused({"devices", "look", "--record", "l.h5"}),
              HasSubstr("no device is chosen; `limpid devices` lists the devices' ids"));
  EXPECT_THAT(refused({"devices", "look", "socket:none", "--record", "l.h5"}),
              AllOf(HasSubstr("connected devices: "), HasSubstr("socket:pen"), HasSubstr(", "),
                    HasSubstr("socket:brush")));
  EXPECT_FALSE(fs::exists("l.h5"));
  EXPECT_THAT(refused({"devices", "--json", "look", "--record", "l.h5"}),
              HasSubstr("look: write device and options after `look`"));
  EXPECT_THAT(done({"complete", "identify", ""}),
              AllOf(HasSubstr("socket:pen\tpen\n"), HasSubstr("socket:brush\tbrush\n")));
}

TEST_F(PluggedDevice, IsLookedAtWithoutForce) {
  plug();
  const Said said = run({"devices", "look", "--record", "look.h5", "--seconds", "0.5"});
  EXPECT_EQ(said.status, 0) << said.err;
  EXPECT_THAT(said.err, StartsWith("limpid: pen is read for 0.5 s and gets no force: "));
  EXPECT_EQ(lines_of(said.err).size(), 1u);
  for (const char* line :
       {"^device +pen, device on a socket, socket:pen\n", "\narm +pen is used as the arm omni: ",
        "\nmotors +the device has motors; the motors got no force\n",
        "\naxes +as the device reports them; not checked yet\n", "\njoints +3\n",
        "\nreadings +[0-9]+, [0-9]+ per second .1000 declared.", "\nturret .rad. +-?[0-9.e-]+ to ",
        "\nbuttons +pressed: 1, 3\n", "\nwarmth +at most 25 % ",
        "\nrecorded 0.[0-9]+ s in look.h5\n$"}) {
    EXPECT_THAT(said.out, ContainsRegex(line));
  }
  const Session session = read_session("look.h5");
  EXPECT_THAT(session.info.source, StartsWith("device without force: pen"));
  EXPECT_NE(session.info.safety, "");
  ASSERT_GT(session.size(), 100u);
  for (std::size_t k = 0; k < session.size(); ++k) {
    for (const double torque : session.at(k, Column::motor_torque)) ASSERT_EQ(torque, 0) << k;
  }
  EXPECT_NEAR(session.at(session.size() - 1, Column::device_position)[1], -0.78, 2e-3);
  EXPECT_THAT(refused({"devices", "look", "--record", "look.h5"}), HasSubstr("look.h5"));
  const Said again = run({"devices", "look", "socket:pen", "--record", "look.h5", "--force",
                          "--seconds", "0.4", "--json"});
  EXPECT_EQ(again.status, 0) << again.err;
  const json told = json::parse(again.out);
  EXPECT_EQ(told["recorded"], "look.h5");
  EXPECT_NEAR(told["seconds"], 0.4, 0.2);
  EXPECT_EQ(told["id"], "socket:pen");
  EXPECT_EQ(told["force_given"], false);
  EXPECT_GT(told["readings"], 50);
  const double middle[] = {0, -0.78, 1.57};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(told["joints"][i]["least"], middle[i] - 1e-3, 5e-4) << i;
    EXPECT_NEAR(told["joints"][i]["most"], middle[i] + 1e-3, 5e-4) << i;
  }
}

TEST_F(PluggedDevice, KeepsWhatWasSeenWhenTheLookIsStopped) {
  plug();
  test::Beside stops([] { return interrupt_at("look.h5.part"); });
  const Said said = run({"devices", "look", "--record", "look.h5", "--seconds", "600"});
  EXPECT_EQ(said.status, 1) << said.err;
  EXPECT_THAT(said.err, ContainsRegex("limpid: (stopped at [0-9.]+ s|socket:pen: after .*)\n"));
  EXPECT_THAT(said.out, StartsWith("device "));
  EXPECT_FALSE(fs::exists("look.h5.part"));
}

TEST_F(PluggedDevice, GetsNoForceUntilItsAxesAreChecked) {
  plug();
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"run", "--live", "--yes", "--record", "a.h5"},
        {"identify", "--out", "o", "--yes"},
        {"experiment", "coordination", "--live", "--yes", "--out", "o"},
        {"serve", "here", "--live", "--until-eof"}}) {
    EXPECT_THAT(
        refused(words),
        StartsWith("limpid: pen: the axes must be checked before the device may push; start "
                   "limpid, choose the device in the Device panel and press \"Check the axes"
                   "\"\n"));
  }
  EXPECT_FALSE(fs::exists("a.h5"));
  EXPECT_FALSE(fs::exists("o"));
  EXPECT_THAT(refused({"run", "--live", "socket:none"}), HasSubstr("socket:none: is not connected"))
      << "nobody is asked before";
  check();
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"run", "--live", "--record", "a.h5"},
        {"experiment", "coordination", "--live", "--out", "o"}}) {
    EXPECT_THAT(refused(words), HasSubstr("a person must allow the device to push, but there is no "
                                          "terminal to ask in; needed: --yes, or a terminal"));
  }
  check("limits = {tip_force = \"1\"}\n");
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"run", "--live", "--yes"}, {"identify", "--forget"}}) {
    std::vector<std::string> named = words;
    if (words[0] == "identify") named.insert(named.begin() + 1, "socket:pen");
    EXPECT_THAT(refused(named), HasSubstr("limits.tip_force: \"1\" is not allowed"));
  }
}

TEST_F(PluggedDevice, PushesInALiveRunAndIsRecorded) {
  plug();
  check("limits = {tip_force = 2.5}\n");
  const Said said = with_force({"run", "--live", "--yes", "--duration", "0.3", "--record",
                                "live.h5", "--force", "--coupling", "proposed", "--eta", "0.9"});
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_THAT(said.err, StartsWith("limpid: pen is used as the arm omni: a built-in arm is used "));
  EXPECT_THAT(said.err, HasSubstr("limpid: pen is driven by limpid_device.py\n"));
  EXPECT_THAT(said.out,
              StartsWith("Take hold of omni and move it for 0.3 s, as you like.\nticks     "));
  const Session session = read_session("live.h5");
  EXPECT_THAT(said.out, EndsWith(fmt::format("recorded {} ticks in live.h5\n", session.size())));
  ASSERT_GT(session.size(), 0u);
  EXPECT_NEAR(static_cast<double>(session.size()), 300, 100);
  EXPECT_THAT(session.info.source, StartsWith("device: pen"));
  EXPECT_THAT(session.info.safety, HasSubstr("tip_force = 2.5"));
  EXPECT_EQ(session.at(0, Column::eta)[0], 0.9);
  std::size_t on = 0;
  for (std::size_t k = 0; k < session.size(); ++k) {
    on += session.at(k, Column::force_state)[0] == 0 ? 1 : 0;
  }
  EXPECT_GT(on, session.size() * 8 / 10);
  EXPECT_THAT(done({"info", "live.h5"}), AllOf(HasSubstr("proposed, eta 0.9\n"),
                                               HasSubstr("hand                     device: pen")));
  EXPECT_FALSE(fs::exists("live.h5.part"));
  const Said brief = run({"run", "--live", "--yes", "--duration", "0.3", "--measure-grip"});
  EXPECT_EQ(brief.status, 2);
  EXPECT_THAT(brief.err, HasSubstr("limpid: --measure-grip: give --duration of at least "));
}

// The command is stopped by Ctrl-C while it waits for the hand.
TEST_F(PluggedDevice, EndsALiveRunAtCtrlC) {
  plug();
  check();
  test::Beside stops([] { return interrupt_at("live.h5.part"); });
  const Said said = run({"run", "--live", "--yes", "--duration", "600", "--record", "live.h5"});
  EXPECT_EQ(said.status, 1);
  EXPECT_THAT(said.err, EndsWith("limpid: stopped\n"));
  EXPECT_FALSE(fs::exists("live.h5")) << "there are no rows";
  EXPECT_FALSE(fs::exists("live.h5.part"));
  interrupted = true;
  const Said trial = run({"experiment", "coordination", "--live", "--yes", "--out", "o"});
  EXPECT_EQ(trial.status, 1);
  EXPECT_THAT(trial.err, EndsWith("limpid: stopped\n"));
  EXPECT_TRUE(fs::exists("o/limpid.txt"));
  EXPECT_FALSE(fs::exists("o/report.html"));
}

TEST_F(PluggedDevice, IsIdentifiedWhenAPersonAllowsIt) {
  plug();
  check("limits = {range = 0.5}\n");
  const Said asked = run({"identify", "--out", "o", "--range", "0.2"});
  EXPECT_EQ(asked.status, 2);
  EXPECT_THAT(asked.out,
              ContainsRegex("^pen will move by itself for about [0-9]+ s, through 20 % of its "
                            "range.\nClear the space around the device and let go"));
  EXPECT_THAT(asked.err, HasSubstr("limpid: pen is used as the arm omni"));
  EXPECT_THAT(asked.err, HasSubstr("a person must allow the device to move, but there is no "
                                   "terminal to ask in; needed: --yes, or a terminal"));
  EXPECT_THAT(text_of("o/limpid.txt"), StartsWith("limpid identify socket:pen\n"));
  interrupted = true;
  const Said stopped = run({"identify", "socket:pen", "--out", "o", "--yes"});
  EXPECT_EQ(stopped.status, 1);
  EXPECT_THAT(stopped.err,
              ContainsRegex("limpid: ended: [^\n]+; o/motion.csv contains the motion up to that "
                            "time\n"));
  EXPECT_THAT(text_of("o/motion.csv"), Not(IsEmpty()));
  EXPECT_FALSE(fs::exists("o/identified.urdf"));
  EXPECT_THAT(text_of(temp_ / "home/limpid/devices.toml"), Not(HasSubstr("identified.urdf")));
}

TEST_F(PluggedDevice, ForgetsTheArmThatItWasIdentifiedAs) {
  check("arm = \"/found.urdf\"\ndelay = 0.002\n[device.\"socket:other\"]\narm = \"/kept.urdf\"\n");
  EXPECT_EQ(done({"identify", "socket:pen", "--forget"}), "forgotten\n");
  const std::string now = text_of(temp_ / "home/limpid/devices.toml");
  EXPECT_THAT(now, AllOf(Not(HasSubstr("/found.urdf")), HasSubstr("/kept.urdf"),
                         HasSubstr("checked = true"), Not(HasSubstr("delay = 0.002"))));
}

TEST_F(PluggedDevice, IsServedToPrograms) {
  plug();
  check();
  test::Beside serving([this] {
    const Said said = run({"serve", "lab", "--live"});
    write("said.txt", said.out + said.err);
    return said.status;
  });
  const std::string socket = temp_ / "home/limpid/lab.control";
  ASSERT_TRUE(test::until([&] { return fs::exists(socket); }));
  {
    const auto client = std::make_unique<test::LineClient>(socket);
    const auto ask = [&](const json& request) {
      client->say(request.dump());
      std::optional<json> line;
      test::until([&] { return (line = client->take()).has_value(); });
      return line.value_or(json());
    };
    const json state = ask({{"do", "get"}, {"keys", json::array()}})["ok"]["state"];
    EXPECT_EQ(state["device"], true);
    EXPECT_EQ(state["arm"], "omni");
    EXPECT_EQ(state["force"], false) << "its second button arms it";
    EXPECT_THAT(ask({{"do", "open"}, {"arm", "touch.urdf"}})["error"].get<std::string>(),
                HasSubstr("a person's hand moves a real device"));
    const json opened = ask({{"do", "open"}, {"scene", "free.toml"}});
    EXPECT_EQ(opened["ok"]["objects"], 0) << opened;
  }
  EXPECT_EQ(serving.end(SIGINT), 0);
  EXPECT_THAT(text_of("said.txt"), AllOf(HasSubstr("/home/limpid/lab.control\n"),
                                         HasSubstr("limpid: pen is used as the arm omni")));
}

TEST_F(PluggedDevice, IsNotCharacterizedAsAnotherArm) {
  plug();
  EXPECT_THAT(
      refused({"characterize", "--device", "socket:none", "--out", "o"}),
      HasSubstr("Plug the device in: a connected device reports the encoder steps itself."));
  check("arm = \"/found.urdf\"\n");
  EXPECT_THAT(refused({"characterize", "--device", "socket:pen", "--out", "o"}),
              HasSubstr("/found.urdf"));
}

}  // namespace
}  // namespace limpid
