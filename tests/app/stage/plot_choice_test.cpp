#include "app/stage/plot_choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <vector>

namespace limpid {
namespace {

const RunNames kTwin{{"standard", "predictive"}, true}, kRerun{{"recorded", "re-run"}, false},
    kThree{{"standard", "predictive", "proposed"}, true, {0, 2, 1}};

class PlotChoiceOfJoints : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Arms, PlotChoiceOfJoints, testing::Values(1, 2, 3, 7, 32));

TEST_P(PlotChoiceOfJoints, ShowsOnlyChannelsThatThereAre) {
  const TraceChannels channels{RowLayout(GetParam())};
  std::vector<PlotChoice> choices = default_plots();
  choices.push_back({.channels = {"device/position.7", "no/such", "device/position.1"}});
  choices.push_back({.kind = PlotKind::cross, .across = "no/such", .channels = {"coupling/eta"}});
  for (const RunNames& names : {RunNames{}, kTwin, kRerun, kThree}) {
    const int runs = std::max(1, static_cast<int>(names.names.size()));
    for (const PlotChoice& choice : choices) {
      const PlotSpec spec = plot_spec(choice, channels, names);
      EXPECT_FALSE(spec.title.empty());
      EXPECT_FALSE(spec.file_name.empty());
      for (const Curve& curve : spec.curves) {
        EXPECT_GE(curve.channel, 0);
        EXPECT_LT(curve.channel, runs * channels.count());
        EXPECT_LT(curve.across, runs * channels.count());
        EXPECT_EQ(curve.across >= 0, choice.kind == PlotKind::cross);
      }
    }
    EXPECT_EQ(plot_spec(choices[4], channels, names).curves.size(),
              static_cast<std::size_t>(runs * (GetParam() >= 7 ? 2 : 1)));
    EXPECT_TRUE(plot_spec(choices[5], channels, names).curves.empty());
  }
}

// Without force a plot is not what it seems, with any content and number of runs.
TEST(PlotChoice, MarksWhereTheForceWasOffInEveryPlot) {
  const TraceChannels channels{RowLayout(3)};
  for (const RunNames& names : {RunNames{}, kTwin, kRerun, kThree}) {
    for (const PlotChoice& choice : default_plots()) {
      const PlotSpec spec = plot_spec(choice, channels, names);
      const auto marked = std::ranges::find_if(spec.bands, &Band::striped);
      ASSERT_NE(marked, spec.bands.end());
      EXPECT_EQ(marked->channel, channels.find("device/force_state"));
      EXPECT_EQ(marked->names.at(0), "");
      EXPECT_EQ(marked->names.at(1), "force off: not armed");
      EXPECT_EQ(marked->names.at(6), "force held back: the device moves too fast");
      for (std::size_t i = 1; i < marked->names.size(); ++i) EXPECT_NE(marked->names[i], "");
    }
  }
}

// Each run's motors have a band of their own, also those of a re-run.
TEST(PlotChoice, MarksWhereMotorsOfEachRunWereAtTheirLimit) {
  const TraceChannels channels{RowLayout(3)};
  const auto limits = [&](const RunNames& names) {
    std::vector<std::pair<int, std::string>> found;
    for (const Band& band : plot_spec(default_plots()[0], channels, names).bands) {
      const int run = band.channel / channels.count();
      if (band.channel % channels.count() != static_cast<int>(Channel::limited)) continue;
      EXPECT_EQ(band.names.at(0), "");
      found.emplace_back(run, band.names.at(1));
    }
    return found;
  };
  using Found = std::vector<std::pair<int, std::string>>;
  EXPECT_EQ(limits({}), (Found{{0, "motor at its limit"}}));
  EXPECT_EQ(limits(kRerun),
            (Found{{0, "motor at its limit (recorded)"}, {1, "motor at its limit (re-run)"}}));
  EXPECT_EQ(limits(kTwin),
            (Found{{0, "motor at its limit (left)"}, {1, "motor at its limit (right)"}}));
  EXPECT_EQ(limits(kThree), (Found{{0, "motor at its limit (run 1)"},
                                   {1, "motor at its limit (run 2)"},
                                   {2, "motor at its limit (run 3)"}}));
}

// Three runs differ in more than their laws' colours, wherever a plot has several curves of each.
TEST(PlotChoice, TellsThreeRunsApartByColourAndSign) {
  const TraceChannels channels{RowLayout(3)};
  for (const std::vector<int>& laws : {std::vector{0, 2, 1}, std::vector{2, 2, 2}}) {
    RunNames names = kThree;
    names.laws = laws;
    for (const PlotChoice& choice : default_plots()) {
      const PlotSpec spec = plot_spec(choice, channels, names);
      ASSERT_EQ(spec.curves.size(), 3 * choice.channels.size());
      for (std::size_t a = 0; a < spec.curves.size(); ++a) {
        for (std::size_t b = 0; b < a; ++b) {
          const Curve &one = spec.curves[a], &other = spec.curves[b];
          EXPECT_NE(one.channel, other.channel);
          EXPECT_NE(one.label, other.label);
          EXPECT_FALSE(colour_of(kDarkPalette, one) == colour_of(kDarkPalette, other) &&
                       one.sign == other.sign)
              << one.label << " and " << other.label;
        }
      }
    }
  }
}

// Each run's error stands over its own contact torque.
TEST(PlotChoice, SetsTheErrorOfBothRunsAgainstTheirOwnTorque) {
  const TraceChannels channels{RowLayout(3)};
  const PlotSpec spec = plot_spec(default_plots().back(), channels, kTwin);
  ASSERT_EQ(spec.curves.size(), 2u);
  for (const int run : {0, 1}) {
    const Curve& curve = spec.curves[static_cast<std::size_t>(run)];
    EXPECT_EQ(curve.channel, static_cast<int>(Channel::error) + run * channels.count());
    EXPECT_EQ(curve.across, static_cast<int>(Channel::contact) + run * channels.count());
    EXPECT_EQ(curve.label, run == 0 ? "standard" : "predictive");
  }
  EXPECT_EQ(spec.x.unit, "N m");
}

// In a twin a single curve of each run has its law's colour. With equal laws, or channels with
// colours of their own, the second run is lighter and has signs on it.
TEST(PlotChoice, DrawsTheRunsOfATwinByTheirLaws) {
  const TraceChannels channels{RowLayout(3)};
  RunNames names = kTwin;
  names.laws = {0, 2};
  for (const PlotChoice& choice : {default_plots().front(), default_plots().back()}) {
    const PlotSpec spec = plot_spec(choice, channels, names);
    ASSERT_EQ(spec.curves.size(), 2u);
    for (const Palette* p : {&kDarkPalette, &kLightPalette}) {
      EXPECT_EQ(colour_of(*p, spec.curves[0]), law_ink(*p, 0));
      EXPECT_EQ(colour_of(*p, spec.curves[1]), law_ink(*p, 2));
    }
    EXPECT_EQ(spec.curves[0].sign, RunSign::none);
    EXPECT_EQ(spec.curves[1].sign, RunSign::square);
  }
  names.laws = {1, 1};
  const PlotSpec same = plot_spec(default_plots().front(), channels, names);
  EXPECT_NE(colour_of(kDarkPalette, same.curves[0]), colour_of(kDarkPalette, same.curves[1]));
  const PlotSpec torques = plot_spec(default_plots()[2], channels, names);
  ASSERT_EQ(torques.curves.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_LT(torques.curves[i].law, 0);
    EXPECT_EQ(torques.curves[i].sign, i < 3 ? RunSign::none : RunSign::square);
  }
}

// The past keeps the colour of the law that made it, and each run an edge with its laws.
TEST(PlotChoice, AsksWhichLawMadeTheRunsOfATwin) {
  const TraceChannels channels{RowLayout(3)};
  RunNames names = kTwin;
  names.laws = {0, 2};
  const PlotSpec spec = plot_spec(default_plots().front(), channels, names);
  const int kind = static_cast<int>(Channel::kind);
  for (const int run : {0, 1}) {
    const Curve& curve = spec.curves[static_cast<std::size_t>(run)];
    EXPECT_EQ(curve.law_channel, kind + run * channels.count());
    EXPECT_EQ(colour_of(kDarkPalette, curve, 1), law_ink(kDarkPalette, 1));
    EXPECT_EQ(colour_of(kDarkPalette, curve, -1), colour_of(kDarkPalette, curve));
    const Band& band = spec.bands[static_cast<std::size_t>(run)];
    EXPECT_EQ(band.channel, curve.law_channel);
    EXPECT_EQ(band.lane, run);
    EXPECT_EQ(band.names.front(), run == 0 ? "left standard" : "right standard");
  }
  const PlotSpec torques = plot_spec(default_plots()[2], channels, names);
  EXPECT_EQ(torques.curves.front().law_channel, -1) << "it has its thing's colour";
}

// Bands say the law over time; a plot over another channel has none.
TEST(PlotChoice, SaysTheLawOfASingleRunWhereNoBandDoes) {
  const TraceChannels channels{RowLayout(3)};
  const RunNames named{.laws = {2}};
  for (const PlotChoice& choice : default_plots()) {
    const PlotSpec spec = plot_spec(choice, channels, named);
    const PlotSpec without = plot_spec(choice, channels, {});
    ASSERT_EQ(spec.curves.size(), without.curves.size());
    const bool cross = choice.kind == PlotKind::cross;
    for (std::size_t i = 0; i < spec.curves.size(); ++i) {
      const Curve& curve = spec.curves[i];
      EXPECT_EQ(curve.label, without.curves[i].label) << "tables have no law in their heads";
      EXPECT_EQ(curve.name(), (cross ? "predictive " : "") + curve.label);
      const Rgb thing = colour_of(kDarkPalette, without.curves[i]);
      EXPECT_EQ(colour_of(kDarkPalette, curve), cross ? law_ink(kDarkPalette, 2) : thing);
      EXPECT_EQ(colour_of(kDarkPalette, curve, 0), cross ? law_ink(kDarkPalette, 0) : thing);
      EXPECT_EQ(curve.law_channel, cross ? static_cast<int>(Channel::kind) : -1);
    }
  }
}

TEST(PlotChoice, DrawsARerunInItsLawsColour) {
  const TraceChannels channels{RowLayout(3)};
  RunNames names = kRerun;
  names.laws = {-1, 2};
  const PlotSpec spec = plot_spec(default_plots()[0], channels, names);
  EXPECT_EQ(colour_of(kLightPalette, spec.curves[1]), law_ink(kLightPalette, 2));
  EXPECT_NE(colour_of(kLightPalette, spec.curves[0]), law_ink(kLightPalette, 2));
}

// Beside a re-run the recorded run's past keeps the law that made it: the same tint and colours as
// without. The re-run has an edge of its own.
TEST(PlotChoice, KeepsTheLawsOfARecordedRunBesideARerun) {
  const TraceChannels channels{RowLayout(3)};
  const int kind = static_cast<int>(Channel::kind);
  for (const PlotChoice& choice : default_plots()) {
    const PlotSpec alone = plot_spec(choice, channels, {});
    const PlotSpec spec = plot_spec(choice, channels, kRerun);
    std::vector<Band> laws;
    std::ranges::copy_if(spec.bands, std::back_inserter(laws), &Band::laws);
    ASSERT_EQ(laws.size(), 2U) << spec.title;
    EXPECT_EQ(laws[0].channel, kind);
    EXPECT_EQ(laws[0].lane, -1) << "a tint";
    EXPECT_EQ(laws[0].tint, alone.bands.front().tint);
    EXPECT_EQ(laws[0].key, alone.bands.front().key);
    EXPECT_EQ(laws[0].names.front(), "recorded standard");
    EXPECT_EQ(laws[1].channel, kind + channels.count());
    EXPECT_EQ(laws[1].lane, 1) << "an edge";
    EXPECT_EQ(laws[1].names.front(), "re-run standard");
    for (std::size_t i = 0; i < alone.curves.size(); ++i) {
      EXPECT_EQ(colour_of(kLightPalette, spec.curves[i]),
                colour_of(kLightPalette, alone.curves[i]));
      EXPECT_EQ(spec.curves[i].law_channel, alone.curves[i].law_channel);
    }
  }
}

TEST(PlotChoice, DrawsARecordedRunInItsLawsColourWhereThatIsKnown) {
  const TraceChannels channels{RowLayout(3)};
  RunNames names = kRerun;
  names.laws = {1, 2};
  for (const PlotChoice& choice : {default_plots().front(), default_plots().back()}) {
    const PlotSpec spec = plot_spec(choice, channels, names);
    ASSERT_EQ(spec.curves.size(), 2U);
    const int kind = static_cast<int>(Channel::kind);
    for (const int run : {0, 1}) {
      const Curve& curve = spec.curves[static_cast<std::size_t>(run)];
      EXPECT_EQ(colour_of(kLightPalette, curve), law_ink(kLightPalette, 1 + run));
      EXPECT_EQ(colour_of(kLightPalette, curve, 0), law_ink(kLightPalette, 0)) << "a part";
      EXPECT_EQ(curve.law_channel, kind + run * channels.count());
    }
  }
  names.laws = {2, 2};
  const PlotSpec same = plot_spec(default_plots().front(), channels, names);
  EXPECT_EQ(colour_of(kLightPalette, same.curves[0]), law_ink(kLightPalette, 2));
  EXPECT_NE(colour_of(kLightPalette, same.curves[0]), colour_of(kLightPalette, same.curves[1]));
  for (const Curve& curve : plot_spec(default_plots()[2], channels, names).curves) {
    EXPECT_EQ(curve.law, -1) << "it has its thing's colour";
  }
}

// In a plot of several things a law's tints would be alike: those of the standard one are greys.
TEST(PlotChoice, DrawsThingsOfARerunInTheirOwnColours) {
  const TraceChannels channels{RowLayout(3)};
  RunNames names = kRerun;
  names.laws = {-1, static_cast<int>(CouplingKind::standard)};
  const PlotSpec spec = plot_spec(default_plots()[2], channels, names);
  ASSERT_EQ(spec.curves.size(), 6U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(spec.curves[3 + i].law, -1) << spec.curves[i].label;
    EXPECT_EQ(spec.curves[3 + i].ink, spec.curves[i].ink) << spec.curves[i].label;
    EXPECT_NE(spec.curves[3 + i].shade, spec.curves[i].shade) << spec.curves[i].label;
  }
}

// A plot of one thing is about the runs, a plot of several about the things.
TEST(PlotChoice, NamesTheRecordedRunBesideARerun) {
  const TraceChannels channels{RowLayout(3)};
  const PlotSpec one = plot_spec(default_plots()[0], channels, kRerun);
  ASSERT_EQ(one.curves.size(), 2U);
  EXPECT_EQ(one.curves[0].label, "recorded");
  EXPECT_EQ(one.curves[1].label, "re-run");
  const PlotSpec three = plot_spec(default_plots()[2], channels, kRerun);
  const PlotSpec alone = plot_spec(default_plots()[2], channels, {});
  EXPECT_EQ(three.curves[0].label, alone.curves[0].label);
  EXPECT_EQ(three.curves[3].label, "re-run " + alone.curves[0].label);
}

TEST(PlotChoice, PutsRingsOnTheCurvesOfARerun) {
  const TraceChannels channels{RowLayout(3)};
  const PlotSpec spec = plot_spec(default_plots()[2], channels, kRerun);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(spec.curves[i].sign, i < 3 ? RunSign::none : RunSign::ring);
  }
}

TEST(PlotChoice, TintsTheBandOfLawsByTheirColours) {
  const TraceChannels channels{RowLayout(3)};
  const PlotSpec spec = plot_spec(default_plots()[0], channels, {});
  ASSERT_FALSE(spec.bands.empty());
  EXPECT_TRUE(spec.bands.front().laws);
  EXPECT_EQ(spec.bands.front().key, "coupling.kind");
  EXPECT_EQ(spec.bands.front().names.size(), kLaws);
}

// Two runs in one plot never have curves that look alike.
TEST(PlotChoice, TellsCurvesApartByTheirColours) {
  const TraceChannels channels{RowLayout(7)};
  std::vector<PlotChoice> choices = default_plots();
  choices.push_back({.channels = {"device/position.1", "proxy/position.1", "device/velocity.1",
                                  "device/position.2"}});
  choices.push_back({.channels = {"energy/port", "energy/ledger", "energy/proxy_kinetic"}});
  for (const Palette* palette : {&kDarkPalette, &kLightPalette}) {
    for (const RunNames& names : {RunNames{}, kRerun}) {
      for (const PlotChoice& choice : choices) {
        const PlotSpec plot = plot_spec(choice, channels, names);
        std::vector<Rgb> seen;
        for (const Curve& curve : plot.curves) {
          const Rgb rgb = ink(*palette, curve.ink, curve.shade);
          for (const Rgb other : seen) {
            const int apart =
                std::abs(rgb.r - other.r) + std::abs(rgb.g - other.g) + std::abs(rgb.b - other.b);
            EXPECT_GE(apart, 30) << plot.title << ": " << curve.label;
          }
          seen.push_back(rgb);
        }
      }
    }
  }
}

TEST(PlotChoice, WritesOneUnitScaledAndSeveralAsTheyAre) {
  const TraceChannels channels{RowLayout(3)};
  const auto y = [&](std::vector<std::string> keys) {
    return plot_spec({.channels = std::move(keys)}, channels, {}).y;
  };
  EXPECT_FALSE(y({"energy/port", "energy/ledger"}).units.empty());
  const PlotAxis mixed = y({"energy/port", "device/velocity.1"});
  EXPECT_EQ(mixed.unit, "J, rad/s");
  EXPECT_TRUE(mixed.units.empty());
  EXPECT_EQ(mixed.factor, 1);
  EXPECT_TRUE(y({"energy/port"}).zero_line);
  EXPECT_FALSE(y({"device/position.2"}).zero_line) << "where a joint is, has no zero of interest";
}

TEST(PlotChoice, IsCalledByWhatItShowsUnlessItHasAName) {
  const TraceChannels channels{RowLayout(3)};
  PlotChoice choice{.kind = PlotKind::spectrum, .channels = {"hand/torque_norm"}};
  EXPECT_EQ(title_of(choice, channels), "spectrum of |f1|");
  choice.title = "tremor";
  EXPECT_EQ(title_of(choice, channels), "tremor");
  EXPECT_EQ(plot_spec({.title = "a/b: c", .channels = {}}, channels, {}).file_name, "a-b-c");
}

// Units, the least span of an axis in them, and where people read thousandths.
TEST(PlotChoice, ScalesItsAxesByTheirUnits) {
  const TraceChannels channels{RowLayout(3)};
  struct Wanted {
    const char *key, *unit, *small;  // small: unit of small values; empty: always the same
    double span;
  };
  for (const Wanted& each : {Wanted{"coordination/error", "rad", "mrad", 20e-3},
                             {"energy/port", "J", "mJ", 1e-3},
                             {"device/tip.1", "m", "mm", 1e-3},
                             {"hand/torque_norm", "N m", "", 0.05},
                             {"contact/total_force_norm", "N", "", 0.1},
                             {"device/velocity.1", "rad/s", "", 0.05},
                             {"coupling/eta", "", "", 1e-2},
                             {"hand/grip", "", "", 1e-2}}) {
    PlotAxis y = plot_spec({.channels = {each.key}}, channels, {}).y;
    EXPECT_EQ(y.unit, each.unit) << each.key;
    EXPECT_EQ(y.smallest_span, each.span) << each.key;
    EXPECT_FALSE(y.log);
    y.choose_unit(0.5);
    EXPECT_EQ(y.unit, *each.small != '\0' ? each.small : each.unit);
    EXPECT_EQ(y.factor, *each.small != '\0' ? 1000 : 1);
    y.choose_unit(5);
    EXPECT_EQ(y.unit, each.unit);
    EXPECT_EQ(y.factor, 1);
  }
  const PlotSpec spectrum =
      plot_spec({.kind = PlotKind::spectrum, .channels = {"energy/port"}}, channels, {});
  EXPECT_TRUE(spectrum.y.log && spectrum.x.log);
  EXPECT_EQ(spectrum.y.smallest_span, 1) << "a decade";
  EXPECT_EQ(spectrum.x.label, "frequency");
  EXPECT_EQ(spectrum.x.unit, "Hz");
  EXPECT_FALSE(spectrum.x.zero_line);
  const PlotSpec cross = plot_spec(
      {.kind = PlotKind::cross, .across = "coordination/error", .channels = {"energy/port"}},
      channels, {});
  EXPECT_EQ(cross.x.label, "|x_E|");
  EXPECT_EQ(cross.x.unit, "rad");
  EXPECT_EQ(cross.x.smallest_span, 20e-3);
  const PlotSpec mixed =
      plot_spec({.channels = {"coordination/error", "hand/torque_norm"}}, channels, {});
  ASSERT_EQ(mixed.curves.size(), 2u);
  EXPECT_EQ(mixed.curves[0].label, "|x_E| [rad]");
  EXPECT_EQ(mixed.curves[1].label, "|f1| [N m]");
  EXPECT_EQ(mixed.y.smallest_span, 1e-2);
  EXPECT_EQ(plot_spec({}, channels, {}).y.smallest_span, 1);
  EXPECT_EQ(plot_spec({}, channels, {}).title, "empty plot");
}

TEST(PlotChoice, SaysKindsAndFirstPlotsByTheirNames) {
  EXPECT_STREQ(name(PlotKind::time), "time");
  EXPECT_STREQ(name(PlotKind::cross), "cross");
  EXPECT_STREQ(name(PlotKind::spectrum), "spectrum");
  const TraceChannels channels{RowLayout(3)};
  EXPECT_EQ(title_of({.kind = PlotKind::cross,
                      .across = "coordination/error",
                      .channels = {"energy/port", "no/such"}},
                     channels),
            "energy port, no/such against |x_E|");
  ASSERT_EQ(simple_plots().size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const PlotChoice simple = simple_plots()[i], usual = default_plots()[i];
    EXPECT_EQ(simple.title, usual.title);
    EXPECT_EQ(simple.kind, PlotKind::time);
    EXPECT_LE(simple.channels.size(), usual.channels.size());
    for (const std::string& key : simple.channels) {
      EXPECT_EQ(std::ranges::count(usual.channels, key), 1) << key;
    }
  }
}

TEST(LawsOfASession, AreThoseOfARow) {
  Session session;
  session.info.tick = 0.01;
  const auto stride = static_cast<std::size_t>(session.layout.stride());
  session.rows.assign(100 * stride, 0.0);
  for (std::size_t k = 50; k < 100; ++k) {
    session.layout.in(std::span(session.rows).subspan(k * stride, stride), Column::kind)[0] = 2;
  }
  EXPECT_EQ(laws_at(session, 0.494), std::vector{0});
  EXPECT_EQ(laws_at(session, 0.496), std::vector{2}) << "the nearest row";
  EXPECT_EQ(laws_at(session, 77), std::vector{2}) << "the last one";
  EXPECT_EQ(laws_at(session, -1), std::vector{0});
  session.beside.resize(1);
  EXPECT_EQ(laws_at(session, 1), (std::vector{2, -1})) << "a lane without rows";
}

TEST(LawsOfASession, AreNamedOfSeveralLanesOnly) {
  std::vector<Parameters> lanes(1);
  lanes[0].kind = CouplingKind::predictive;
  const RunNames one = run_names(lanes);
  EXPECT_TRUE(one.names.empty());
  EXPECT_FALSE(one.beside || one.several());
  EXPECT_EQ(one.laws, std::vector{2});
  lanes.emplace_back().kind = CouplingKind::standard;
  const RunNames two = run_names(lanes);
  EXPECT_EQ(two.names, (std::vector<std::string>{"predictive", "standard"}));
  EXPECT_TRUE(two.beside && two.several());
  EXPECT_EQ(two.laws, (std::vector{2, 0}));
  EXPECT_EQ(two.name(2), "");
  EXPECT_EQ(two.law(2), -1);
}

}  // namespace
}  // namespace limpid
