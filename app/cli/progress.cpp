#include "app/cli/progress.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <iostream>
#include <mutex>
#include <vector>

#include "app/cli/options.h"

namespace limpid {
namespace {

bool line_typed() {
  pollfd in{STDIN_FILENO, POLLIN, 0};
  if (poll(&in, 1, 0) <= 0) return false;
  std::string line;
  if (!std::getline(std::cin, line)) throw UsageError("not begun");
  return true;
}

using Seconds = std::chrono::duration<double>;

// Columns that a line may fill on standard error; 79 if it is no terminal. Leaves one column free:
// a full line would wrap and leave something behind.
std::size_t terminal_width() {
  winsize size{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
  return known ? size.ws_col - 1u : 79u;
}

std::string duration(double seconds) {
  const auto s = static_cast<long>(std::min(std::ceil(seconds), 1e9));
  if (s < 120) return fmt::format("{} s", s);
  if (s < 7200) return fmt::format("{} min {} s", s / 60, s % 60);
  return fmt::format("{} h {} min", s / 3600, s % 3600 / 60);
}

// Writes a line over the last one, `before` letters long; returns its own length.
std::size_t write_over(std::size_t before, std::string line) {
  line.resize(std::min(line.size(), terminal_width()));
  fmt::print(stderr, "\r{:{}}\r{}", "", std::min(before, terminal_width()), line);
  std::fflush(stderr);
  return line.size();
}

}  // namespace

bool await_enter(const std::string& prompt, const std::function<bool()>& meanwhile) {
  tcflush(STDIN_FILENO, TCIFLUSH);
  fmt::print("{}", prompt);
  std::fflush(stdout);
  while (!line_typed()) {
    if (!meanwhile()) return false;
  }
  return true;
}

std::string progress_line(const Progress::Words& words, double done, double seconds) {
  const double part = std::clamp(done / words.whole, 0.0, 1.0);
  std::string line = fmt::format("{}: {:.0f} %", words.title, std::floor(100 * part));
  if (!words.unit.empty()) {
    line += fmt::format(", {:.1f} of {:.1f} {}", done, words.whole, words.unit);
  }
  if (part <= 0 || seconds <= 0) return line;
  const double rate = done / seconds;
  return line + fmt::format(", {} {}, {} left", rate_text(rate), words.rate,
                            duration((words.whole - done) / rate));
}

std::string rate_text(double rate) {
  return fmt::format("{:.{}f}", rate, rate < 0.95 ? 2 : rate < 9.95 ? 1 : 0);
}

Progress::Progress(Words words) : words_(std::move(words)) {
  if (isatty(STDERR_FILENO) != 0) thread_ = std::jthread([this](auto stop) { show(stop); });
}

void Progress::show(const std::stop_token& stop) const {
  using namespace std::chrono_literals;
  auto began = std::chrono::steady_clock::now();
  std::mutex mutex;
  std::unique_lock lock(mutex);
  std::condition_variable_any over;
  const auto over_within = [&](Seconds time) {
    over.wait_for(lock, stop, time, [] { return false; });
    return stop.stop_requested();
  };
  if (over_within(1s)) return;
  double before = 0;
  std::size_t length = 0;
  do {
    const double done = done_.load(std::memory_order_relaxed);
    if (done < before) began = std::chrono::steady_clock::now();
    before = done;
    const Seconds elapsed = std::chrono::steady_clock::now() - began;
    length = write_over(length, progress_line(words_, done, elapsed.count()));
  } while (!over_within(200ms));
  write_over(length, "");
}

}  // namespace limpid
