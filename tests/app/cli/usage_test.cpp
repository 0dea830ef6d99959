// Words of the command line: help, versions, guesses, refusals, completions and manual pages.
#include <algorithm>
#include <regex>
#include <set>

#include "tests/app/cli/said.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using test::lines_of;
using test::Said;
using testing::Contains;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

const std::vector<std::string> kCommands{
    "run",     "serve",   "experiment", "sweep",  "analyze", "characterize", "check", "info",
    "recover", "devices", "identify",   "doctor", "story",   "play",         "manual"};

class Usage : public test::Program {};

// Words of a help in an order of their own: which of several options an option excludes comes first
// differs from call to call.
std::vector<std::string> words_in_order(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  std::ranges::sort(words);
  return words;
}

TEST_F(Usage, OfEveryCommandHasHelpAndTheVersion) {
  const std::string all = done({"--help"});
  for (const std::string& command : kCommands) {
    EXPECT_THAT(all, HasSubstr("\n  " + command + " ")) << command;
    const std::string help = done({command, "--help"});
    EXPECT_THAT(help, HasSubstr("limpid " + command + " ")) << command;
    EXPECT_EQ(words_in_order(done({"help", command})), words_in_order(help));
    EXPECT_TRUE(
        std::regex_match(done({command, "--version"}), std::regex("limpid \\d+\\.\\d+.*\n")));
  }
  EXPECT_THAT(all, HasSubstr("Exit status: 0 done; 1 the run failed"));
  EXPECT_EQ(done({"help"}), all);
  EXPECT_EQ(done({"-V"}), done({"--version"}));
  EXPECT_THAT(all, Not(HasSubstr("share")));
}

// A file of this name is opened in place of the help.
TEST_F(Usage, OfHelpIsAboutOneCommandAtMost) {
  EXPECT_THAT(refused({"help", "run", "info"}), HasSubstr("\"info\": not expected"));
}

TEST_F(Usage, FitsIntoTheColumnsOfATerminal) {
  for (const std::string& command : kCommands) {
    const std::string help = done({command, "--help"});
    const std::string options = help.substr(0, help.find("\n\n", help.find("Options:")));
    for (const std::string& line : lines_of(options)) EXPECT_LE(line.size(), 110u) << line;
  }
  const std::string help = done({"run", "--help"});
  const std::string keys = help.substr(help.find("Keys for --set"));
  // A line of a meaning, not of a list of words that goes on below itself.
  const auto meaning = [](const std::string& line) {
    return line.starts_with("      ") && line[6] != ' ';
  };
  for (const std::string& line : lines_of(keys)) {
    const auto letters = std::ranges::count_if(line, [](char c) { return (c & 0xc0) != 0x80; });
    EXPECT_TRUE(!line.starts_with("      ") || letters <= 79) << line;
  }
  // A paragraph's lines are as long as they can be: the next word has no room in them.
  const std::vector<std::string> lines = lines_of(keys);
  for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
    if (!meaning(lines[i]) || !meaning(lines[i + 1])) continue;
    const std::string next = lines[i + 1].substr(6, lines[i + 1].find(' ', 6) - 6);
    EXPECT_GT(lines[i].size() + 1 + next.size(), 79u) << lines[i] << "|" << next;
  }
}

TEST_F(Usage, OfParametersNamesDefaultsAndWhatIsAllowed) {
  const std::string help = done({"analyze", "--help"});
  EXPECT_TRUE(
      std::regex_search(help, std::regex("coupling\\.kind +default \\S+ +standard,\\s+proposed,\\s+"
                                         "predictive,\\s+tank,\\s+direct,\\s+eba,\\s+popc,"
                                         "\\s+wave,\\s+tdpn,\\s+sfa\n")));
  EXPECT_TRUE(
      std::regex_search(help, std::regex("observer\\.anti_windup +default true +true, false")));
  EXPECT_TRUE(
      std::regex_search(help, std::regex("hand\\.stiffness +default [0-9.]+ +\\S+ to \\S+ N/m")));
  EXPECT_TRUE(std::regex_search(help, std::regex("device\\.torque_limit +default the arm's ")));
}

TEST_F(Usage, GuessesWhatIsNearlyRight) {
  for (const auto& [words, meant] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"anlyze"}, "analyze"},
           {{"rnu"}, "run"},
           {{"run", "--sene", "table.toml"}, "--scene"},
           {{"run", "--sene=table.toml"}, "--scene"},
           {{"run", "--scene", "tabel.toml"}, "table.toml"},
           {{"check", "stak.toml"}, "stack.toml"},
           {{"story", "frst.toml"}, "first.toml"},
           {{"sweep", "tiny.tml", "--out", "x"}, "tiny.toml"},
           {{"info", "tabel.h5"}, "table.h5"},
           {{"experiment", "inerta", "--out", "x"}, "inertia"}}) {
    EXPECT_THAT(refused(words), HasSubstr("did you mean " + meant + "?"));
  }
  EXPECT_THAT(refused({"--hand", "tuch.csv"}), HasSubstr("\"--hand\": not expected here"));
  for (const char* far : {"banana", "--banana"}) {
    EXPECT_THAT(refused({far}), Not(HasSubstr("did you mean")));
  }
  EXPECT_THAT(refused({"banana"}), HasSubstr("\"banana\": neither a command"));
  EXPECT_THAT(
      refused({"run", "more", "words"}),
      HasSubstr("\"more words\": not expected here; `limpid run --help` lists what is allowed"));
}

TEST_F(Usage, HasEveryOptionBehindItsCommand) {
  EXPECT_THAT(refused({"--scene", "table.toml", "run"}),
              HasSubstr("--scene: stands before the command; write limpid run --scene ..."));
  EXPECT_THAT(refused({"--ui-scale", "1", "run"}),
              HasSubstr("--ui-scale: is an option of the window, and limpid run opens no window"));
  EXPECT_THAT(refused({"table.toml", "run"}), HasSubstr("must not stand before the command run"));
  EXPECT_THAT(refused({"table.toml", "play", "table.h5"}),
              HasSubstr("stands before the command play"));
}

TEST_F(Usage, RefusesValuesThatAreNone) {
  for (const char* option :
       {"--record", "--scene", "--hand", "--coupling", "--set", "--duration"}) {
    EXPECT_THAT(refused({"run", option, ""}), HasSubstr("allowed: a"));
  }
  for (const char* wrong : {"-1", "0", "1s", "nan", "90000"}) {
    EXPECT_THAT(refused({"run", "--duration", wrong}),
                HasSubstr("allowed: a number above 0, up to 86400 s"));
  }
  for (const char* wrong : {"-1", "1.5", "many", "18446744073709551616"}) {
    EXPECT_THAT(refused({"run", "--seed", wrong}),
                HasSubstr("allowed: a whole number from 0 to 18446744073709551615"));
  }
  EXPECT_THAT(refused({"analyze", "--band", "2000000"}), HasSubstr("up to 1000000 Hz"));
  EXPECT_THAT(refused({"analyze", "--mass", "0"}), HasSubstr("up to 1000000 kg m^2"));
  EXPECT_THAT(refused({"run", "--eta", "few"}), HasSubstr("coupling.eta"));
  EXPECT_THAT(refused({"run", "--set", "coupling.ets=1"}), HasSubstr("coupling.eta"));
}

TEST_F(Usage, OfACommandBelowAnotherIsThatOfAllCommands) {
  EXPECT_EQ(done({"devices", "look", "--version"}), done({"--version"}));
  EXPECT_THAT(refused({"devices", "look", "--record", ""}), HasSubstr("allowed: a"));
}

// Words offered behind `words`; what stands behind a tab is their meaning.
std::vector<std::string> offered(const std::string& out) {
  std::vector<std::string> words;
  for (const std::string& line : lines_of(out)) words.push_back(line.substr(0, line.find('\t')));
  return words;
}

TEST_F(Usage, IsCompletedWordByWord) {
  const auto complete = [](std::vector<std::string> words) {
    words.insert(words.begin(), "complete");
    return done(words);
  };
  for (const std::string& command : kCommands) {
    EXPECT_THAT(offered(complete({""})), Contains(command));
    EXPECT_THAT(offered(complete({command, "--"})), Contains("--help"));
  }
  EXPECT_THAT(offered(complete({""})), Not(Contains("share")));
  EXPECT_THAT(offered(complete({"run", "--"})), Contains("--record"));
  EXPECT_THAT(offered(complete({"analyze", "--"})), Not(Contains("--record")));
  const std::vector<std::string> laws{"standard", "proposed", "predictive", "tank", "direct",
                                      "eba",      "popc",     "wave",       "tdpn", "sfa"};
  EXPECT_EQ(offered(complete({"run", "--coupling", ""})), laws);
  EXPECT_EQ(offered(complete({"run", "--coupling="})), laws);
  EXPECT_EQ(complete({"run", "--scene", ""}), "\tfiles .toml\n");
  EXPECT_EQ(complete({"run", "--hand", ""}), "\tfiles .csv .h5\n");
  EXPECT_EQ(complete({"run", "--device", ""}), "\tfiles .urdf\n");
  EXPECT_EQ(complete({"info", ""}), "\tfiles .h5\n");
  EXPECT_EQ(complete({"sweep", "x.toml", "--out", ""}), "\tfolders\n");
  EXPECT_EQ(complete({"play", "x.h5", "--video", ""}), "\tfiles .mp4 .gif\n");
  EXPECT_THAT(complete({"check", ""}), HasSubstr(".glb"));
  EXPECT_THAT(complete({"check", ""}), HasSubstr(".urdf .toml"));
  const auto keys = offered(complete({"run", "--set", ""}));
  EXPECT_THAT(keys, Contains("hand.stiffness="));
  EXPECT_THAT(keys, Contains("coupling.kind=tank"));
  EXPECT_THAT(keys, Contains("observer.anti_windup=false"));
  const auto experiments = offered(complete({"experiment", ""}));
  EXPECT_THAT(experiments, Contains("all"));
  EXPECT_THAT(experiments, Contains("stack"));
  EXPECT_THAT(offered(complete({"identify", ""})), Contains("simulated"));
  EXPECT_THAT(offered(complete({"devices", ""})), Contains("look"));
  EXPECT_THAT(offered(complete({"devices", "look", "-"})), Contains("--record"));
  EXPECT_EQ(complete({"devices", "look", "--record", ""}), "\tfiles .h5\n");
  // Values that can be anything, names chosen freely, and what is unknown.
  EXPECT_EQ(complete({}), "");
  EXPECT_EQ(complete({"serve", ""}), "");
  EXPECT_EQ(complete({"run", "--duration", ""}), "");
  EXPECT_EQ(complete({"nothing", "--what", ""}), "");
  EXPECT_EQ(complete({"run", "--what=", ""}), "");
  // A flag takes no value, and a name that is given is not asked for again.
  EXPECT_EQ(complete({"experiment", "all", ""}), "");
  EXPECT_EQ(offered(complete({"run", "--force", "--coupling", ""})), laws);
}

TEST_F(Usage, IsInManualPages) {
  EXPECT_EQ(done({"share", "made"}), "");
  std::set<std::string> pages;
  for (const auto& page : fs::directory_iterator("made/man/man1")) {
    pages.insert(page.path().filename().string());
  }
  std::set<std::string> expected{"limpid.1", "limpid-devices-look.1"};
  for (const std::string& command : kCommands) expected.insert("limpid-" + command + ".1");
  EXPECT_EQ(pages, expected);
  const std::string all = test::text_of("made/man/man1/limpid.1");
  EXPECT_THAT(all, StartsWith(".TH LIMPID 1 \"\" \"Limpid "));
  EXPECT_THAT(all, HasSubstr(".SH NAME\nlimpid \\- touch a virtual world"));
  EXPECT_THAT(all, HasSubstr(".SH COMMANDS\n"));
  EXPECT_THAT(all, HasSubstr(".SH FILES\n"));
  for (const std::string& command : kCommands) {
    EXPECT_THAT(all, HasSubstr("\\fBlimpid\\-" + command + "\\fR(1)"));
    const std::string page = test::text_of("made/man/man1/limpid-" + command + ".1");
    for (const char* part : {".SH NAME\n", ".SH SYNOPSIS\n", ".SH OPTIONS\n"}) {
      EXPECT_THAT(page, HasSubstr(part)) << command;
    }
    const bool alone = command != "devices";
    const std::string look = alone ? "" : ",\n\\fBlimpid\\-devices\\-look\\fR(1)";
    EXPECT_THAT(page, EndsWith(".SH SEE ALSO\n\\fBlimpid\\fR(1)" + look + "\n")) << command;
    EXPECT_EQ(page.find(".SH COMMANDS") == std::string::npos, alone) << command;
  }
  const std::string look = test::text_of("made/man/man1/limpid-devices-look.1");
  EXPECT_THAT(look,
              HasSubstr("\\fBlimpid devices look\\fR [\\fIOPTION\\fR]... [\\fIDEVICE\\fR]\n"));
  EXPECT_THAT(look, EndsWith(".SH SEE ALSO\n\\fBlimpid\\-devices\\fR(1)\n"));
  const std::string run = test::text_of("made/man/man1/limpid-run.1");
  EXPECT_THAT(run, HasSubstr(".TH LIMPID\\-RUN 1 "));
  EXPECT_THAT(run, HasSubstr("\\fBlimpid run\\fR [\\fIOPTION\\fR]...\n"));
  EXPECT_THAT(run, HasSubstr(".TP\n\\fB\\-\\-record\\fR \\fIOUT.h5\\fR\nwrite every tick"));
  EXPECT_THAT(run, HasSubstr(".SH NOTES\n.nf\nFILE.csv has"));
  const std::string check = test::text_of("made/man/man1/limpid-check.1");
  EXPECT_THAT(check, HasSubstr("[\\fIOPTION\\fR]... \\fIFILE\\fR\n")) << "it is required";
  const std::string story = test::text_of("made/man/man1/limpid-story.1");
  EXPECT_THAT(story, HasSubstr("]... [\\fIFILE.toml\\fR]\n")) << "it may be left out";
  EXPECT_THAT(story, HasSubstr(" Not with \\-\\-check, \\-\\-record."));
  EXPECT_THAT(story, HasSubstr(" Only with \\-\\-video."));
}

TEST_F(Usage, HasIconsOfEverySize) {
  done({"share", "made"});
  const fs::path icons = "made/icons/hicolor";
  EXPECT_THAT(test::text_of(icons / "scalable/apps/limpid.svg"), HasSubstr("<svg"));
  for (const unsigned size : {16u, 22u, 24u, 32u, 48u, 64u, 128u, 256u, 512u}) {
    const std::string name = std::to_string(size) + "x" + std::to_string(size);
    const std::string png = test::text_of(icons / name / "apps/limpid.png");
    ASSERT_GT(png.size(), 24u) << name;
    const auto number = [&](std::size_t at) {  // of four bytes, the highest first
      unsigned value = 0;
      for (std::size_t i = at; i < at + 4; ++i)
        value = 256 * value + static_cast<unsigned char>(png[i]);
      return value;
    };
    EXPECT_EQ(number(16), size);
    EXPECT_EQ(number(20), size);
  }
}

}  // namespace
}  // namespace limpid
