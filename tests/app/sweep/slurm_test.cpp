// Sweeps on many processes, with stand-ins for Slurm's programs.
#include "app/sweep/slurm.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>

#include "tests/app/sweep/plans.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::ContainsRegex;
using testing::HasSubstr;

// Ranks are read from variables that the test sets.
class OwnRank : public testing::Test {
 protected:
  OwnRank() { clear(); }
  ~OwnRank() override { clear(); }
  static void clear() {
    for (const auto& [rank, size] : kVariables) unsetenv(rank), unsetenv(size);
  }
  static void set(std::size_t which, const char* rank, const char* size) {
    clear();
    setenv(kVariables[which].first, rank, 1);
    setenv(kVariables[which].second, size, 1);
  }
  static constexpr std::array<std::pair<const char*, const char*>, 3> kVariables{
      {{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
       {"PMI_RANK", "PMI_SIZE"},
       {"SLURM_PROCID", "SLURM_NTASKS"}}};
};

TEST_F(OwnRank, IsThatOfWhateverStartedThisProcess) {
  EXPECT_FALSE(own_rank());
  for (std::size_t i = 0; i < kVariables.size(); ++i) {
    set(i, "3", "7");
    const auto found = own_rank();
    ASSERT_TRUE(found) << kVariables[i].first;
    EXPECT_EQ(found->rank, 3u);
    EXPECT_EQ(found->size, 7u);
  }
}

TEST_F(OwnRank, IsNoneWhereTheNumbersAreNone) {
  for (const auto& [rank, size] :
       {std::pair("7", "7"), {"8", "7"}, {"x", "7"}, {"3", "7 "}, {"3", ""}, {"-1", "7"}}) {
    set(0, rank, size);
    EXPECT_FALSE(own_rank()) << rank << " of " << size;
  }
  clear();
  setenv("PMI_RANK", "0", 1);
  EXPECT_FALSE(own_rank()) << "nobody says of how many";
}

// Six blocks of four points in a folder whose name needs quoting.
class ASlurmArray : public testing::Test {
 protected:
  ASlurmArray() : path_(std::getenv("PATH")) {
    program("squeue", "echo \"$*\" >>" + at("asked") + "\ncat " + at("queue"));
    program("sbatch", "for w; do printf '%s\\n' \"$w\"; done >" + at("words") + "\nprintf x >>" +
                          at("times") + "\necho 17");
    queue({});
    setenv("PATH", (fs::path(dir_ / "bin").string() + ":" + path_).c_str(), 1);
  }
  ~ASlurmArray() override { setenv("PATH", path_.c_str(), 1); }

  std::string at(const char* file) const { return (dir_ / file).string(); }
  void program(const char* name, const std::string& text) const {
    const fs::path file = dir_ / "bin" / name;
    fs::create_directories(file.parent_path());
    std::ofstream(file) << "#!/bin/sh\n" << text << "\n";
    fs::permissions(file, fs::perms::owner_all);
  }
  void queue(const std::vector<std::uint64_t>& tasks) const {
    std::ofstream out(dir_ / "queue");
    for (const std::uint64_t task : tasks) out << task << '\n';
  }
  // Words that sbatch was last called with, a line each; and how often it was called.
  std::string words() const { return test::bytes_of(dir_ / "words"); }
  std::size_t times() const { return test::bytes_of(dir_ / "times").size(); }
  // A task of the array works: it writes its blocks.
  void work(std::uint64_t task, std::uint64_t tasks) const {
    const std::atomic<bool> stop{false};
    for (std::uint64_t b = task - 1; b < blocks_of(plan_); b += tasks) {
      const SweepBlock block = block_of(plan_, b);
      std::vector<double> rows;
      for (std::uint64_t i = 0; i < block.size; ++i) {
        const auto one = measure_point(plan_, block.first + i, stop);
        rows.insert(rows.end(), one->begin(), one->end());
      }
      folder_.write(block, rows);
    }
  }

  const test::TempDir dir_;
  const std::string path_;
  const SweepPlan plan_ = test::sweep_plan(dir_, test::kShort);
  const SweepFolder folder_{plan_, dir_ / "it's out"};
  SweepBook book_{plan_, folder_, false};
};

TEST_F(ASlurmArray, SubmitsWhatIsMissingAndNotInTheQueue) {
  ASSERT_EQ(blocks_of(plan_), 6u);
  SlurmArray array(plan_, folder_, {.tasks = 4, .options = {"--mem=2G", "--partition=a b"}});
  EXPECT_EQ(array.turn(book_), 0u);
  EXPECT_EQ(test::bytes_of(dir_ / "asked"), "-h -r -o %K -n " + array.name() + "\n");
  const fs::path logs = fs::canonical(folder_.path()) / "slurm";
  EXPECT_EQ(words(), "--parsable\n--job-name=" + array.name() +
                         "\n--array=1-4\n--output=" + (logs / "%A_%a.log").string() +
                         "\n--mem=2G\n--partition=a b\n" + (logs / "job.sh").string() + "\n");
  queue({1, 2, 3, 4});
  EXPECT_EQ(array.turn(book_), 0u);
  EXPECT_EQ(times(), 1u) << "all wait or run";
  work(1, 4);
  work(3, 4);
  queue({4});
  EXPECT_EQ(array.turn(book_), 12u) << "blocks 1, 3 and 5";
  EXPECT_EQ(times(), 2u);
  EXPECT_THAT(words(), HasSubstr("\n--array=2\n")) << "1 and 3 are done, 4 still waits";
  work(2, 4);
  work(4, 4);
  queue({});
  EXPECT_EQ(array.turn(book_), 9u);
  EXPECT_TRUE(book_.complete());
  EXPECT_EQ(times(), 2u);
}

TEST_F(ASlurmArray, HasNoMoreTasksThanBlocks) {
  SlurmArray array(plan_, folder_, {.tasks = 100, .options = {}});
  array.turn(book_);
  EXPECT_THAT(words(), HasSubstr("\n--array=1-6\n"));
}

TEST_F(ASlurmArray, GivesUpATaskThatBringsNothing) {
  SlurmArray array(plan_, folder_, {.tasks = 1, .options = {}});
  for (std::size_t i = 1; i <= SlurmArray::kMostTries; ++i) {
    array.turn(book_);
    EXPECT_EQ(times(), i);
  }
  const auto refusal = [&]() -> std::string {
    try {
      array.turn(book_);
    } catch (const std::runtime_error& e) {
      return e.what();
    }
    return "nothing";
  };
  EXPECT_THAT(refusal(), HasSubstr("task 1 of " + array.name() + " gave no result 3 times"));
  const SweepBlock first = block_of(plan_, 0);
  const auto one = *measure_point(plan_, 0, std::atomic<bool>{false});
  std::vector<double> rows;
  for (std::uint64_t i = 0; i < first.size; ++i) rows.insert(rows.end(), one.begin(), one.end());
  folder_.write(first, rows);
  EXPECT_EQ(array.turn(book_), 4u) << "it brings something after all";
  EXPECT_EQ(times(), SlurmArray::kMostTries + 1u);
}

// The job is this program, with the task's number among all as the shard.
TEST_F(ASlurmArray, RunsThisProgramOnAShard) {
  SlurmArray array(plan_, folder_, {.tasks = 4, .options = {}});
  array.turn(book_);
  const fs::path folder = fs::canonical(folder_.path());
  const std::string script = test::bytes_of(folder / "slurm/job.sh");
  EXPECT_EQ(script.substr(0, script.find('\n')), "#!/bin/sh");
  EXPECT_THAT(script, HasSubstr(fs::canonical("/proc/self/exe").string()));
  EXPECT_THAT(script, HasSubstr(" sweep " + shell_quoted((dir_ / "plan.toml").string())));
  EXPECT_THAT(script, HasSubstr(" --out " + shell_quoted(folder.string())));
  EXPECT_THAT(script, HasSubstr(" --shard \"$SLURM_ARRAY_TASK_ID/4\" "));
}

TEST_F(ASlurmArray, IsAnotherForAnotherNumberOfTasksOrFolder) {
  const SlurmArray one(plan_, folder_, {.tasks = 4, .options = {}}),
      same(plan_, folder_, {.tasks = 4, .options = {}}),
      fewer(plan_, folder_, {.tasks = 3, .options = {}});
  const SweepFolder elsewhere(plan_, dir_ / "elsewhere");
  const SlurmArray other(plan_, elsewhere, {.tasks = 4, .options = {}});
  EXPECT_EQ(one.name(), same.name());
  EXPECT_NE(one.name(), fewer.name());
  EXPECT_NE(one.name(), other.name());
}

TEST_F(ASlurmArray, SaysWhatSlurmRefuses) {
  program("sbatch", "echo 'no such partition' >&2; echo more; exit 1");
  SlurmArray array(plan_, folder_, {});
  try {
    array.turn(book_);
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_STREQ(e.what(), "sbatch: no such partition");
  }
}

TEST(SlurmArrays, AreNamedAsSbatchHasThem) {
  EXPECT_EQ(array_text({1, 2, 3, 7, 9, 10}), "1-3,7,9-10");
  EXPECT_EQ(array_text({4}), "4");
  EXPECT_EQ(shell_quoted("a'b c"), "'a'\\''b c'");
}

}  // namespace
}  // namespace limpid
