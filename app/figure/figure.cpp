#include "app/figure/figure.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/os.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include "devices/files/file_error.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

// As CSV spells text: in quotes, quotes inside doubled.
std::string csv_text(const std::string& text) {
  std::string safe = "\"";
  for (const char c : text) {
    if (c == '"') safe += '"';
    safe += c;
  }
  return safe + '"';
}

double middle(double low, double high, bool logarithmic) {
  return logarithmic ? std::sqrt(low * high) : (low + high) / 2;
}

// Runs `gnuplot FILE`, quietly. Returns the exit status; -1 when it did not end by itself.
int gnuplot(const fs::path& file) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  // In a process group of its own: Ctrl-C in the terminal is for Limpid, which ends cleanly.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  std::string program = "gnuplot", argument = file.string();
  char* const words[] = {program.data(), argument.data(), nullptr};
  pid_t child = 0;
  const int failure = posix_spawnp(&child, "gnuplot", &actions, &attributes, words, environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (failure == ENOENT) {
    throw std::runtime_error(
        "gnuplot, which draws the figures, is not installed; on Debian: "
        "apt-get install gnuplot-nox");
  }
  if (failure != 0) {
    throw std::runtime_error("gnuplot could not be started: " +
                             std::generic_category().message(failure));
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

void write_figure_data(const Figure& figure, const fs::path& csv) {
  try {
    auto file = fmt::output_file(csv.string());
    file.print("panel,series,x,y,low,high\n");
    for (const FigurePanel& panel : figure.panels) {
      for (const Series& series : panel.series) {
        const std::string names = csv_text(panel.title) + ',' + csv_text(series.label);
        for (const FigurePoint& p : series.points) {
          file.print("{},{},{},{},{}\n", names, p.x, p.y, p.low, p.high);
        }
        for (const FigureCell& c : series.cells) {
          file.print("{},{},{},{},{}\n", names, middle(c.x_low, c.x_high, panel.log_x),
                     middle(c.y_low, c.y_high, panel.log_y), c.value, c.value);
        }
      }
    }
    file.close();
  } catch (const std::system_error& e) {
    throw FileError(fmt::format("{}: {}", csv.string(), e.what()));
  }
}

void draw_figure(const Figure& figure, const fs::path& dir, const std::string& name) {
  // Others may be drawing the same.
  const auto part = [&](const char* extension) {
    return dir / fmt::format(".{}.{}{}", name, getpid(), extension);
  };
  constexpr double kForPrint = 1.5;  // 300 dots per inch over a page's text
  const std::array files{FigureFile{"pngcairo", kForPrint, part(".png")},
                         FigureFile{"svg", 1, part(".svg")}};
  const fs::path script = part(".gnuplot");
  std::ofstream(script) << gnuplot_script(figure, files);
  const int status = gnuplot(script);
  std::error_code failure, none;
  fs::remove(script, none);
  for (const FigureFile& file : files) {
    const fs::path out = dir / (name + file.out.extension().string());
    if (status == 0) fs::rename(file.out, out, failure);
    if (status == 0 && !failure) continue;
    for (const FigureFile& each : files) fs::remove(each.out, none);
    throw std::runtime_error(
        fmt::format("{}: gnuplot could not draw it; is the disk full?", out.string()));
  }
}

}  // namespace limpid
