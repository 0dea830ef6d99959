#include "app/stage/plot_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <set>
#include <span>

#include "app/run/lane_settings.h"
#include "core/tick/arming.h"
#include "render/theme.h"

namespace limpid {
namespace {

struct Scale {
  std::string_view unit;
  double smallest_span;
  std::vector<PlotUnit> units;
};

// Returns how quantities of a unit are written, and the least span of an axis for them.
const Scale& scale_of(std::string_view unit) {
  static const std::array scales{
      Scale{"rad", 20e-3, {{"mrad", 1e3, 1}, {"rad", 1, 1e9}}},
      Scale{"J", 1e-3, {{"mJ", 1e3, 1}, {"J", 1, 1e9}}},
      Scale{"m", 1e-3, {{"mm", 1e3, 1}, {"m", 1, 1e9}}},
      Scale{"s", 1e-4, {{"\xC2\xB5s", 1e6, 1e-3}, {"ms", 1e3, 1}, {"s", 1, 1e9}}},
      Scale{"N m", 0.05, {}},
      Scale{"N", 0.1, {}},
      Scale{"rad/s", 0.05, {}},
      Scale{"", 1e-2, {}},
  };
  const auto* found = std::ranges::find(scales, unit, &Scale::unit);
  return found == scales.end() ? scales.back() : *found;
}

// Returns the axis for these channels; different units stand beside one another, unscaled.
PlotAxis axis_for(const std::vector<ChannelInfo>& shown, bool log) {
  PlotAxis axis{.zero_line = false, .smallest_span = 1, .log = log};
  if (shown.empty()) return axis;
  std::set<std::string> units;
  for (const ChannelInfo& info : shown) {
    if (info.unit != "-" && units.insert(info.unit).second) {
      axis.unit += (axis.unit.empty() ? "" : ", ") + info.unit;
    }
    axis.zero_line = axis.zero_line || info.zero;
  }
  if (units.size() > 1) {
    axis.smallest_span = 1e-2;
    return axis;
  }
  const Scale& scale = scale_of(axis.unit);
  axis.units = scale.units;
  axis.smallest_span = log ? 1 : scale.smallest_span;
  return axis;
}

// Gives the curve a colour that no other curve has.
void tell_apart(Curve& curve, const std::vector<Curve>& others) {
  const auto taken = [&] {
    return std::ranges::any_of(others, [&](const Curve& other) {
      return other.ink == curve.ink && other.shade == curve.shade;
    });
  };
  const auto first = static_cast<int>(Ink::joint_1), last = static_cast<int>(Ink::joint_7);
  for (const float shade : {curve.shade, 0.45f, -0.45f}) {
    curve.shade = shade;
    if (!taken()) return;
    for (int i = first; i <= last; ++i) {
      Curve other = curve;
      other.ink = static_cast<Ink>(i);
      if (std::ranges::any_of(others, [&](const Curve& o) { return o.ink == other.ink; })) continue;
      curve.ink = other.ink;
      return;
    }
  }
}

// Returns the channel of a run's law.
int law_channel(std::size_t run, const TraceChannels& channels) {
  return static_cast<int>(Channel::kind) + static_cast<int>(run) * channels.count();
}

// Returns the shade of this colour that is farthest from those that curves have.
float free_shade(Ink ink, std::span<const Curve> others) {
  float best = 0, farthest = -1;
  for (int i = 15; i >= -11; --i) {
    const float shade = 0.05f * static_cast<float>(i);
    float nearest = 2;
    for (const Curve& other : others) {
      if (other.ink == ink) nearest = std::min(nearest, std::abs(other.shade - shade));
    }
    if (nearest <= farthest) continue;
    farthest = nearest;
    best = shade;
  }
  return best;
}

// Returns the curve of the same channel of a further run. A plot of one thing has the colours of
// the runs' laws, lighter where they are the same; a plot of several those of the things.
Curve of_run(std::size_t run, const Curve& first, bool only, std::span<const Curve> others,
             const TraceChannels& channels, const RunNames& names) {
  Curve curve = first;
  const int offset = static_cast<int>(run) * channels.count();
  curve.channel += offset;
  if (curve.across >= 0) curve.across += offset;
  curve.sign = names.beside ? sign_of_lane(run) : RunSign::ring;
  const float lighter = std::clamp(first.shade + kLaneShades[run], -1.0f, 1.0f);
  if (names.beside) {
    const auto before = std::span(names.laws).first(std::min(run, names.laws.size()));
    const bool another = curve.law >= 0 && std::ranges::count(before, names.law(run)) == 0;
    if (curve.law >= 0) curve.law = names.law(run);
    if (curve.law >= 0) curve.law_channel = law_channel(run, channels);
    if (!another) curve.shade = lighter;
  } else if (only) {
    curve.law = names.law(run);
    curve.law_channel = curve.law >= 0 ? law_channel(run, channels) : -1;
    curve.ink = Ink::rerun;
    curve.shade = curve.law >= 0 && curve.law == first.law ? lighter : 0;
  } else {
    curve.shade = free_shade(curve.ink, others);
  }
  return curve;
}

std::string slug(const std::string& title) {
  std::string text;
  for (const char c : title) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 && c > 0;
    if (plain) {
      text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else if (!text.empty() && text.back() != '-') {
      text += '-';
    }
  }
  while (text.ends_with('-')) text.pop_back();
  return text.empty() ? "plot" : text;
}

// Returns the band that shows when force was off or reduced.
Band force_band(int channel) {
  Band band{.channel = channel, .names = {""}, .striped = true};
  for (std::uint8_t i = 1; *explain(ForceState{i}) != '\0'; ++i) {
    band.names.push_back(force_text(ForceState{i}));
  }
  return band;
}

// Returns the word of a run in bands; empty for a single run.
std::string word_of(std::size_t run, const RunNames& names) {
  if (!names.several()) return {};
  if (!names.beside) return run == kMainLane ? "recorded" : "re-run";
  if (names.names.size() == 2) return run == kMainLane ? "left" : "right";
  return fmt::format("run {}", run + 1);
}

// Returns the band of a run's law. Of several runs each has an edge of its own; one that was
// recorded keeps its tint beside a re-run.
Band law_band(std::size_t run, const TraceChannels& channels, const RunNames& names) {
  Band laws{
      .channel = law_channel(run, channels), .tint = 0.12f, .laws = true, .key = "coupling.kind"};
  if (names.several()) {
    if (names.beside || run != kMainLane) laws.lane = static_cast<int>(run);
    laws.key = (run == kMainLane ? "" : lane_mark(run)) + laws.key;
  }
  const std::string word = word_of(run, names);
  for (std::uint8_t i = 0; i < kLaws; ++i) {
    laws.names.push_back((word.empty() ? "" : word + " ") + info(CouplingKind{i}).key);
  }
  return laws;
}

// Returns bands for the laws of runs, for motors at their limit, and for missing force.
std::vector<Band> bands(const TraceChannels& channels, const RunNames& names) {
  std::vector<Band> bands;
  const std::size_t runs = std::max<std::size_t>(1, names.names.size());
  for (std::size_t run = 0; run < runs; ++run) {
    bands.push_back(law_band(run, channels, names));
  }
  bands.push_back(force_band(*channels.find("device/force_state")));
  for (std::size_t run = 0; run < runs; ++run) {
    const int channel =
        static_cast<int>(Channel::limited) + static_cast<int>(run) * channels.count();
    const std::string word = word_of(run, names);
    bands.push_back(
        {channel, {"", "motor at its limit" + (word.empty() ? "" : " (" + word + ")")}});
  }
  return bands;
}

}  // namespace

const char* name(PlotKind kind) {
  constexpr std::array kNames{"time", "cross", "spectrum"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::vector<int> laws_at(const Session& session, double time) {
  std::vector<int> laws;
  const double row = std::clamp(time / session.info.tick + 0.5, 0.0, 1e15);
  const auto law = [&](const Session& run) {
    const std::size_t k = std::min(static_cast<std::size_t>(row), run.size() - 1);
    return static_cast<int>(run.at(k, Column::kind)[0]);
  };
  for (std::size_t i = 0; i < session.lanes(); ++i) {
    const Session& lane = session.lane(i);
    laws.push_back(lane.size() > 0 ? law(lane) : -1);
  }
  return laws;
}

RunNames run_names(std::span<const Parameters> lanes) {
  RunNames names{.beside = lanes.size() > 1};
  if (names.beside) names.names = lane_names(lanes);
  for (const Parameters& p : lanes) names.laws.push_back(static_cast<int>(p.kind));
  return names;
}

std::vector<PlotChoice> default_plots() {
  return {
      {.title = "coordination error", .channels = {"coordination/error"}},
      {.title = "controller energy",
       .channels = {"energy/controller_total", "energy/controller_commanded"}},
      {.title = "human and contact torque",
       .channels = {"hand/torque_norm", "hand/torque_estimate_norm", "proxy/contact_torque_norm"}},
      {.title = "error against torque",
       .kind = PlotKind::cross,
       .across = "proxy/contact_torque_norm",
       .channels = {"coordination/error"}}};
}

std::vector<PlotChoice> simple_plots() {
  return {{.title = "coordination error", .channels = {"coordination/error"}},
          {.title = "controller energy", .channels = {"energy/controller_total"}},
          {.title = "human and contact torque",
           .channels = {"hand/torque_norm", "proxy/contact_torque_norm"}}};
}

std::string title_of(const PlotChoice& choice, const TraceChannels& channels) {
  if (!choice.title.empty()) return choice.title;
  const auto label = [&](const std::string& key) {
    const auto channel = channels.find(key);
    return channel ? channels.infos()[static_cast<std::size_t>(*channel)].label : key;
  };
  std::string title;
  for (const std::string& key : choice.channels) {
    title += (title.empty() ? "" : ", ") + label(key);
  }
  if (title.empty()) return "empty plot";
  if (choice.kind == PlotKind::cross) return title + " against " + label(choice.across);
  return choice.kind == PlotKind::spectrum ? "spectrum of " + title : title;
}

PlotSpec plot_spec(const PlotChoice& choice, const TraceChannels& channels, const RunNames& names) {
  PlotSpec spec{.title = title_of(choice, channels), .kind = choice.kind};
  spec.file_name = slug(spec.title);
  const auto at = [&](int i) { return channels.infos()[static_cast<std::size_t>(i)]; };
  const auto across = channels.find(choice.across);
  std::vector<ChannelInfo> shown;
  std::vector<Curve> firsts;
  for (const std::string& key : choice.channels) {
    const auto channel = channels.find(key);
    if (!channel || (choice.kind == PlotKind::cross && !across)) continue;
    shown.push_back(at(*channel));
    const ChannelInfo& info = shown.back();
    Curve curve{.channel = *channel,
                .label = info.label,
                .help = info.help,
                .ink = info.ink,
                .shade = info.shade};
    if (choice.kind == PlotKind::cross) curve.across = *across;
    tell_apart(curve, firsts);
    curve.visible = !names.beside || !info.seldom;
    firsts.push_back(std::move(curve));
  }
  // A curve that is its run's only one has the colour of the run's law, if that is known. Bands say
  // the law of a single run over time.
  const bool single = names.names.empty();
  const int law = single && choice.kind != PlotKind::cross ? -1 : names.law(kMainLane);
  if (law >= 0 && firsts.size() == 1) {
    firsts[0].law = law;
    firsts[0].law_channel = law_channel(kMainLane, channels);
    if (single) firsts[0].law_name = kLawKeys[static_cast<std::size_t>(law)];
  }
  spec.y = axis_for(shown, choice.kind == PlotKind::spectrum);
  if (spec.y.unit.find(',') != std::string::npos) {
    for (std::size_t i = 0; i < firsts.size(); ++i) firsts[i].label += " [" + shown[i].unit + "]";
  }
  for (std::size_t run = 0; run < std::max<std::size_t>(1, names.names.size()); ++run) {
    const std::string name = names.name(run);
    for (std::size_t i = 0; i < firsts.size(); ++i) {
      Curve curve = run > 0
                        ? of_run(run, firsts[i], firsts.size() == 1, spec.curves, channels, names)
                        : firsts[i];
      const bool recorded = run == 0 && !names.beside;
      if (!name.empty() && firsts.size() == 1) {
        curve.label = name;
      } else if (!name.empty() && !recorded) {
        curve.label = name + " " + curve.label;
      }
      spec.curves.push_back(std::move(curve));
    }
  }
  if (choice.kind == PlotKind::spectrum) {
    spec.x = {.label = "frequency", .unit = "Hz", .zero_line = false, .log = true};
  } else if (across) {
    spec.x = axis_for({at(*across)}, false);
    spec.x.label = at(*across).label;
  }
  spec.bands = bands(channels, names);
  spec.end_labels = names.several();
  return spec;
}

}  // namespace limpid
