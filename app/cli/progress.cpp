#include "app/cli/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>

namespace limpid {
namespace {

using Seconds = std::chrono::duration<double>;

std::string duration(double seconds) {
  const auto s = static_cast<long>(std::min(std::ceil(seconds), 1e9));
  if (s < 120) return fmt::format("{} s", s);
  if (s < 7200) return fmt::format("{} min {} s", s / 60, s % 60);
  return fmt::format("{} h {} min", s / 3600, s % 3600 / 60);
}

// A line as wide as the terminal would wrap, and leave something behind.
std::size_t room() {
  winsize size{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
  return known ? size.ws_col - 1u : 79u;
}

// Over the lines above the progress line, whose number it is given; returns how many there are.
std::size_t draw_over(std::size_t before, const std::vector<std::string>& lines) {
  if (before > 0) fmt::print(stderr, "\r\x1b[{}A", before);
  for (const std::string& line : lines) fmt::print(stderr, "\x1b[K{}\n", line);
  fmt::print(stderr, "\x1b[J");
  return lines.size();
}

// In place of what stood there, whose length it is given; returns its own.
std::size_t write_over(std::size_t before, std::string line) {
  line.resize(std::min(line.size(), room()));
  fmt::print(stderr, "\r{:{}}\r{}", "", std::min(before, room()), line);
  std::fflush(stderr);
  return line.size();
}

}  // namespace

std::string progress_line(const Progress::Words& words, double done, double seconds) {
  const double part = std::clamp(done / words.whole, 0.0, 1.0);
  std::string line = fmt::format("{}: {:.0f} %", words.title, std::floor(100 * part));
  if (!words.unit.empty()) {
    line += fmt::format(", {:.1f} of {:.1f} {}", done, words.whole, words.unit);
  }
  if (part <= 0 || seconds <= 0) return line;
  const double rate = done / seconds;
  return line + fmt::format(", {:.{}f} {}, {} left", rate, rate < 10 ? 1 : 0, words.rate,
                            duration((words.whole - done) / rate));
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
  std::size_t length = 0, above = 0;
  do {
    if (words_.picture) above = draw_over(above, words_.picture());
    const double done = done_.load(std::memory_order_relaxed);
    if (done < before) began = std::chrono::steady_clock::now();
    before = done;
    const Seconds elapsed = std::chrono::steady_clock::now() - began;
    length = write_over(length, progress_line(words_, done, elapsed.count()));
  } while (!over_within(200ms));
  write_over(length, "");
  if (above > 0) draw_over(above, {});
}

}  // namespace limpid
