#include "app/base/folders.h"
#include "app/desktop/base/window_layout.h"
#include "devices/files/text_file.h"
#include "tests/devices/files/test_files.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Named : public testing::Test {
 protected:
  NamedTexts open() const { return {dir_ / "shipped.toml", dir_ / "own/own.toml"}; }
  static std::vector<std::string> names(const NamedTexts& texts) {
    std::vector<std::string> names;
    for (const NamedTexts::Entry& entry : texts.all()) names.push_back(entry.name);
    return names;
  }

  void SetUp() override {
    test::write_file(dir_ / "shipped.toml", "[\"As it comes\"]\na = 1\n");
    fs::create_directories(dir_ / "own");
  }
  test::TempDir dir_;
};

TEST_F(Named, ComeBackAtTheNextStart) {
  NamedTexts texts = open();
  EXPECT_EQ(texts.complaint(), "");
  EXPECT_EQ(texts.keep("odd \"name\" \xCE\xB7", "coupling.eta = 0.5\n"), "");
  EXPECT_EQ(texts.keep("other", "b = [1, 2]"), "");
  EXPECT_EQ(texts.keep("other", "b = [3]"), "");
  EXPECT_EQ(texts.rename("other", "renamed"), "");
  const NamedTexts again = open();
  EXPECT_EQ(names(again),
            (std::vector<std::string>{"As it comes", "odd \"name\" \xCE\xB7", "renamed"}));
  EXPECT_THAT(again.find("renamed")->text, HasSubstr("3"));
  EXPECT_EQ(texts.remove("renamed"), "");
  EXPECT_EQ(open().find("renamed"), nullptr);
}

TEST_F(Named, OfTwoWindowsAreAllThere) {
  NamedTexts first = open(), second = open();
  EXPECT_EQ(first.keep("of the first", "a = 1"), "");
  EXPECT_EQ(second.keep("of the second", "a = 2"), "");
  EXPECT_EQ(first.keep("of the first again", "a = 3"), "");
  const std::vector<std::string> all{"As it comes", "of the first", "of the first again",
                                     "of the second"};
  EXPECT_EQ(names(open()), all);
  EXPECT_EQ(names(first), all) << "what the other window kept can be used here, too";

  EXPECT_EQ(second.remove("of the first"), "");
  EXPECT_THAT(first.rename("of the first", "renamed"), HasSubstr("another window"));
  EXPECT_THAT(first.rename("of the second", "of the first again"), HasSubstr("already"));
  EXPECT_EQ(names(open()),
            (std::vector<std::string>{"As it comes", "of the first again", "of the second"}));
}

TEST_F(Named, ThatTheProgramHasByNowStayInTheirFile) {
  test::write_file(dir_ / "own/own.toml", "[\"As it comes\"]\na = 5\n");
  NamedTexts texts = open();
  EXPECT_THAT(texts.find("As it comes")->text, HasSubstr("1"));
  EXPECT_EQ(texts.keep("mine", "a = 2"), "");
  EXPECT_THAT(test::file_bytes(dir_ / "own/own.toml"), HasSubstr("a = 5"));
}

TEST_F(Named, ThatComeAlongStayAsTheyAre) {
  NamedTexts texts = open();
  EXPECT_FALSE(texts.may_change("As it comes"));
  EXPECT_TRUE(texts.may_change("mine"));
  EXPECT_FALSE(texts.may_change(""));
  EXPECT_EQ(texts.keep("mine", "a = 2"), "");
  EXPECT_THAT(test::file_bytes(dir_ / "own/own.toml"), testing::Not(HasSubstr("As it comes")));
}

TEST_F(Named, OfAFileThatCannotBeReadAreNotLost) {
  const std::string broken = "[\"mine\"\na = ";
  test::write_file(dir_ / "own/own.toml", broken);
  NamedTexts texts = open();
  EXPECT_THAT(texts.complaint(), HasSubstr("own.toml:1"));
  EXPECT_EQ(names(texts), std::vector<std::string>{"As it comes"});
  EXPECT_EQ(texts.keep("new", "a = 2"), "");
  EXPECT_EQ(test::file_bytes(dir_ / "own/own.toml.unread"), broken);
  EXPECT_NE(open().find("new"), nullptr);
}

TEST_F(Named, HaveToBeTables) {
  test::write_file(dir_ / "own/own.toml", "mine = 3\n");
  EXPECT_THAT(open().complaint(), HasSubstr("own.toml:1: mine: 3 is not allowed"));
}

TEST_F(Named, ThatCannotBeWrittenAreReportedAndNotThere) {
  NamedTexts texts(dir_ / "shipped.toml", dir_ / "shipped.toml/own.toml");
  EXPECT_NE(texts.keep("mine", "a = 2"), "");
  EXPECT_EQ(texts.find("mine"), nullptr);
}

TEST(Layout, RoundTrips) {
  Settings s;
  s.show_right = false;
  s.left = 333.25;
  s.plot_choices = {{.title = "tremor", .kind = PlotKind::spectrum, .channels = {"hand/torque.1"}},
                    {.kind = PlotKind::cross, .across = "a", .channels = {"b", "c"}}};
  Settings other;
  other.parameters().eta = 0.7;
  apply_layout(other, layout_text(s), "here");
  EXPECT_EQ(other.plot_choices, s.plot_choices);
  EXPECT_EQ(other.show_right, false);
  EXPECT_EQ(other.left, 333.25);
  EXPECT_EQ(other.parameters().eta, 0.7) << "a layout has no settings of the loop";
}

TEST(Layout, ThatIsWrongSaysWhereAndChangesNothing) {
  const auto complaint = [](const std::string& text) -> std::string {
    Settings s;
    s.left = 345;
    try {
      apply_layout(s, text, "Mine");
    } catch (const FileError& e) {
      EXPECT_EQ(s.left, 345);
      EXPECT_EQ(s.plot_choices, default_plots());
      return e.what();
    }
    return "nothing";
  };
  EXPECT_THAT(complaint("left = 200\nshow_plots = 3"), HasSubstr("Mine:2: show_plots: 3"));
  EXPECT_THAT(complaint("left = 5"), HasSubstr("left: 5"));
  EXPECT_THAT(complaint("left = 200\n[[plot]]\nkind = \"pie\""), HasSubstr("plot.kind: \"pie\""));
  EXPECT_THAT(complaint("[[plot]]\nchannels = [1]"), HasSubstr("plot.channels"));
  EXPECT_THAT(complaint("[[plot]]\nchanels = []"),
              HasSubstr("plot.chanels: no such key; did you mean channels? allowed: title"));
  EXPECT_THAT(complaint("plot = 3"), HasSubstr("Mine:1: plot: 3"));
}

TEST(Preset, GivesCouplingAndGainsBackAndNothingElse) {
  Parameters p;
  p.kind = CouplingKind::predictive;
  p.eta = 0.1 + 0.2;
  p.alpha = 0.01;
  p.hand_stiffness = 55;
  p.delay = 3;
  Parameters other;
  other.b_v = 0.5;
  other.hand_stiffness = 77;
  other.torque_limit = 0.25;
  other.delay = 2;
  apply_preset(other, preset_text(p), "here");
  EXPECT_EQ(other.kind, p.kind);
  EXPECT_EQ(other.eta, p.eta);
  EXPECT_EQ(other.alpha, p.alpha);
  EXPECT_EQ(other.b_v, p.b_v);
  EXPECT_EQ(other.hand_stiffness, 77);
  EXPECT_EQ(other.torque_limit, 0.25);
  EXPECT_EQ(other.delay, 2) << "what is known of the device is no gain";
}

TEST(Preset, HasThePapersValueWhereItSaysNothing) {
  Parameters p;
  p.eta = 3;
  p.k_vc = 77;
  apply_preset(p, "coupling.eta = 0.5", "here");
  EXPECT_EQ(p.eta, 0.5);
  EXPECT_EQ(p.k_vc, Parameters{}.k_vc);
}

TEST(Preset, ThatIsWrongNamesTheKeyAndChangesNothing) {
  Parameters p;
  p.eta = 3;
  try {
    apply_preset(p, "coupling.eta = -1", "Mine");
    FAIL();
  } catch (const FileError& e) {
    EXPECT_THAT(e.what(), HasSubstr("coupling.eta: -1"));
  }
  EXPECT_EQ(p.eta, 3);
}

TEST(ComeAlong, CanAllBeUsed) {
  const test::TempDir dir;
  const NamedTexts presets(data_dir() / "assets/presets.toml", dir / "none.toml");
  EXPECT_EQ(presets.complaint(), "");
  EXPECT_GE(presets.all().size(), 3u);
  for (const NamedTexts::Entry& entry : presets.all()) {
    Parameters p;
    EXPECT_NO_THROW(apply_preset(p, entry.text, entry.name)) << entry.name;
  }
  const NamedTexts layouts(data_dir() / "assets/layouts.toml", dir / "none.toml");
  EXPECT_EQ(layouts.complaint(), "");
  const TraceChannels channels{RowLayout(3)};
  for (const NamedTexts::Entry& entry : layouts.all()) {
    Settings s;
    ASSERT_NO_THROW(apply_layout(s, entry.text, entry.name)) << entry.name;
    for (const PlotChoice& plot : s.plot_choices) {
      for (const std::string& key : plot.channels) EXPECT_TRUE(channels.find(key)) << key;
    }
  }
}

}  // namespace
}  // namespace limpid
