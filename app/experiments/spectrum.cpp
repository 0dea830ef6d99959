// Fig. 7: frequency content of the hand's motion in the trials of Fig. 6.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/base/welch.h"
#include "app/experiments/passivity.h"
#include "app/experiments/signals.h"

namespace limpid {
namespace {

constexpr std::size_t kSegment = 2048;  // samples
constexpr double kBand = 5;             // [Hz]
constexpr double kShownBand = 25;       // [Hz]

// Device velocity of each joint.
std::vector<std::vector<double>> velocities(const Session& s) {
  std::vector<std::vector<double>> joints(static_cast<std::size_t>(s.info.dof));
  for (std::size_t k = 0; k < s.size(); ++k) {
    const auto v = s.at(k, Column::device_velocity);
    for (std::size_t i = 0; i < joints.size(); ++i) joints[i].push_back(v[i]);
  }
  return joints;
}

// Spectrum of all joints together.
Spectrum spectrum_of(const std::vector<std::vector<double>>& joints, double rate) {
  Spectrum sum;
  for (const std::vector<double>& signal : joints) {
    const Spectrum one = welch(signal, rate, kSegment);
    sum.step = one.step;
    sum.density.resize(one.density.size());
    for (std::size_t i = 0; i < one.density.size(); ++i) sum.density[i] += one.density[i];
  }
  return sum;
}

double share(const Spectrum& s, double up_to) { return s.power(up_to) / s.power(); }

// Mean, lowest and highest over trials, up to the frequency shown.
std::vector<FigurePoint> spread(const std::vector<Spectrum>& trials,
                                const std::function<double(const Spectrum&, std::size_t)>& value) {
  std::vector<FigurePoint> points;
  for (std::size_t i = 0; static_cast<double>(i) * trials[0].step <= kShownBand; ++i) {
    FigurePoint p{static_cast<double>(i) * trials[0].step, 0, value(trials[0], i),
                  value(trials[0], i)};
    for (const Spectrum& trial : trials) {
      p.y += value(trial, i) / static_cast<double>(trials.size());
      p.low = std::min(p.low, value(trial, i));
      p.high = std::max(p.high, value(trial, i));
    }
    points.push_back(p);
  }
  return points;
}

void add_spread(FigurePanel& panel, const std::vector<FigurePoint>& points, const char* color,
                double lowest, double highest) {
  panel.x_range = {{0, kShownBand}};
  panel.y_range = {{lowest, highest}};
  panel.series.push_back({"lowest to highest trial", color, Series::Style::band, points});
  panel.series.push_back({"mean of all trials", color, Series::Style::line, points});
  panel.series.push_back(
      {"5 Hz", kNeutralInk, Series::Style::dashed, {{kBand, lowest}, {kBand, highest}}});
}

}  // namespace

Outcome spectrum(TrialRunner& lab) {
  std::vector<Trial> trials;
  for (const PassivityCase& one : passivity_cases()) {
    for (Trial& trial : passivity_trials(lab.arm(), one, lab.seed()))
      trials.push_back(std::move(trial));
  }
  std::vector<std::vector<std::vector<double>>> signals(trials.size());
  lab.run(trials, [&](std::size_t i, const TrialResult& result) {
    signals[i] = velocities(result.session);
  });
  const double rate = 1 / trials[0].plan.parameters.tick;
  std::vector<Spectrum> spectra;
  double total = 0, below = 0, least = 1;
  for (const auto& signal : signals) {
    spectra.push_back(spectrum_of(signal, rate));
    total += spectra.back().power();
    below += spectra.back().power(kBand);
    least = worse_low(least, share(spectra.back(), kBand));
  }

  Outcome outcome;
  Figure& figure = outcome.figure;
  figure.title = "Frequency content of the hand's motion";
  figure.caption = fmt::format(
      "Device velocity, all joints together, in the {} trials of the passivity experiment. Welch's "
      "method: half-overlapping Hann windows of {:.3f} s; frequencies {:.2f} Hz apart.",
      trials.size(), kSegment / rate, rate / kSegment);
  figure.columns = 2;
  FigurePanel density{.title = "Power density of the velocity",
                      .x_label = "frequency [Hz]",
                      .y_label = "density [(rad/s)²/Hz]",
                      .log_y = true};
  const std::vector<FigurePoint> points =
      spread(spectra, [](const Spectrum& s, std::size_t i) { return s.density[i]; });
  double lowest = points[0].low, highest = points[0].high;
  for (const FigurePoint& p : points) {
    lowest = std::min(lowest, p.low);
    highest = std::max(highest, p.high);
  }
  add_spread(density, points, kProxyInk, lowest / 2, highest * 2);
  FigurePanel part{.title = "Share of the power up to a frequency",
                   .x_label = "frequency [Hz]",
                   .y_label = "share [-]"};
  add_spread(
      part,
      spread(spectra, [](const Spectrum& s,
                         std::size_t i) { return share(s, static_cast<double>(i) * s.step); }),
      kHandInk, 0, 1.02);
  figure.panels = {density, part};
  outcome.checks = {
      at_least("share of the power of all trials below 5 Hz", below / total, 0.95),
      at_least("share of the power below 5 Hz in the trial where this share is smallest", least,
               0.9),
  };
  return outcome;
}

}  // namespace limpid
