// The folder for results, and whose files a command writes over.
#include "app/cli/out_folder.h"

#include "app/cli/options.h"
#include "app/experiments/live.h"
#include "tests/app/cli/said.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using test::text_of;
using testing::AllOf;
using testing::HasSubstr;

TEST(TheFolderForResults, IsMadeAndTried) {
  const test::TempDir dir;
  prepare_out(dir / "a/b");
  EXPECT_TRUE(fs::is_directory(dir / "a/b"));
  EXPECT_TRUE(fs::is_empty(dir / "a/b")) << "what it was tried with is gone";
  EXPECT_NO_THROW(prepare_out(dir / "a/b")) << "it is there already";
}

TEST(TheFolderForResults, IsRefusedWhereItCannotBeWritten) {
  const test::TempDir dir;
  std::ofstream(dir / "file") << "x";
  for (const fs::path& at :
       {fs::path(dir / "file"), fs::path(dir / "file/below"), fs::path("/proc/limpid-out")}) {
    try {
      prepare_out(at);
      ADD_FAILURE() << at << " was taken";
    } catch (const UsageError& error) {
      EXPECT_THAT(error.what(), testing::StartsWith("--out " + at.string() + ": "));
    }
  }
  EXPECT_FALSE(fs::exists("/proc/limpid-out"));
}

class Results : public test::Program {
 protected:
  // The reason why `words` did nothing to the file.
  std::string refused_for(const std::string& file, const std::vector<std::string>& words) {
    fs::create_directories(fs::path(file).parent_path());
    write(file.c_str(), "mine");
    const std::string why = refused(words);
    EXPECT_EQ(text_of(file), "mine");
    return why;
  }
};

TEST_F(Results, OfAnExperimentReplaceNoForeignFile) {
  const std::vector<std::string> words{"experiment", "inertia", "--out", "o"};
  for (const std::string file : {"o/inertia.csv", "o/report.html"}) {
    EXPECT_THAT(
        refused_for(file, words),
        AllOf(HasSubstr("--out o: no mark shows that " + fs::path(file).filename().string()),
              HasSubstr("was written by limpid experiment; "), HasSubstr("--force")));
    fs::remove(file);
  }
  write("o/notes.txt", "mine");
  done(words);
  EXPECT_THAT(text_of("o/limpid.txt"), testing::StartsWith("limpid experiment\n"));
  EXPECT_THAT(done(words), HasSubstr("inertia: passed")) << "its own results it may replace";
  EXPECT_EQ(text_of("o/notes.txt"), "mine");
  EXPECT_THAT(refused_for("o/passivity.csv", {"experiment", "passivity", "--out", "o"}),
              HasSubstr("passivity.csv"))
      << "another experiment of the same folder";
  EXPECT_THAT(refused_for("q/limpid.txt", {"experiment", "inertia", "--out", "q"}),
              HasSubstr("limpid.txt was not written by Limpid"));
  fs::create_directory("p");
  write("p/inertia.csv", "mine");
  done({"experiment", "inertia", "--out", "p", "--force"});
  EXPECT_NE(text_of("p/inertia.csv"), "mine");
}

TEST_F(Results, OfOneCommandAreForeignToAnother) {
  done({"experiment", "inertia", "--out", "o"});
  EXPECT_THAT(refused({"characterize", "omni.urdf", "--out", "o"}),
              HasSubstr("was written by limpid characterize omni; "));
  EXPECT_THAT(refused({"identify", "simulated", "--out", "o"}),
              HasSubstr("was written by limpid identify simulated; "));
}

TEST_F(Results, OfAPersonsTrialsAreKept) {
  const std::string trials = "o/" + live_name(live_experiments().front());
  EXPECT_THAT(refused_for(trials + "/a.h5", {"experiment", "all", "--out", "o", "--live", "--yes"}),
              AllOf(HasSubstr("is a trial of an earlier session"), HasSubstr("--force")));
}

TEST_F(Results, OfASweepReplaceNoForeignTable) {
  write("plan.toml", R"(title = "Two"
scene = "free.toml"
hand = { at = [0.19, 0, 0], jump = [2e-4, 2e-4, 2e-4] }
seconds = 0.02
measure = ["stable"]
[[axis]]
key = "coupling.eta"
values = [0.5, 1]
)");
  const std::vector<std::string> words{"sweep", "plan.toml", "--out", "o", "--csv"};
  for (const std::string file : {"o/table.csv", "o/figure.png"}) {
    EXPECT_THAT(refused_for(file, words), HasSubstr("was written by limpid sweep; "));
    fs::remove(file);
  }
  done(words);
  done(words);
}

}  // namespace
}  // namespace limpid
