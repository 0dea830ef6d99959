// The line of progress.
#include "app/cli/progress.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <chrono>
#include <thread>

namespace limpid {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

const Progress::Words kRun{"run", 30, "s", "times real time"};

TEST(ALineOfProgress, SaysHowMuchHowFastAndHowLongStill) {
  // 12.3 s of 30 in 0.3 s of work are 41 times as fast; 17.7 s are left, at that rate 0.43 s.
  EXPECT_EQ(progress_line(kRun, 12.3, 0.3),
            "run: 41 %, 12.3 of 30.0 s, 41 times real time, 1 s left");
  EXPECT_EQ(progress_line(kRun, 15, 10),
            "run: 50 %, 15.0 of 30.0 s, 1.5 times real time, 10 s left");
  EXPECT_EQ(progress_line({"sweep", 4, "", "runs a second"}, 1, 100),
            "sweep: 25 %, 0.01 runs a second, 5 min 0 s left");
}

TEST(ARate, HasTwoDigits) {
  EXPECT_EQ(rate_text(0.36), "0.36");
  EXPECT_EQ(rate_text(0.98), "1.0");
  EXPECT_EQ(rate_text(5.04), "5.0");
  EXPECT_EQ(rate_text(9.97), "10");
  EXPECT_EQ(rate_text(412.3), "412");
}

TEST(ALineOfProgress, SaysNoRateBeforeAnythingIsDone) {
  EXPECT_EQ(progress_line(kRun, 0, 5), "run: 0 %, 0.0 of 30.0 s");
  EXPECT_EQ(progress_line(kRun, 3, 0), "run: 10 %, 3.0 of 30.0 s");
}

TEST(ALineOfProgress, IsNeverRoundedUpToTheEnd) {
  EXPECT_THAT(progress_line(kRun, 29.99, 1), testing::StartsWith("run: 99 %"));
  EXPECT_THAT(progress_line(kRun, 30, 1), HasSubstr("100 %"));
  EXPECT_THAT(progress_line(kRun, 31, 1), HasSubstr("100 %"));
}

TEST(ALineOfProgress, HasSecondsMinutesAndHours) {
  // The rate is one unit a second: as many seconds are left.
  const auto left = [](double seconds) {
    const std::string line = progress_line({"x", seconds + 1, "", "r"}, 1, 1);
    return line.substr(line.rfind("r, ") + 3);
  };
  EXPECT_EQ(left(119), "119 s left");
  EXPECT_EQ(left(119.5), "2 min 0 s left") << "never too little";
  EXPECT_EQ(left(125), "2 min 5 s left");
  EXPECT_EQ(left(7199), "119 min 59 s left");
  EXPECT_EQ(left(7200), "2 h 0 min left");
  EXPECT_EQ(left(10000), "2 h 46 min left");
}

// A terminal of 40 columns in place of standard error.
TEST(ALineOfProgress, IsShownOnATerminalAndGoesAtTheEnd) {
  int master = -1, terminal = -1;
  const winsize size{.ws_row = 24, .ws_col = 40, .ws_xpixel = 0, .ws_ypixel = 0};
  ASSERT_EQ(openpty(&master, &terminal, nullptr, nullptr, &size), 0);
  fcntl(master, F_SETFL, O_NONBLOCK);
  const auto read_all = [&] {
    std::string all;
    char piece[4096];
    for (ssize_t n = 0; (n = read(master, piece, sizeof piece)) > 0;) {
      all.append(piece, static_cast<std::size_t>(n));
    }
    return all;
  };
  const int before = dup(STDERR_FILENO);
  dup2(terminal, STDERR_FILENO);
  std::string early, shown, late;
  {
    Progress progress(kRun);
    progress.at(15);
    std::this_thread::sleep_for(600ms);
    early = read_all();
    for (int i = 0; i < 100 && shown.find("of 30.0") == std::string::npos; ++i) {
      std::this_thread::sleep_for(50ms);
      shown += read_all();
    }
  }
  late = read_all();
  dup2(before, STDERR_FILENO);
  close(before);
  close(terminal);
  close(master);
  EXPECT_EQ(early, "") << "short work needs no line";
  EXPECT_THAT(shown, HasSubstr("\rrun: 50 %, 15.0 of 30.0 s, "));
  EXPECT_LE(shown.substr(shown.rfind("\rrun")).size(), 40u) << "cut off where the terminal ends";
  EXPECT_EQ(late.find_first_not_of("\r "), std::string::npos) << "wiped off: " << late;
  EXPECT_TRUE(late.ends_with("\r"));
}

}  // namespace
}  // namespace limpid
