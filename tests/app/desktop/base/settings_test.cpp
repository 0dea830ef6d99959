#include "app/desktop/base/settings.h"

#include <stdlib.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <optional>

#include "app/desktop/base/first_steps.h"
#include "app/desktop/base/kept_settings.h"
#include "tests/devices/files/test_files.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

// Restores an environment variable at its end.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* before = getenv(name)) before_ = before;
    setenv(name, value.c_str(), 1);
  }
  ~Variable() {
    if (before_) {
      setenv(name_, before_->c_str(), 1);
    } else {
      unsetenv(name_);
    }
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

class SettingsFile : public testing::Test {
 protected:
  fs::path file() const { return dir_ / "limpid/settings.toml"; }
  Settings load() { return load_settings(complaint_); }
  void write(const std::string& text) {
    fs::create_directories(file().parent_path());
    test::write_file(file(), text);
  }

  test::TempDir dir_;
  Variable config_{"XDG_CONFIG_HOME", (dir_ / "").string()};
  Variable data_{"XDG_DATA_HOME", (dir_ / "data").string()};
  std::string complaint_;
};

TEST_F(SettingsFile, ThatIsMissingMeansDefaults) {
  const Settings s = load();
  EXPECT_EQ(complaint_, "");
  EXPECT_EQ(s.width, Settings{}.width);
  EXPECT_EQ(s.parameters(), Settings{}.parameters());
}

TEST_F(SettingsFile, KeepsTheFilesOpenedLastTheNewestFirstAndEachOnce) {
  Settings s;
  for (int i = 0; i < 20; ++i) remember_recent(s, fmt::format("/a/session {}.h5", i));
  remember_recent(s, "/a/session 15.h5");
  EXPECT_LE(s.recent.size(), 10u);
  EXPECT_EQ(s.recent[0], "/a/session 15.h5");
  EXPECT_EQ(s.recent[1], "/a/session 19.h5");
  EXPECT_EQ(std::ranges::count(s.recent, "/a/session 15.h5"), 1);
  EXPECT_EQ(save_settings(s, {}), "");
  EXPECT_EQ(load().recent, s.recent);
}

TEST_F(SettingsFile, GivesEverythingBack) {
  Settings s;
  s.theme = Theme::contrast;
  s.text_size = 1.5;
  s.ui_scale = 1.75;
  s.width = 1999;
  s.height = 777;
  s.left = 311;
  s.plots = 123.5;
  s.show_right = false;
  s.show_trail = false;
  s.hold_on_release = true;
  s.hint_seen = true;
  s.tried = "dc";
  s.plot_length = 31;
  s.device = "/some/\"odd\" path/arm\xCE\xB7.urdf";
  s.scene = "C:\\scene.toml";
  s.plot_choices = {{.title = "\"odd\" title \xCE\xB7",
                     .kind = PlotKind::cross,
                     .across = "hand/torque.1",
                     .channels = {"device/position.2", "no such channel"}},
                    {.kind = PlotKind::spectrum, .channels = {"coordination/error"}}};
  s.parameters().kind = CouplingKind::proposed;
  s.parameters().eta = 0.1 + 0.2;
  s.parameters().damping = 0.017;
  s.parameters().velocity = VelocitySource::adaptive;
  EXPECT_EQ(save_settings(s, {}), "");
  const Settings again = load();
  EXPECT_EQ(complaint_, "");
  EXPECT_EQ(again.theme, s.theme);
  EXPECT_EQ(again.text_size, s.text_size);
  EXPECT_EQ(again.ui_scale, s.ui_scale);
  EXPECT_EQ(again.width, s.width);
  EXPECT_EQ(again.height, s.height);
  EXPECT_EQ(again.left, s.left);
  EXPECT_EQ(again.plots, s.plots);
  EXPECT_EQ(again.show_right, s.show_right);
  EXPECT_EQ(again.show_trail, s.show_trail);
  EXPECT_EQ(again.hold_on_release, s.hold_on_release);
  EXPECT_EQ(again.hint_seen, s.hint_seen);
  EXPECT_EQ(again.tried, s.tried);
  EXPECT_EQ(again.plot_length, s.plot_length);
  EXPECT_EQ(again.device, s.device);
  EXPECT_EQ(again.scene, s.scene);
  EXPECT_EQ(again.parameters(), s.parameters());
  EXPECT_EQ(again.plot_choices, s.plot_choices);
}

// Settings date from before hints were ticked off one by one: their user has seen them.
TEST_F(SettingsFile, OfAnEarlierLimpidNeedNoHints) {
  fs::create_directories(file().parent_path());
  for (const bool seen : {false, true}) {
    std::ofstream(file()) << "[window]\nhint_seen = " << (seen ? "true" : "false") << "\n";
    EXPECT_EQ(all_done(load()), seen);
  }
  std::ofstream(file()) << "[window]\nhint_seen = true\ntried = \"d\"\n";
  EXPECT_TRUE(done(load(), FirstStep::pull));
  EXPECT_FALSE(done(load(), FirstStep::law));
}

TEST_F(SettingsFile, GivesEverySwitchBackByItself) {
  using Switch = bool Settings::*;
  for (const Switch one :
       {&Settings::show_left, &Settings::show_right, &Settings::show_plots, &Settings::show_ghost,
        &Settings::show_trail, &Settings::show_forces, &Settings::show_grid, &Settings::show_lens,
        &Settings::show_joints, &Settings::overlaid, &Settings::hold_on_release,
        &Settings::hint_seen, &Settings::your_turn}) {
    Settings s;
    s.*one = !(s.*one);
    EXPECT_EQ(save_settings(s, load()), "");
    EXPECT_EQ(load().*one, s.*one);
    fs::remove(file());
  }
}

TEST_F(SettingsFile, GivesPictureAndGamepadBack) {
  Settings s;
  s.picture_quality = "low";
  s.right = 333;
  s.band = 7.5;
  s.device_tip = "tool0";
  s.gamepad = "03000000de280000ff11000001000000";
  EXPECT_EQ(save_settings(s, {}), "");
  const Settings again = load();
  EXPECT_EQ(complaint_, "");
  EXPECT_EQ(again.picture_quality, s.picture_quality);
  EXPECT_EQ(again.right, s.right);
  EXPECT_EQ(again.band, s.band);
  EXPECT_EQ(again.device_tip, s.device_tip);
  EXPECT_EQ(again.gamepad, s.gamepad);
}

TEST_F(SettingsFile, RemembersThatNoPlotIsLeft) {
  Settings s;
  s.plot_choices.clear();
  EXPECT_EQ(save_settings(s, {}), "");
  EXPECT_TRUE(load().plot_choices.empty());
}

TEST_F(SettingsFile, WithABadPlotNamesItAndKeepsEverythingElse) {
  write("[parameters]\ncoupling.eta = 2.0\n[[plot]]\nkind = \"pie\"\n");
  const Settings s = load();
  EXPECT_THAT(complaint_, testing::HasSubstr("settings.toml:4: plot.kind: \"pie\""));
  EXPECT_THAT(complaint_, testing::HasSubstr("allowed: \"time\", \"cross\", \"spectrum\""));
  EXPECT_EQ(s.plot_choices, default_plots());
  EXPECT_EQ(s.parameters().eta, 2);
}

TEST_F(SettingsFile, ThatIsNoTomlIsComplainedAboutAndLeftAlone) {
  write("[window\nwidth = ");
  const Settings s = load();
  EXPECT_THAT(complaint_, testing::HasSubstr("settings"));
  EXPECT_EQ(s.width, Settings{}.width);
}

TEST_F(SettingsFile, TakesWhatItCanOfAFileThatIsPartlyWrong) {
  write("[window]\nwidth = \"wide\"\nheight = 555\nunknown = 3\n");
  const Settings s = load();
  EXPECT_EQ(s.width, Settings{}.width);
  EXPECT_EQ(s.height, 555);
}

TEST_F(SettingsFile, WithAParameterOutOfRangeNamesIt) {
  write("[parameters]\ncoupling.eta = -4\n");
  const Settings s = load();
  EXPECT_THAT(complaint_, testing::HasSubstr("coupling.eta"));
  EXPECT_EQ(s.parameters().eta, 1);
}

// A person has lowered the motors' limit; a newer program has added a key.
TEST_F(SettingsFile, WithAKeyThatIsUnknownKeepsALoweredLimitAndEverythingElse) {
  write(
      "[parameters]\ncoupling.later = 1\nledger.energy = 0.001\nobserver.alpha = 0.02\n"
      "[parameters.device]\ntorque_limit = 0.1\n");
  const Settings s = load();
  EXPECT_THAT(complaint_, testing::HasSubstr("settings.toml:2: coupling.later: no such key"));
  EXPECT_EQ(s.parameters().torque_limit, 0.1);
  EXPECT_EQ(s.parameters().energy, 0.001);
  EXPECT_EQ(s.parameters().alpha, 0.02);
  Settings changed = s;
  changed.width = 1001;
  EXPECT_EQ(save_settings(changed, s), "");
  EXPECT_EQ(load().parameters().torque_limit, 0.1) << "and is written again";
}

// Nobody knows how low the limit was: the strictest is 1e-6 N m.
TEST_F(SettingsFile, WithALimitThatCannotBeUnderstoodHasTheStrictestOne) {
  for (const char* wrong :
       {"[parameters]\ndevice.torque_limit = \"0.1\"\n", "[parameters]\ndevice.torque_limit = -1\n",
        "[parameters]\ndevice.torque_limit = 1e9\n", "[parameters]\ndevice.torqe_limit = 0.1\n",
        "[parameters]\ndevice = 3\n", "parameters = 3\n",
        "[parameters.device]\ntorque_limit = 0.1\n[window\n", "[parameters.device]\ntorque_lim"}) {
    write(wrong);
    complaint_.clear();
    EXPECT_EQ(load().parameters().torque_limit, 1e-6) << wrong;
    EXPECT_THAT(complaint_, testing::HasSubstr("settings.toml:")) << wrong;
  }
  write("[parameters]\ntank.energy = true\ndevice.torque_limit = 0.2\n");
  const Settings s = load();
  EXPECT_EQ(s.parameters().torque_limit, 0.2) << "each limit by itself";
  EXPECT_LT(s.parameters().tank_energy, 1e-3);
}

TEST_F(SettingsFile, ThatIsTooLongToBeReadHasTheStrictestLimits) {
  write("[parameters.device]\ntorque_limit = 0.1\n" + std::string(1 << 20, '#'));
  EXPECT_EQ(load().parameters().torque_limit, 1e-6);
  EXPECT_NE(complaint_, "");
}

// Both windows started with the same file; each knows only its own changes.
TEST_F(SettingsFile, OfTwoWindowsHasWhatWasChangedInEither) {
  Settings began;
  began.parameters().eta = 0.7;
  began.lanes.parameters[kMostLanes - 1].damping = 0.02;
  began.recent = {"/a/old.h5"};
  ASSERT_EQ(save_settings(began, {}), "");
  began = load();
  Settings first = began, second = began;
  first.theme = Theme::light;
  first.parameters().alpha = 0.05;
  first.plot_choices.clear();
  remember_recent(first, "/a/first.h5");
  second.width = 1555;
  second.parameters().eta = 1;
  second.lanes.parameters[kMostLanes - 1].damping =
      std::numeric_limits<double>::quiet_NaN();  // the arm's own value
  remember_recent(second, "/a/second.h5");
  ASSERT_EQ(save_settings(first, began), "");
  ASSERT_EQ(save_settings(second, began), "");
  const Settings both = load();
  EXPECT_EQ(complaint_, "");
  EXPECT_EQ(both.theme, Theme::light);
  EXPECT_EQ(both.parameters().alpha, 0.05);
  EXPECT_TRUE(both.plot_choices.empty());
  EXPECT_EQ(both.width, 1555);
  EXPECT_EQ(both.parameters().eta, 1);
  EXPECT_TRUE(std::isnan(both.lanes.parameters[kMostLanes - 1].damping));
  EXPECT_EQ(both.recent, (std::vector<std::string>{"/a/second.h5", "/a/first.h5", "/a/old.h5"}));
}

TEST_F(SettingsFile, KeepsTheOrderOfAFileThatIsOpenedOnceMore) {
  Settings began;
  began.recent = {"/a/1.h5", "/a/2.h5"};
  ASSERT_EQ(save_settings(began, {}), "");
  Settings now = began;
  remember_recent(now, "/a/3.h5");
  remember_recent(now, "/a/2.h5");
  ASSERT_EQ(save_settings(now, began), "");
  EXPECT_EQ(load().recent, (std::vector<std::string>{"/a/2.h5", "/a/3.h5", "/a/1.h5"}));
}

TEST_F(SettingsFile, ThatIsOfANewerProgramKeepsWhatThisOneDoesNotKnow) {
  write("[window]\nwidth = 1444\nof_later = 3\n[later]\na = 1\n");
  Settings s = load();
  const Settings began = s;
  s.height = 888;
  ASSERT_EQ(save_settings(s, began), "");
  EXPECT_THAT(test::file_bytes(file()), testing::HasSubstr("of_later = 3"));
  EXPECT_THAT(test::file_bytes(file()), testing::HasSubstr("[later]"));
  EXPECT_EQ(load().height, 888);
  EXPECT_EQ(load().width, 1444);
}

TEST_F(SettingsFile, ThatCannotBeReadIsNotLost) {
  const std::string broken = "[parameters]\ncoupling.eta = -4\nobserver.alpha = 0.02\n";
  write(broken);
  const Settings s = load();
  EXPECT_EQ(save_settings(s, s), "");
  EXPECT_EQ(test::file_bytes(file().string() + ".unread"), broken);
  complaint_.clear();
  load();
  EXPECT_EQ(complaint_, "");
}

TEST_F(SettingsFile, ThatCannotBeWrittenIsReportedNotThrown) {
  test::write_file(dir_ / "limpid", "a file where the folder should be");
  EXPECT_NE(save_settings({}, {}), "");
}

TEST_F(SettingsFile, StandsBesideAFolderForSessions) {
  const fs::path folder = sessions_dir();
  EXPECT_EQ(folder, dir_ / "data/limpid/sessions");
  EXPECT_TRUE(fs::is_directory(folder));
}

// The file is written while the window runs, so changes survive any end of the program.
TEST_F(SettingsFile, HasWhatWasChangedOnceThatStands) {
  KeptSettings kept(load());
  Settings now = kept.kept();
  now.parameters().eta = 0.5;
  EXPECT_EQ(kept.follow(now), "");
  EXPECT_FALSE(fs::exists(file())) << "it may still move";
  now.parameters().eta = 0.4;
  EXPECT_EQ(kept.follow(now), "");
  EXPECT_FALSE(fs::exists(file()));
  EXPECT_EQ(kept.follow(now), "");
  EXPECT_EQ(load().parameters().eta, 0.4);
}

TEST_F(SettingsFile, HasWhatWasChangedBack) {
  KeptSettings kept(load());
  Settings now = kept.kept();
  now.scene = "/a.toml";
  kept.follow(now);
  kept.follow(now);
  EXPECT_EQ(load().scene, "/a.toml");
  now.scene.clear();
  kept.follow(now);
  kept.follow(now);
  EXPECT_EQ(load().scene, "");
}

TEST_F(SettingsFile, IsLeftAloneWhileNothingChanges) {
  KeptSettings kept(load());
  for (int i = 0; i < 3; ++i) EXPECT_EQ(kept.follow(kept.kept()), "");
  EXPECT_FALSE(fs::exists(file()));
}

TEST_F(SettingsFile, ThatCannotBeWrittenIsSaidOnceAndTriedAgain) {
  KeptSettings kept(load());
  test::write_file(file().parent_path(), "a file in the folder's place");
  Settings now = kept.kept();
  now.width = 900;
  kept.follow(now);
  EXPECT_NE(kept.follow(now), "");
  EXPECT_EQ(kept.follow(now), "");
  fs::remove(file().parent_path());
  EXPECT_EQ(kept.follow(now), "");
  EXPECT_EQ(load().width, 900);
}

}  // namespace
}  // namespace limpid
