// A video's process beside a window, played by this program: it is what is started again.
#include "app/desktop/playback/film_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include "tests/support/temp_dir.h"
#include "tests/support/until.h"

namespace limpid {
namespace {

using namespace std::chrono_literals;

volatile std::sig_atomic_t interrupts = 0;

void say(const char* line) {
  std::printf("%s\n", line);
  std::fflush(stdout);
}

// Plays `limpid play SESSION --video OUT`; the session's name says how it goes.
int play(const std::vector<std::string>& words) {
  const std::string& how = words.at(2);
  std::ofstream out(words.at(4));
  if (how == "words") {
    for (const std::string& word : words) out << word << '\n';
    const bool eased = test::until([] { return getpriority(PRIO_PROCESS, 0) >= 10; });
    out << (eased ? "at its ease\n" : "urgent\n");
    return 0;
  }
  if (how == "fails") {
    say("0.5");
    say("a warning");
    say("there is no such session");
    return 1;
  }
  if (how == "dies") raise(SIGKILL);
  if (how == "waits") {
    std::signal(SIGTERM, [](int) { interrupts = interrupts + 1; });
    say("0.25");
    test::until([] { return interrupts != 0; });
    std::this_thread::sleep_for(400ms);  // it clears up
    out << interrupts;
    return 1;
  }
  for (const char* part : {"0.125", "0.75"}) say(part);
  return 0;
}

class AFilm : public testing::Test {
 protected:
  bool make(const char* how) { return film_beside(how, out_, {"--speed", "2"}, stop_, part_); }
  std::string written() const {
    std::ifstream in(out_);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  const test::TempDir dir_;
  const std::filesystem::path out_ = dir_ / "video.mp4";
  std::atomic<bool> stop_ = false;
  std::atomic<double> part_ = 0;
};

TEST_F(AFilm, IsMadeByThisProgramAtLowPriority) {
  EXPECT_TRUE(make("words"));
  EXPECT_EQ(written(), "limpid\nplay\nwords\n--video\n" + out_.string() +
                           "\n--print-progress\n--speed\n2\nat its ease\n");
}

TEST_F(AFilm, TellsHowFarItIs) {
  EXPECT_TRUE(make("goes well"));
  EXPECT_EQ(part_, 0.75);
}

// Programs that a script begins with `&` ignore SIGINT, and so do their children.
TEST_F(AFilm, IsStoppedOnceAndClearsUpAlsoWhereSigintIsIgnored) {
  const auto usual = std::signal(SIGINT, SIG_IGN);
  bool made = true;
  std::thread film([&] { made = make("waits"); });
  EXPECT_TRUE(test::until([&] { return part_ == 0.25; })) << "it is told while it goes on";
  stop_ = true;
  film.join();
  std::signal(SIGINT, usual);
  EXPECT_FALSE(made);
  EXPECT_EQ(written(), "1") << "interrupts, when it has cleared up";
}

TEST_F(AFilm, SaysWhyItFailed) {
  const auto why = [&](const char* how) -> std::string {
    try {
      make(how);
    } catch (const std::runtime_error& e) {
      return e.what();
    }
    return "nothing";
  };
  EXPECT_EQ(why("fails"), "there is no such session");
  EXPECT_EQ(part_, 0.5);
  EXPECT_THAT(why("dies"), testing::HasSubstr("ended too early"));
}

// The system's own words say why no process can be begun.
TEST_F(AFilm, SaysWhyItsProcessCannotBegin) {
  const auto why = [&](const std::vector<std::string>& options) -> std::string {
    try {
      film_beside("goes well", out_, options, stop_, part_);
    } catch (const std::runtime_error& e) {
      return e.what();
    }
    return "nothing";
  };
  const int priority = getpriority(PRIO_PROCESS, 0);
  EXPECT_EQ(why({"--too-long", std::string(1 << 20, 'x')}),
            std::string("the video cannot be made: ") + std::strerror(E2BIG));
  rlimit files{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &files), 0);
  rlimit none = files;
  none.rlim_cur = 3;
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
  const std::string without_files = why({});
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &files), 0);
  EXPECT_EQ(without_files, std::string("the video cannot be made: ") + std::strerror(EMFILE));
  EXPECT_EQ(getpriority(PRIO_PROCESS, 0), priority) << "the window's own";
  EXPECT_EQ(why({}), "nothing") << "it goes well again";
}

// Each film leaves as many files open as there were before.
TEST_F(AFilm, LeavesNoFileOpen) {
  const auto open_files = [] {
    const std::filesystem::directory_iterator all("/proc/self/fd");
    return std::distance(begin(all), end(all));
  };
  const auto before = open_files();
  for (const char* how : {"goes well", "words"}) EXPECT_TRUE(make(how));
  EXPECT_ANY_THROW(make("fails"));
  EXPECT_EQ(open_files(), before);
}

}  // namespace
}  // namespace limpid

int main(int count, char** words) {
  if (count > 4 && std::string(words[1]) == "play") {
    return limpid::play({words, words + count});
  }
  testing::InitGoogleMock(&count, words);
  return RUN_ALL_TESTS();
}
