#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/experiments/figure.h"

namespace limpid {
namespace {

// The layout, in pixels: the figure's title on top, in each panel's cell the panel's title, its
// legend and the axes.
constexpr int kPanelWidth = 640;
constexpr int kTitleHeight = 52;
constexpr int kLeft = 84, kRight = 26, kBottom = 58;  // from the axes to the cell's edges
constexpr int kPanelTitle = 34, kLegendLine = 19;
constexpr double kLetter = 6.6, kSample = 52;         // widths in a legend

// Nothing in single quotes means anything to gnuplot but the quote itself.
std::string quoted(const std::string& text) {
  std::string safe = "'";
  for (const char c : text) {
    if (c == '\'') safe += '\'';
    safe += c == '\n' ? ' ' : c;
  }
  return safe + '\'';
}

// Letters, not bytes of UTF-8.
double letters(const std::string& text) {
  return static_cast<double>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  }));
}

// How many legend entries fit side by side, and how many lines they take then.
struct Legend {
  int columns = 1, lines = 0;
};

Legend legend_of(const FigurePanel& panel) {
  double widest = 0;
  int entries = 0;
  for (const Series& series : panel.series) {
    if (series.label.empty() || series.points.empty()) continue;
    widest = std::max(widest, letters(series.label) * kLetter + kSample);
    ++entries;
  }
  if (entries == 0) return {};
  const int fit = std::max(1, static_cast<int>((kPanelWidth - kLeft - kRight) / widest));
  const int columns = std::min(fit, entries);
  return {columns, (entries + columns - 1) / columns};
}

std::string range_text(const std::optional<std::pair<double, double>>& range) {
  return range ? fmt::format("[{}:{}]", range->first, range->second) : "[*:*]";
}

std::string plot_words(const Series& series, const std::string& data) {
  const std::string end = fmt::format(
      "lc rgb '{}' {}", series.color,
      series.label.empty() ? "notitle" : "title " + quoted(series.label));
  switch (series.style) {
    case Series::Style::line: return data + " using 1:2 with lines lw 1.8 " + end;
    case Series::Style::dashed: return data + " using 1:2 with lines lw 1.8 dt (7,4) " + end;
    case Series::Style::points: return data + " using 1:2 with points pt 7 ps 0.35 " + end;
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
      text += "EOD\n";
    }
  }
  return text;
}

// Title and legend stand above the axes, where no curve can lie under them.
std::string heading(const FigurePanel& panel, const Legend& legend, double x, double top,
                    double width, double height) {
  const double key = top + 6 / height;
  const double title = key + (legend.lines * kLegendLine + 10) / height;
  std::string text = fmt::format(
      "unset label\nset label 1 {} at screen {},{} left noenhanced font ',13'\n",
      quoted(panel.title), x, title);
  if (legend.lines == 0) return text + "unset key\n";
  return text + fmt::format("set key at screen {},{} left bottom Left reverse horizontal "
                            "noenhanced samplen 2.2 width 1.5 maxcols {} font ',11'\n",
                            x - 6 / width, key, legend.columns);
}

std::string plot_command(const FigurePanel& panel, int first_block) {
  std::string plots;
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    if (panel.series[i].points.empty()) continue;
    plots += (plots.empty() ? "" : ", ") +
             plot_words(panel.series[i], fmt::format("$d{}", first_block + static_cast<int>(i)));
  }
  return "plot " + (plots.empty() ? "NaN notitle" : plots) + '\n';
}

}  // namespace

std::string gnuplot_script(const Figure& figure, const std::string& terminal, double scale,
                           const std::filesystem::path& out) {
  const int columns = std::max(1, figure.columns);
  const int count = static_cast<int>(figure.panels.size());
  const int rows = (count + columns - 1) / columns;
  const double width = columns * kPanelWidth;
  const double height = rows * figure.panel_height + kTitleHeight;
  std::string text = fmt::format(
      "set encoding utf8\nset terminal {} size {},{} font 'Inter,{}'{} background rgb 'white'\n"
      "set output {}\n",
      terminal, width * scale, height * scale, 12,
      scale == 1 ? "" : fmt::format(" fontscale {0} linewidth {0} pointscale {0}", scale),
      quoted(out.string()));
  text += data_blocks(figure);
  text += fmt::format("set multiplot title {} noenhanced font ',16'\n", quoted(figure.title));
  text += "set border 3 lc rgb '#444444' lw 0.8\nset tics nomirror scale 0.6 font ',11'\n"
          "set grid lc rgb '#e2e2e2' lw 0.6 dt 1 back\nset tics textcolor rgb '#222222'\n";
  int block = 0;
  for (int i = 0; i < count; ++i) {
    const FigurePanel& panel = figure.panels[static_cast<std::size_t>(i)];
    const Legend legend = legend_of(panel);
    const double left = (i % columns) * kPanelWidth + kLeft;
    const double right = (i % columns + 1) * kPanelWidth - kRight;
    const int row = i / columns;
    const double top = height - kTitleHeight - row * figure.panel_height - kPanelTitle -
                       legend.lines * kLegendLine;
    const double bottom = height - kTitleHeight - (row + 1) * figure.panel_height + kBottom;
    text += fmt::format("set margins screen {},{},{},{}\n", left / width, right / width,
                        bottom / height, top / height);
    text += heading(panel, legend, left / width, top / height, width, height);
    text += fmt::format(
        "set xlabel {} noenhanced offset 0,0.3\nset ylabel {} noenhanced offset 0.5,0\n",
        quoted(panel.x_label), quoted(panel.y_label));
    text += panel.log_x ? "set logscale x\n" : "unset logscale x\n";
    text += panel.log_y ? "set logscale y\nset format y '10^{%L}'\n"
                        : "unset logscale y\nset format y '%g'\n";
    text += fmt::format("set xrange {}\nset yrange {}\n", range_text(panel.x_range),
                        range_text(panel.y_range));
    text += plot_command(panel, block);
    block += static_cast<int>(panel.series.size());
  }
  return text + "unset multiplot\n";
}

}  // namespace limpid
