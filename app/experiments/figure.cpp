#include "app/experiments/figure.h"

#include <fmt/format.h>
#include <fmt/os.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <system_error>

#include "devices/files/file_error.h"

namespace limpid {
namespace {

constexpr int kPanelWidth = 640, kPanelHeight = 420;  // [px]

std::string quoted(const std::string& text) {
  std::string safe = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') safe += '\\';
    safe += c == '\n' ? ' ' : c;
  }
  return safe + '"';
}

std::string range_text(const std::optional<std::pair<double, double>>& range) {
  return range ? fmt::format("[{}:{}]", range->first, range->second) : "[*:*]";
}

std::string plot_words(const Series& series, const std::string& data) {
  const std::string title =
      series.label.empty() ? "notitle" : "title " + quoted(series.label);
  const char* color = series.color.c_str();
  switch (series.style) {
    case Series::Style::line:
      return fmt::format("{} using 1:2 with lines lw 2 lc rgb '{}' {}", data, color, title);
    case Series::Style::dashed:
      return fmt::format("{} using 1:2 with lines lw 2 dt 2 lc rgb '{}' {}", data, color, title);
    case Series::Style::points:
      return fmt::format("{} using 1:2 with points pt 7 ps 0.6 lc rgb '{}' {}", data, color, title);
    case Series::Style::band:
      return fmt::format("{} using 1:3:4 with filledcurves fs transparent solid 0.18 noborder "
                         "lc rgb '{}' {}", data, color, title);
  }
  return {};
}

// gnuplot's commands for the whole figure, the data inline.
std::string script(const Figure& figure, const std::string& terminal,
                   const std::filesystem::path& out) {
  const int columns = std::max(1, figure.columns);
  const int count = static_cast<int>(figure.panels.size());
  const int rows = (count + columns - 1) / columns;
  std::string text = fmt::format("set encoding utf8\nset terminal {} size {},{} font 'Inter,12'\n",
                                 terminal, columns * kPanelWidth, rows * kPanelHeight + 60);
  text += fmt::format("set output {}\n", quoted(out.string()));
  int block = 0;
  for (const FigurePanel& panel : figure.panels) {
    for (const Series& series : panel.series) {
      text += fmt::format("$d{} << EOD\n", block++);
      for (const FigurePoint& p : series.points) {
        text += fmt::format("{:.9g} {:.9g} {:.9g} {:.9g}\n", p.x, p.y, p.low, p.high);
      }
      text += "EOD\n";
    }
  }
  text += fmt::format(
      "set multiplot layout {},{} title {} font 'Inter,15' margins char 11,3,4,4 spacing char 13,6\n",
      rows, columns, quoted(figure.title));
  text += "set border 3 lc rgb '#555555'\nset tics nomirror\nset grid lc rgb '#dddddd' lw 1\n"
          "set key top right opaque box lc rgb '#dddddd' samplen 2 font ',10'\n";
  block = 0;
  for (const FigurePanel& panel : figure.panels) {
    text += fmt::format("set title {} noenhanced\nset xlabel {} noenhanced\nset ylabel {} noenhanced\n",
                        quoted(panel.title), quoted(panel.x_label), quoted(panel.y_label));
    text += panel.log_x ? "set logscale x\n" : "unset logscale x\n";
    text += panel.log_y ? "set logscale y\n" : "unset logscale y\n";
    text += fmt::format("set xrange {}\nset yrange {}\nset key noenhanced\nplot ",
                        range_text(panel.x_range), range_text(panel.y_range));
    for (std::size_t i = 0; i < panel.series.size(); ++i) {
      if (i > 0) text += ", ";
      text += plot_words(panel.series[i], fmt::format("$d{}", block++));
    }
    text += '\n';
  }
  text += "unset multiplot\n";
  return text;
}

void run_gnuplot(const std::string& commands, const std::filesystem::path& out) {
  std::FILE* pipe = popen("gnuplot 2>/dev/null", "w");
  if (pipe == nullptr) throw std::runtime_error("gnuplot could not be started");
  std::fwrite(commands.data(), 1, commands.size(), pipe);
  const int status = pclose(pipe);
  if (status != 0) {
    throw std::runtime_error(fmt::format(
        "{}: gnuplot did not draw it (status {}); is gnuplot-nox installed and the disk not full?",
        out.string(), WEXITSTATUS(status)));
  }
}

}  // namespace

void write_figure_data(const Figure& figure, const std::filesystem::path& csv) {
  try {
    auto file = fmt::output_file(csv.string());
    file.print("panel,series,x,y,low,high\n");
    for (const FigurePanel& panel : figure.panels) {
      for (const Series& series : panel.series) {
        for (const FigurePoint& p : series.points) {
          file.print("\"{}\",\"{}\",{},{},{},{}\n", panel.title, series.label, p.x, p.y, p.low,
                     p.high);
        }
      }
    }
    file.close();
  } catch (const std::system_error& e) {
    throw FileError(fmt::format("{}: {}", csv.string(), e.what()));
  }
}

void draw_figure(const Figure& figure, const std::filesystem::path& dir, const std::string& name) {
  for (const auto& [terminal, extension] :
       {std::pair("pngcairo", ".png"), std::pair("svg enhanced", ".svg")}) {
    const std::filesystem::path out = dir / (name + extension);
    run_gnuplot(script(figure, terminal, out), out);
  }
}

}  // namespace limpid
