#include "app/plot/figure.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/os.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <ctime>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "app/base/markup.h"
#include "app/base/version.h"
#include "app/run/provenance.h"
#include "core/base/png_chunk.h"
#include "core/base/utf8.h"
#include "devices/files/atomic_file.h"
#include "devices/files/text_file.h"

namespace limpid {

namespace {

namespace fs = std::filesystem;

// `text` in quotes for CSV, quotes inside doubled.
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
  // A process group of its own keeps Ctrl-C in the terminal from gnuplot; Limpid ends cleanly.
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

// Puts the line into an SVG or a PNG; false where that cannot be written.
bool add_line(const fs::path& file, const std::string& line) {
  std::ostringstream drawn;
  drawn << std::ifstream(file, std::ios::binary).rdbuf();
  std::string bytes = drawn.str();
  if (file.extension() == ".svg") {
    bytes = with_metadata(bytes, line);
  } else if (bytes.size() > kPngHeader && !line.empty()) {
    bytes.insert(kPngHeader, png_description(line));
  }
  std::ofstream out(file, std::ios::binary);
  out << bytes;
  out.close();
  return !out.fail();
}

// The layout, in pixels: the figure's title on top, in each panel's cell the panel's title, its
// legend and the axes.
constexpr int kPanelWidth = 640;
constexpr int kTitleHeight = 52;
constexpr int kLeft = 92, kRight = 26, kBottom = 58;  // from the axes to the cell's edges
constexpr int kPanelTitle = 38, kLegendLine = 20;
constexpr int kBar = 14, kBarRoom = 104;  // bar of a map's colours; room for it beside the axes
constexpr double kLetter = 6.8, kSample = 26, kGap = 20;  // widths in a legend
constexpr double kYLabel = 20;                            // from the cell's left edge

// Plain spellings and their symbols in print.
constexpr std::pair<const char*, const char*> kSymbols[] = {
    {"eta", "η"}, {"x1", "x₁"}, {"x2", "x₂"},   {"v1", "v₁"},   {"f1", "f₁"},
    {"f2", "f₂"}, {"-", "−"},   {"w_f", "ω_f"}, {"w_c", "ω_c"}, {"w", "ω"}};

// "m^2" -> "m²": raises digits and a minus behind a caret.
std::string with_powers(const std::string& text) {
  constexpr const char* kAbove[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::size_t from = i + (text.compare(i, 2, "^-") == 0 ? 2 : 1);
    const bool digit =
        from < text.size() && std::isdigit(static_cast<unsigned char>(text[from])) != 0;
    if (text[i] != '^' || !digit) {
      out += text[i];
      continue;
    }
    if (from == i + 2) out += "⁻";
    for (i = from; i < text.size() && std::isdigit(static_cast<unsigned char>(text[i])) != 0; ++i) {
      out += kAbove[text[i] - '0'];
    }
    --i;
  }
  return out;
}

std::string symbol_of(const std::string& word) {
  for (const auto& [plain, symbol] : kSymbols) {
    if (word == plain) return symbol;
  }
  return word;
}

// `text` in single quotes for gnuplot, where only the quote itself is special.
std::string quoted(const std::string& text) {
  std::string safe = "'";
  for (const char c : text) {
    if (c == '\'') safe += '\'';
    safe += c == '\n' ? ' ' : c;
  }
  return safe + '\'';
}

std::string printed(const std::string& text) { return quoted(typeset(text)); }

double letters(const std::string& text) { return static_cast<double>(count_characters(text)); }

// An entry of the legend. Entries flow in lines above the axes, where no curve can lie under them;
// gnuplot does not know its own legend's size beforehand.
struct LegendEntry {
  const Series* series;
  double x;  // from the axes' left edge
  int line;
};

std::vector<LegendEntry> legend_of(const FigurePanel& panel) {
  std::vector<LegendEntry> entries;
  double x = 0;
  int line = 0;
  for (const Series& series : panel.series) {
    const bool nothing = series.points.empty() && series.cells.empty();
    // Series without a colour have a bar of colours.
    if (series.label.empty() || series.color.empty() || nothing) continue;
    const double width = kSample + 6 + letters(series.label) * kLetter;
    if (x > 0 && x + width > kPanelWidth - kLeft - kRight) {
      x = 0;
      ++line;
    }
    entries.push_back({&series, x, line});
    x += width + kGap;
  }
  return entries;
}

int lines_of(const std::vector<LegendEntry>& legend) {
  return legend.empty() ? 0 : legend.back().line + 1;
}

std::string range_text(const std::optional<std::pair<double, double>>& range) {
  return range ? fmt::format("[{}:{}]", range->first, range->second) : "[*:*]";
}

// Range with the edges of bands, which gnuplot's own choice leaves out.
std::optional<std::pair<double, double>> y_range(const FigurePanel& panel) {
  if (panel.y_range) return panel.y_range;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Series& series : panel.series) {
    const bool band = series.style == Series::Style::band;
    for (const FigurePoint& p : series.points) {
      for (const double y : {band ? p.low : p.y, band ? p.high : p.y}) {
        if (!std::isfinite(y) || (panel.log_y && y <= 0)) continue;
        low = std::min(low, y);
        high = std::max(high, y);
      }
    }
  }
  if (!(low <= high)) return std::nullopt;
  if (panel.log_y) return std::pair(low / 1.5, high * 1.5);
  const double room = high > low ? 0.05 * (high - low) : std::max(0.05 * std::abs(high), 1e-9);
  return std::pair(low >= 0 && low < room ? 0 : low - room, high + room);
}

// Range of an axis for which a panel has nothing to choose one by; gnuplot draws no panel without.
std::optional<std::pair<double, double>> or_any(
    const FigurePanel& panel, const std::optional<std::pair<double, double>>& range) {
  const bool cells =
      std::ranges::any_of(panel.series, [](const Series& s) { return !s.cells.empty(); });
  if (range || cells || y_range(panel)) return range;
  return std::pair(1.0, 10.0);
}

std::string plot_words(const Series& series, const std::string& data) {
  const std::string end = fmt::format("lc rgb '{}' notitle", series.color);
  switch (series.style) {
    case Series::Style::line:
      return data + fmt::format(" using 1:2 with lines lw {} dt {} ", series.width, series.dash) +
             end;
    case Series::Style::dashed:
      return data + fmt::format(" using 1:2 with lines lw {} dt (7,4) ", series.width) + end;
    case Series::Style::points:
      return data +
             fmt::format(" using 1:2 with points pt {} ps {} ", series.mark,
                         series.mark == 7 ? 0.35 : 0.6) +
             end;
    case Series::Style::cells:
      return data + " using 1:2:3:4:5:6:7 with boxxyerror fs solid noborder " +
             (series.color.empty() ? "fc palette notitle"
                                   : fmt::format("fc rgb '{}' notitle", series.color));
    case Series::Style::band:
      return data + " using 1:3:4 with filledcurves fs transparent solid 0.2 noborder " + end;
  }
  return {};
}

std::string data_blocks(const Figure& figure) {
  std::string text;
  int block = 0;
  for (const FigurePanel& panel : figure.panels) {
    for (const Series& series : panel.series) {
      text += fmt::format("$d{} << EOD\n", block++);
      for (const FigurePoint& p : series.points) {
        text += fmt::format("{:.7g} {:.7g} {:.7g} {:.7g}\n", p.x, p.y, p.low, p.high);
      }
      for (const FigureCell& c : series.cells) {
        text += fmt::format("{0:.7g} {2:.7g} {0:.7g} {1:.7g} {2:.7g} {3:.7g} {4:.7g}\n", c.x_low,
                            c.x_high, c.y_low, c.y_high, c.value);
      }
      text += "EOD\n";
    }
  }
  return text;
}

// Converts pixels, counted from the bottom left, to gnuplot's coordinates.
struct Screen {
  double width, height;
  std::string at(double x, double y) const {
    return fmt::format("screen {:.6f},{:.6f}", x / width, y / height);
  }
};

std::string sample_of(const Series& series, const Screen& screen, double x, double y) {
  const std::string left = screen.at(x, y), right = screen.at(x + kSample, y);
  switch (series.style) {
    case Series::Style::line:
    case Series::Style::dashed:
      return fmt::format(
          "set arrow from {} to {} nohead lw {} {} lc rgb '{}'\n", left, right, series.width,
          series.style == Series::Style::line ? fmt::format("dt {}", series.dash) : "dt (7,4)",
          series.color);
    case Series::Style::points:
      return fmt::format("set label '' at {} point pt {} ps 0.6 lc rgb '{}'\n",
                         screen.at(x + kSample / 2, y), series.mark, series.color);
    case Series::Style::cells:
    case Series::Style::band:
      return fmt::format("set object rectangle from {} to {} fc rgb '{}' fs {} noborder\n",
                         screen.at(x, y - 5), screen.at(x + kSample, y + 5), series.color,
                         series.style == Series::Style::band ? "transparent solid 0.2" : "solid");
  }
  return {};
}

std::string heading(const FigurePanel& panel, const std::vector<LegendEntry>& legend,
                    const Screen& screen, double left, double top) {
  const int lines = lines_of(legend);
  std::string text = fmt::format(
      "unset label\nunset arrow\nunset object\nset label {} at {} left noenhanced font ',13'\n",
      printed(panel.title), screen.at(left, top + 20 + lines * kLegendLine));
  for (const LegendEntry& entry : legend) {
    const double x = left + entry.x, y = top + 14 + (lines - 1 - entry.line) * kLegendLine;
    text += sample_of(*entry.series, screen, x, y);
    text += fmt::format("set label {} at {} left noenhanced font ',11'\n",
                        printed(entry.series->label), screen.at(x + kSample + 6, y));
  }
  return text;
}

std::string plot_command(const FigurePanel& panel, int first_block) {
  std::string plots;
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    if (panel.series[i].points.empty() && panel.series[i].cells.empty()) continue;
    plots += (plots.empty() ? "" : ", ") +
             plot_words(panel.series[i], fmt::format("$d{}", first_block + static_cast<int>(i)));
  }
  return "plot " + (plots.empty() ? "NaN notitle" : plots) + '\n';
}

const Series* map_of(const FigurePanel& panel) {
  const auto found = std::ranges::find_if(panel.series, [](const Series& s) {
    return s.style == Series::Style::cells && s.color.empty();
  });
  return found == panel.series.end() ? nullptr : &*found;
}

// Bar of a map's colours, right of the axes.
std::string colour_bar(const FigurePanel& panel, const Screen& screen, double right, double bottom,
                       double top) {
  const Series* map = map_of(panel);
  if (map == nullptr) return "unset colorbox\n";
  return fmt::format(
      "set colorbox vertical user origin {} size {:.6f},{:.6f} noborder\nset cbrange {}\nset "
      "format cb '%g'\n"
      "set label {} at {} center rotate by 90 noenhanced font ',11'\n",
      screen.at(right + 10, bottom), kBar / screen.width, (top - bottom) / screen.height,
      range_text(panel.value_range), printed(map->label),
      screen.at(right + kBarRoom - 22, (top + bottom) / 2));
}

std::string x_ticks(const FigurePanel& panel) {
  if (panel.x_ticks.empty()) return "set xtics enhanced autofreq\n";
  std::string text;
  for (const auto& [x, name] : panel.x_ticks) {
    text += fmt::format("{}{} {:.7g}", text.empty() ? "" : ", ", printed(name), x);
  }
  return "set xtics noenhanced (" + text + ")\n";
}

// Commands for everything of a panel but its curves, in the cell with the given upper left corner.
std::string panel_commands(const FigurePanel& panel, const Screen& screen, double cell_left,
                           double cell_top, double cell_height) {
  const std::vector<LegendEntry> legend = legend_of(panel);
  const double left = cell_left + kLeft,
               right = cell_left + kPanelWidth - (map_of(panel) ? kBarRoom : kRight);
  const double top = cell_top - kPanelTitle - lines_of(legend) * kLegendLine;
  const double bottom = cell_top - cell_height + kBottom;
  std::string text = fmt::format(
      "set lmargin at screen {:.6f}\nset rmargin at screen {:.6f}\n"
      "set bmargin at screen {:.6f}\nset tmargin at screen {:.6f}\n",
      left / screen.width, right / screen.width, bottom / screen.height, top / screen.height);
  text += heading(panel, legend, screen, left, top);
  text += colour_bar(panel, screen, right, bottom, top) + x_ticks(panel);
  text += fmt::format("set label {} at {} center rotate by 90 noenhanced\n", printed(panel.y_label),
                      screen.at(cell_left + kYLabel, (top + bottom) / 2));
  text += fmt::format("set xlabel {} noenhanced offset 0,0.3\n", printed(panel.x_label));
  text += panel.log_x ? "set logscale x\nset format x '10^{%L}'\n"
                      : "unset logscale x\nset format x '%g'\n";
  text += panel.log_y ? "set logscale y\nset format y '10^{%L}'\n"
                      : "unset logscale y\nset format y '%g'\n";
  return text + fmt::format("set xrange {}\nset yrange {}\n",
                            range_text(or_any(panel, panel.x_range)),
                            range_text(or_any(panel, y_range(panel))));
}

std::string into(const FigureFile& file, const Screen& screen) {
  return fmt::format(
      "set terminal {} size {},{} font 'Inter,12'{} background rgb 'white'\nset output {}\n",
      file.terminal, screen.width * file.scale, screen.height * file.scale,
      file.scale == 1 ? "" : fmt::format(" fontscale {0} linewidth {0} pointscale {0}", file.scale),
      quoted(std::filesystem::absolute(file.out).string()));
}

constexpr const char* kStyle = R"css(
:root { --ink: #1c2126; --soft: #5b6670; --line: #dfe3e7; --good: #00734f; --bad: #b3261e; }
* { box-sizing: border-box; }
body { margin: 0; background: #f3f4f6; color: var(--ink);
       font: 15px/1.5 Inter, "Helvetica Neue", Arial, sans-serif; }
main { max-width: 1080px; margin: 0 auto; padding: 40px 24px 64px; }
h1 { font-size: 28px; margin: 0 0 4px; letter-spacing: -0.01em; }
h2 { font-size: 20px; margin: 0; letter-spacing: -0.01em; }
.soft { color: var(--soft); margin: 0; }
section { background: #fff; border: 1px solid var(--line); border-radius: 10px;
          padding: 24px 28px; margin-top: 28px; }
header { display: flex; justify-content: space-between; align-items: baseline; gap: 16px; }
figure { margin: 18px 0; }
img { display: block; max-width: 100%; height: auto; margin: 0 auto; }
figcaption { color: var(--soft); font-size: 13.5px; margin-top: 8px; }
table { width: 100%; border-collapse: collapse; font-size: 13.5px; }
th { text-align: left; font-weight: 600; color: var(--soft); }
th, td { padding: 6px 10px 6px 0; border-bottom: 1px solid var(--line); vertical-align: top; }
tr:last-child td { border-bottom: 0; }
.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.verdict { font-weight: 600; white-space: nowrap; text-align: right; padding-right: 0; }
.passed { color: var(--good); } .failed { color: var(--bad); }
a { color: inherit; }
@media print {
  body { background: #fff; font-size: 10.5pt; }
  main { max-width: none; padding: 0; }
  section { border: 0; border-radius: 0; padding: 0; margin-top: 10mm; }
  section + section { break-before: page; }
  figure, tr { break-inside: avoid; }
  img { max-height: 190mm; object-fit: contain; }
}
)css";

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
  // Names with the process' number: others may be drawing the same figure.
  const auto part = [&](const char* extension) {
    return dir / fmt::format(".{}.{}{}", name, getpid(), extension);
  };
  constexpr double kForPrint = 1.5;  // 300 dots per inch over a page's text
  const std::array files{FigureFile{"pngcairo", kForPrint, part(".png")},
                         FigureFile{"svg", 1, part(".svg")}};
  const fs::path script = part(".gnuplot");
  std::ofstream(script) << gnuplot_script(figure, files);
  bool drawn = gnuplot(script) == 0;
  std::error_code failure, none;
  fs::remove(script, none);
  for (const FigureFile& file : files) drawn = drawn && add_line(file.out, figure.made_by);
  for (const FigureFile& file : files) {
    const fs::path out = dir / (name + file.out.extension().string());
    if (drawn) fs::rename(file.out, out, failure);
    if (drawn && !failure) continue;
    for (const FigureFile& each : files) fs::remove(each.out, none);
    throw std::runtime_error(
        fmt::format("{}: gnuplot could not draw it; is the disk full?", out.string()));
  }
}

// Replaces whole words, lone minus signs and apostrophes. (gnuplot misreads texts that begin with a
// quoted apostrophe.)
std::string typeset(const std::string& text) {
  std::string out, word;
  for (const char c : with_powers(text) + ' ') {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-') {
      word += c;
      continue;
    }
    out += symbol_of(word) + (c == '\'' ? std::string("’") : std::string(1, c));
    word.clear();
  }
  out.pop_back();
  return out;
}

std::string gnuplot_script(const Figure& figure, std::span<const FigureFile> files) {
  const int columns = std::max(1, figure.columns);
  const int rows = (static_cast<int>(figure.panels.size()) + columns - 1) / columns;
  const Screen screen{static_cast<double>(columns * kPanelWidth),
                      static_cast<double>(rows * figure.panel_height + kTitleHeight)};
  std::string panels =
      fmt::format("set multiplot title {} noenhanced font ',16'\n", printed(figure.title));
  int block = 0, at = 0;
  for (const FigurePanel& panel : figure.panels) {
    const int column = at % columns, row = at++ / columns;
    const double top = screen.height - kTitleHeight - row * figure.panel_height;
    panels += panel_commands(panel, screen, column * kPanelWidth, top, figure.panel_height) +
              plot_command(panel, block);
    block += static_cast<int>(panel.series.size());
  }
  std::string text = "set encoding utf8\n" + data_blocks(figure) +
                     "unset key\nset palette defined (0 '#440154', 1 '#3b528b', 2 '#21918c', 3 "
                     "'#5ec962', 4 '#fde725')\nset border 3 lc rgb '#444444' lw 0.8\n"
                     "set tics nomirror scale 0.6 font ',11' textcolor rgb '#222222'\n"
                     "set grid lc rgb '#d8d8d8' lw 0.7 dt 1 back\n";
  for (const FigureFile& file : files) text += into(file, screen) + panels + "unset multiplot\n";
  return text + "set output\n";  // closes the last one
}

void write_page(const std::filesystem::path& file, const std::string& title,
                const std::string& summary, const std::string& body) {
  const std::string text = fmt::format(
      R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Limpid: {1}</title><style>{0}</style></head><body><main>
<h1>{1}</h1>
<p class="soft">Limpid {2}, {3:%e %B %Y, %H:%M}. {4}</p>
{5}</main></body></html>
)",
      kStyle, escaped(title), program_version(), fmt::localtime(std::time(nullptr)),
      escaped(summary), body);
  const std::string wrong = try_write_atomically(file, text);
  if (!wrong.empty()) throw FileError(wrong);
}

}  // namespace limpid
