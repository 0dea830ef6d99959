// Every line of the settings' file: its key, its value, and the member that has it at the next
// start.
#include <stdlib.h>
#include <toml++/toml.h>

#include <tuple>

#include "app/desktop/base/settings.h"
#include "tests/devices/files/test_files.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

class SettingsLines : public testing::Test {
 protected:
  SettingsLines() {
    if (const char* before = getenv("XDG_CONFIG_HOME")) before_ = before;
    setenv("XDG_CONFIG_HOME", (folder_ / "").c_str(), 1);
  }
  ~SettingsLines() override {
    before_ ? setenv("XDG_CONFIG_HOME", before_->c_str(), 1) : unsetenv("XDG_CONFIG_HOME");
  }
  fs::path file() const { return folder_ / "limpid/settings.toml"; }
  toml::table lines() const { return toml::parse(test::file_bytes(file())); }
  // Writes these settings where no file is, and reads them back.
  Settings round(const Settings& settings) {
    fs::remove(file());
    EXPECT_EQ(save_settings(settings, {}), "");
    std::string complaint;
    const Settings again = load_settings(complaint);
    EXPECT_EQ(complaint, "");
    return again;
  }
  // Changes one member at a time: no other line may have its key.
  template <class T>
  void expect_own_line(const char* key, T Settings::*member, const T& value) {
    SCOPED_TRACE(key);
    Settings changed;
    const T usual = changed.*member;
    ASSERT_NE(usual, value);
    changed.*member = value;
    const Settings again = round(changed);
    EXPECT_EQ(again.*member, value);
    EXPECT_EQ(lines()["window"][key].value<T>(), value);
    Settings back = again;
    back.*member = usual;
    EXPECT_TRUE(kept_alike_but(back));
    fs::remove(file());
    EXPECT_EQ(save_settings({}, {}), "");
    EXPECT_EQ(lines()["window"][key].value<T>(), usual);
  }
  // Returns whether these settings give the file of a start without any.
  bool kept_alike_but(const Settings& settings) {
    fs::remove(file());
    EXPECT_EQ(save_settings(settings, {}), "");
    const toml::table mine = lines();
    fs::remove(file());
    EXPECT_EQ(save_settings({}, {}), "");
    return mine == lines();
  }

  const test::TempDir folder_;
  std::optional<std::string> before_;
};

TEST_F(SettingsLines, AreOneForEachSwitch) {
  const std::tuple<const char*, bool Settings::*> switches[] = {
      {"everything", &Settings::everything},
      {"show_left", &Settings::show_left},
      {"show_right", &Settings::show_right},
      {"show_plots", &Settings::show_plots},
      {"show_ghost", &Settings::show_ghost},
      {"show_trail", &Settings::show_trail},
      {"show_forces", &Settings::show_forces},
      {"show_grid", &Settings::show_grid},
      {"show_lens", &Settings::show_lens},
      {"show_joints", &Settings::show_joints},
      {"twin_overlaid", &Settings::overlaid},
      {"hold_on_release", &Settings::hold_on_release},
      {"own_file_dialogs", &Settings::own_file_dialogs},
      {"your_turn", &Settings::your_turn}};
  for (const auto& [key, member] : switches) expect_own_line(key, member, !(Settings{}.*member));
  // A file that has seen the hint and names no steps comes from before there were any.
  Settings seen;
  seen.hint_seen = true;
  EXPECT_TRUE(round(seen).hint_seen);
  EXPECT_EQ(lines()["window"]["hint_seen"].value<bool>(), true);
}

TEST_F(SettingsLines, AreOneForEachNumberAndText) {
  const std::tuple<const char*, double Settings::*, double> numbers[] = {
      {"ui_scale", &Settings::ui_scale, 1.75}, {"text_size", &Settings::text_size, 1.25},
      {"left", &Settings::left, 311},          {"right", &Settings::right, 322.5},
      {"plots", &Settings::plots, 133},        {"plot_length", &Settings::plot_length, 31},
      {"band", &Settings::band, 7.5}};
  for (const auto& [key, member, value] : numbers) expect_own_line(key, member, value);
  expect_own_line("width", &Settings::width, 1111);
  expect_own_line("height", &Settings::height, 777);
  const std::tuple<const char*, std::string Settings::*, std::string> texts[] = {
      {"tried", &Settings::tried, "dw"},
      {"picture_quality", &Settings::picture_quality, "medium"},
      {"device", &Settings::device, "/a/arm.urdf"},
      {"device_tip", &Settings::device_tip, "tool0"},
      {"scene", &Settings::scene, "/a/scene.toml"},
      {"gamepad", &Settings::gamepad, "0300"}};
  for (const auto& [key, member, value] : texts) expect_own_line(key, member, value);
}

TEST_F(SettingsLines, OfThemeAndRecentFilesAndEachLane) {
  for (const auto& [theme, name] :
       {std::pair(Theme::dark, "dark"), {Theme::light, "light"}, {Theme::contrast, "contrast"}}) {
    Settings settings;
    settings.theme = theme;
    EXPECT_EQ(round(settings).theme, theme);
    EXPECT_EQ(lines()["window"]["theme"].value<std::string>(), name);
  }
  Settings settings;
  settings.recent = {"/a/new.h5", "/a/old.toml"};
  for (std::size_t i = 0; i < kMostLanes; ++i) {
    settings.lanes.parameters[i].eta = 0.5 + 0.25 * static_cast<double>(i);
    settings.lanes.parameters[i].alpha = 0.01 * static_cast<double>(i + 1);
  }
  settings.plot_choices = {{.title = "mine",
                            .kind = PlotKind::cross,
                            .across = "hand/torque.1",
                            .channels = {"device/position.2", "contact/total_force_norm"}},
                           {.channels = {"coordination/error"}}};
  const Settings again = round(settings);
  EXPECT_EQ(again.recent, settings.recent);
  EXPECT_EQ(again.plot_choices, settings.plot_choices);
  for (std::size_t i = 0; i < kMostLanes; ++i) {
    EXPECT_EQ(again.lanes.parameters[i], settings.lanes.parameters[i]) << i;
  }
  const toml::table all = lines();
  EXPECT_EQ(all["parameters"]["coupling"]["eta"].value<double>(), 0.5);
  ASSERT_EQ(all["plot"].as_array()->size(), 2u);
  EXPECT_EQ(all["plot"][0]["kind"].value<std::string>(), "cross");
  EXPECT_EQ(all["plot"][0]["across"].value<std::string>(), "hand/torque.1");
  EXPECT_EQ(all["plot"][1]["kind"].value<std::string>(), "time");
  EXPECT_FALSE(all["plot"][1].as_table()->contains("title"));
}

// A hand-written file is held to what the window can show.
TEST_F(SettingsLines, AreHeldToWhatThereIs) {
  const auto read = [&](const std::string& text, std::string& complaint) {
    fs::create_directories(file().parent_path());
    test::write_file(file(), text);
    complaint.clear();
    return load_settings(complaint);
  };
  std::string complaint;
  EXPECT_EQ(read("[window]\ntext_size = 9.0\n", complaint).text_size, kTextSizes.back());
  EXPECT_EQ(read("[window]\ntext_size = 0.1\n", complaint).text_size, kTextSizes.front());
  EXPECT_EQ(read("[window]\ntheme = \"pink\"\n", complaint).theme, Theme::dark);
  EXPECT_EQ(read("[window]\nrecent = [3, \"/a\", true]\n", complaint).recent,
            std::vector<std::string>{"/a"});
  EXPECT_EQ(complaint, "");
  std::string many = "[[plot]]\nchannels = [\"a\"]\n";
  for (int i = 1; i < 24; ++i) many += "[[plot]]\nchannels = [\"a\"]\n";
  EXPECT_EQ(read(many, complaint).plot_choices.size(), 24u);
  EXPECT_EQ(complaint, "");
  read(many + "[[plot]]\nchannels = [\"a\"]\n", complaint);
  EXPECT_THAT(complaint, testing::HasSubstr("at most 24 tables [[plot]]"));
  std::string long_one = "[[plot]]\nchannels = [\"a\"";
  for (int i = 1; i < 32; ++i) long_one += ", \"a\"";
  EXPECT_EQ(read(long_one + "]\n", complaint).plot_choices[0].channels.size(), 32u);
  EXPECT_EQ(complaint, "");
  for (const std::string& wrong : {long_one + ", \"a\"]\n", std::string("[[plot]]\nchannels = 3\n"),
                                   std::string("[[plot]]\nchannels = [\"a\", 3]\n")}) {
    EXPECT_EQ(read(wrong, complaint).plot_choices, default_plots());
    EXPECT_THAT(complaint, testing::HasSubstr("a list of at most 32 texts"));
  }
  read("[[plot]]\nlater = 1\n[parameters]\ncoupling.eta = -1\n", complaint);
  EXPECT_THAT(complaint, testing::StartsWith("the settings were not read: "));
  EXPECT_THAT(complaint, testing::HasSubstr("later"));
  EXPECT_THAT(complaint, testing::HasSubstr("; ")) << "both";
}

// The eighth is kept, and the ninth leaves.
TEST_F(SettingsLines, OfRecentFilesAreEight) {
  Settings settings;
  for (int i = 0; i < 8; ++i) remember_recent(settings, std::string(1, static_cast<char>('a' + i)));
  EXPECT_EQ(settings.recent, (std::vector<std::string>{"h", "g", "f", "e", "d", "c", "b", "a"}));
  remember_recent(settings, "i");
  EXPECT_EQ(settings.recent, (std::vector<std::string>{"i", "h", "g", "f", "e", "d", "c", "b"}));
  remember_recent(settings, "b");
  EXPECT_EQ(settings.recent, (std::vector<std::string>{"b", "i", "h", "g", "f", "e", "d", "c"}));
}

}  // namespace
}  // namespace limpid
