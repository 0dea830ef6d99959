// Options that commands share: how two sets of them join, which files they name, and questions that
// wait for Enter.
#include "app/cli/options.h"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <unistd.h>

#include <iostream>

#include "app/cli/progress.h"
#include "core/tick/parameters.h"
#include "tests/app/cli/said.h"
#include "tests/support/until.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

InputOptions said_at_first() {
  InputOptions first;
  first.device = "a.urdf";
  first.scene = "a.toml";
  first.hand = "a.csv";
  first.tip = "a";
  first.configs = {"1.toml"};
  first.settings = {"coupling.eta=1"};
  first.coupling = "tank";
  first.eta = "0.1";
  first.alpha = "0.2";
  first.duration = 3;
  first.seed = 4;
  first.variation = 5;
  return first;
}

TEST(TwoSetsOfOptions, AreThoseOfTheSecondWhereItSaysAny) {
  const InputOptions first = said_at_first();
  const InputOptions same = both(first, {});
  EXPECT_EQ(same.device, "a.urdf");
  EXPECT_EQ(same.scene, "a.toml");
  EXPECT_EQ(same.hand, "a.csv");
  EXPECT_EQ(same.tip, "a");
  EXPECT_EQ(same.coupling, "tank");
  EXPECT_EQ(same.eta, "0.1");
  EXPECT_EQ(same.alpha, "0.2");
  EXPECT_EQ(same.duration, 3);
  EXPECT_EQ(same.seed, 4u);
  EXPECT_EQ(same.variation, 5u);
  InputOptions second;
  second.device = "b.urdf";
  second.scene = "b.toml";
  second.hand = "b.csv";
  second.tip = "b";
  second.configs = {"2.toml"};
  second.settings = {"coupling.eta=2"};
  second.coupling = "direct";
  second.eta = "0.3";
  second.alpha = "0.4";
  second.duration = 6;
  second.seed = 7;
  second.variation = 8;
  const InputOptions all = both(first, second);
  EXPECT_EQ(all.device, "b.urdf");
  EXPECT_EQ(all.scene, "b.toml");
  EXPECT_EQ(all.hand, "b.csv");
  EXPECT_EQ(all.tip, "b");
  EXPECT_EQ(all.coupling, "direct");
  EXPECT_EQ(all.eta, "0.3");
  EXPECT_EQ(all.alpha, "0.4");
  EXPECT_EQ(all.duration, 6);
  EXPECT_EQ(all.seed, 7u);
  EXPECT_EQ(all.variation, 8u);
  EXPECT_EQ(all.configs, (std::vector<std::string>{"1.toml", "2.toml"})) << "the later one wins";
  EXPECT_EQ(all.settings, (std::vector<std::string>{"coupling.eta=1", "coupling.eta=2"}));
}

TEST(SettingsOfOptions, AreSaidByAnyOfThem) {
  EXPECT_FALSE(InputOptions{}.set_parameters());
  InputOptions world;
  world.device = world.scene = world.hand = world.tip = "x";
  world.duration = 1;
  EXPECT_FALSE(world.set_parameters());
  for (int i = 0; i < 5; ++i) {
    InputOptions one;
    if (i == 0) one.configs = {"x"};
    if (i == 1) one.settings = {"x"};
    if (i == 2) one.coupling = "x";
    if (i == 3) one.eta = "x";
    if (i == 4) one.alpha = "x";
    EXPECT_TRUE(one.set_parameters()) << i;
  }
}

TEST(SettingsOfOptions, AreWordsOfACommandLine) {
  const std::vector<HelpWord> words = parameter_words();
  const auto about = [&](const std::string& word) {
    const auto found = std::ranges::find(words, word, &HelpWord::word);
    return found == words.end() ? "none" : found->about;
  };
  EXPECT_EQ(about("hand.stiffness="), "0 to 100000 N/m");
  EXPECT_EQ(about("coupling.kind=wave"), "");
  EXPECT_EQ(about("observer.anti_windup=true"), "");
  EXPECT_EQ(about("observer.anti_windup=false"), "");
  EXPECT_EQ(about("observer.anti_windup="), "none");
  EXPECT_EQ(about("coupling.kind="), "none");
  std::size_t count = 0;
  for (const ParameterInfo& info : parameter_table()) {
    count += info.kind == FieldInfo::Kind::flag ? 2 : info.is_number() ? 1 : info.words.size();
  }
  EXPECT_EQ(words.size(), count);
}

class SharedOptions : public test::Program {};

TEST_F(SharedOptions, NameArmsAndScenesOrWhatIsUsual) {
  InputOptions options;
  ArmDescription arm;
  SceneDocument document;
  read_world(options, arm, document);
  EXPECT_EQ(arm.name, "omni");
  EXPECT_EQ(document.title, "Table");
  options.device = std::string(LIMPID_ASSETS_DIR) + "/devices/touch.urdf";
  options.scene = std::string(LIMPID_ASSETS_DIR) + "/scenes/free.toml";
  read_world(options, arm, document);
  EXPECT_EQ(arm.name, "touch");
  EXPECT_EQ(document.title, "Free space");
  InputOptions like = options;
  like.device = std::string(LIMPID_ASSETS_DIR) + "/devices/inverse3.urdf";
  options.device = "inverse3";
  EXPECT_EQ(arm_of(options).urdf, arm_of(like).urdf) << "the built-in arm like it";
  EXPECT_THAT(refused({"run", "--device", "inverse3:a@b:c:d", "--duration", "0.1"}),
              HasSubstr("inverse3"));
  EXPECT_THAT(refused({"check", "free.toml", "--device", "/none/omni.urdf"}),
              HasSubstr("/none/omni.urdf: no such file"));
}

TEST_F(SharedOptions, KeepOutputsApartHoweverTheyAreWritten) {
  fs::create_directory("below");
  EXPECT_NO_THROW(keep_outputs_apart("--record", "a.h5", "--video", "b.mp4"));
  EXPECT_NO_THROW(keep_outputs_apart("--record", "", "--video", "b.mp4"));
  EXPECT_NO_THROW(keep_outputs_apart("--record", "a.h5", "--video", ""));
  for (const fs::path& same : {fs::path("a.h5"), fs::path("below/../a.h5"), fs::absolute("a.h5")}) {
    try {
      keep_outputs_apart("--record", "a.h5", "--video", same);
      ADD_FAILURE() << same;
    } catch (const UsageError& error) {
      EXPECT_EQ(error.what(),
                "--video " + same.string() + ": --record writes this file; name another file");
    }
  }
}

// A terminal in place of standard input.
class Keyboard {
 public:
  Keyboard() : before_(dup(STDIN_FILENO)) {
    std::cin.clear();
    EXPECT_EQ(openpty(&master_, &terminal_, nullptr, nullptr, nullptr), 0);
    dup2(terminal_, STDIN_FILENO);
  }
  ~Keyboard() {
    dup2(before_, STDIN_FILENO);
    for (const int each : {before_, terminal_, master_}) close(each);
  }
  Keyboard(const Keyboard&) = delete;
  Keyboard& operator=(const Keyboard&) = delete;
  void type(const std::string& text) const {
    EXPECT_EQ(write(master_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
    EXPECT_TRUE(test::until([] {
      pollfd in{STDIN_FILENO, POLLIN, 0};
      return poll(&in, 1, 1) > 0;
    }));
  }

 private:
  int before_, master_ = -1, terminal_ = -1;
};

TEST(AQuestion, WaitsForEnterAndForgetsWhatWasTypedBefore) {
  const Keyboard keyboard;
  keyboard.type("too early\n");
  int turns = 0;
  testing::internal::CaptureStdout();
  const bool begun = await_enter("Enter begins: ", [&] {
    if (++turns == 3) keyboard.type("\n");
    return turns < 1000;
  });
  const std::string said = testing::internal::GetCapturedStdout();
  EXPECT_TRUE(begun);
  EXPECT_GE(turns, 3);
  EXPECT_EQ(said, "Enter begins: ");
  turns = 0;
  testing::internal::CaptureStdout();
  EXPECT_FALSE(await_enter("Enter begins: ", [&] { return ++turns < 5; }));
  testing::internal::GetCapturedStdout();
  EXPECT_EQ(turns, 5) << "until it is given up";
}

TEST(AQuestion, IsNotAnsweredByTheEndOfInput) {
  const int before = dup(STDIN_FILENO), nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, STDIN_FILENO);
  testing::internal::CaptureStdout();
  EXPECT_THROW(await_enter("? ", [] { return true; }), UsageError);
  testing::internal::GetCapturedStdout();
  std::cin.clear();
  dup2(before, STDIN_FILENO);
  close(before);
  close(nothing);
}

}  // namespace
}  // namespace limpid
