// A figure as data, drawn alike in table, picture and report.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/style/law_colours.h"

namespace limpid {

struct FigurePoint {
  double x = 0, y = 0;
  double low = 0, high = 0;  // of a band
};

// A rectangle in a map, coloured by its value.
struct FigureCell {
  double x_low = 0, x_high = 0, y_low = 0, y_high = 0;
  double value = 0;
};

struct Series {
  enum class Style { line, dashed, points, band, cells };

  std::string label;  // empty: not in the legend
  std::string color;  // "#rrggbb"
  Style style = Style::line;
  std::vector<FigurePoint> points;
  std::vector<FigureCell> cells = {};  // of a map, whose label stands at the bar of colours
  double width = 1.8;                  // of a line; wider for those that lie under another one [px]
  const char* dash = "1";              // of a line, as gnuplot names it: "1" none, "(long,gap,...)"
  int mark = 7;                        // of points, as gnuplot counts them: 7 a disc
};

// A pair of axes with its curves.
struct FigurePanel {
  std::string title = {};
  std::string x_label = {}, y_label = {};  // with unit
  bool log_x = false, log_y = false;
  std::optional<std::pair<double, double>> x_range = {}, y_range = {};
  std::vector<std::pair<double, std::string>> x_ticks = {};   // in place of numbers
  std::optional<std::pair<double, double>> value_range = {};  // of a map's colours
  std::vector<Series> series = {};
};

struct Figure {
  std::string title;
  std::string caption;  // the settings used
  int columns = 1;
  int panel_height = 420;  // [px], of 640 px width
  std::vector<FigurePanel> panels;
  std::string made_by = {};  // line from provenance(); SVG and PNG keep it
};

// Okabe and Ito's colours for the paper's quantities, as everywhere in the program.
inline constexpr const char* kDeviceInk = "#E69F00";
inline constexpr const char* kProxyInk = "#0072B2";
inline constexpr const char* kHandInk = "#009E73";
inline constexpr const char* kContactInk = "#D55E00";
inline constexpr const char* kEnergyInk = "#CC79A7";
inline constexpr const char* kNeutralInk = "#555555";
// Colours of the couplings; a variant of a coupling is a tint.
inline constexpr const char* kStandardInk = kLawColours[0].on_light;
inline constexpr const char* kProposedInk = kLawColours[1].on_light;
inline constexpr const char* kProposedTint = kLawColours[1].tint;
inline constexpr const char* kPredictiveInk = kLawColours[2].on_light;
inline constexpr const char* kPredictiveTint = kLawColours[2].tint;
inline constexpr const char* kTankInk = kLawColours[3].on_light;
// Colours for a family of curves, such as values of eta.
inline constexpr const char* kFamilyInk[] = {"#0072B2", "#E69F00", "#009E73",
                                             "#D55E00", "#CC79A7", "#56B4E9"};

// Text of data as printed: "eta w^2" -> "η ω²".
std::string typeset(const std::string& text);
// Writes DIR/NAME.csv with what is plotted: panel,series,x,y,low,high. Errors: FileError.
void write_figure_data(const Figure& figure, const std::filesystem::path& csv);
// A picture that gnuplot draws: `terminal` is its format, `scale` its pixels per pixel of the
// layout.
struct FigureFile {
  std::string terminal;
  double scale = 1;
  std::filesystem::path out;
};
// Commands for gnuplot that draw the figure into each of the files.
std::string gnuplot_script(const Figure& figure, std::span<const FigureFile> files);
// Draws DIR/NAME.png and DIR/NAME.svg with gnuplot. Errors: std::runtime_error when gnuplot is
// missing or fails.
void draw_figure(const Figure& figure, const std::filesystem::path& dir, const std::string& name);

// Writes a report as a web page, for the screen and for paper. `body`: HTML, of <section>s with
// <header>, <figure>, <table>; classes: soft, number, verdict, passed, failed. `summary`: a
// sentence, after version and time. Errors: FileError.
void write_page(const std::filesystem::path& file, const std::string& title,
                const std::string& summary, const std::string& body);

}  // namespace limpid
