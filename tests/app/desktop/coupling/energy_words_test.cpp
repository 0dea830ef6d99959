// Words of the coupling's panel about energy and passivity: who gave it, whether that is a fault,
// and what helps against it.
#include <map>

#include "app/desktop/coupling/coupling_panel.h"
#include "app/desktop/widgets/modal.h"
#include "app/style/palette.h"
#include "tests/app/desktop/widgets/read_panel.h"
#include "tests/support/built_in.h"
#include "tests/support/drawn_ink.h"

namespace limpid {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// Shares of E_c [J].
struct SharesOfEnergy {
  double stored = 0, forgiven = 0, changes = 0, limits = 0, own = 0;
};

// Follows a run that gives these shares, one after the other.
EnergyAccount account_of(const SharesOfEnergy& wanted) {
  const TraceChannels channels{RowLayout(3)};
  const LaneOfHistory lane = channels.lane(kMainLane);
  History history({.channels = channels.count(), .seconds = 10, .tick = 0.001});
  EnergyAccount account;
  int ticks = 0;
  double energy = 0;
  const auto row = [&](bool limited, double spring) {
    std::vector<double> values(static_cast<std::size_t>(channels.count()), 0.0);
    const auto at = [&](int channel) -> double& {
      return values[static_cast<std::size_t>(channel)];
    };
    at(static_cast<int>(Channel::energy_total)) = energy;
    at(static_cast<int>(Channel::limited)) = limited ? 1 : 0;
    at(static_cast<int>(Channel::joints)) = 1;  // a spring holds -tau x / 2
    at(lane.first + lane.commanded_torque) = -2 * spring;
    at(lane.first + lane.motor_torque) = -2 * spring;
    history.append(0.001 * ticks++, values);
    account.follow(history, history.end(), lane);
  };
  const auto give = [&](double joules, bool limited = false) {
    const double from = energy;
    for (int i = 1; i <= 100; ++i) {
      energy = from + joules * i / 100;
      row(limited, 0);
    }
  };
  row(false, wanted.stored);
  give(wanted.stored + wanted.forgiven);
  history.mark(0.001 * (ticks - 1), "coupling.kind", "coupling.kind");
  give(wanted.changes);
  for (int i = 0; i < 400; ++i) row(false, 0);
  give(wanted.limits, true);
  give(wanted.own);
  return account;
}

class EnergyWords : public ReadPanel {
 protected:
  EnergyWords() {
    p_.kind = CouplingKind::standard;
    a_.w_f = {12, 80};
    a_.w_c = {20, 60};
    a_.eta_min = a_.eta_min_grip = a_.eta_min_compliant = 0.1;
    a_.above_eta_min = true;
    a_.condition3 = {.device_margin = 0.002, .proxy_margin = 0.003, .known = true, .holds = true};
    a_.line_margin = 1;
  }
  // Draws figures of a row, all of them or those of the simple window.
  void draw(bool simple = false) {
    show([this, simple] {
      if (!simple) return draw_reading(now_, p_, a_);
      draw_simple_reading(now_, p_, {.analysis = a_, .arm = arm_});
      draw_simple_notes(now_, p_);
    });
  }

  const ArmDescription arm_ = test::omni();
  Parameters p_;
  Analysis a_;
  CouplingReading now_{.energy_total = 0.02,
                       .compensation = 0,
                       .energy = {},
                       .chatters = false,
                       .limited = {},
                       .reserve = 0.02,
                       .contact_governor = 1,
                       .damping_governor = 1,
                       .torque_governor = 1,
                       .unsettled = 0,
                       .left_out = 0,
                       .stood_still = 0,
                       .turned_less = 0};
};

TEST_F(EnergyWords, NameEachSourceWithItsShare) {
  now_.energy = account_of(
      {.stored = 0.002, .forgiven = 0.003, .changes = 0.004, .limits = 0.005, .own = 0.006});
  now_.compensation = 0.0075;
  struct Source {
    const char *label, *share, *help;
  };
  constexpr Source kSources[] = {
      {"From switching", "4.00 mJ", "bending a spring stores energy"},
      {"From the spring at the start", "2.00 mJ", "held when this run began"},
      {"Before the last change", "3.00 mJ", "gave with earlier settings"},
      {"From compensation, grip test", "7.50 mJ", "the device's weight, springs and friction"},
      {"Energy by motors at their limit or off", "5.00 mJ", "gives a different torque"}};
  for (const bool simple : {false, true}) {
    draw(simple);
    EXPECT_EQ(value("Controller energy E_c"), "20.0 mJ");
    EXPECT_EQ(value("The coupling's own"), "6.00 mJ");
    EXPECT_TRUE(broken("The coupling's own"));
    EXPECT_EQ(broken("Controller energy E_c"), simple) << "the simple window has one line for it";
    for (const Source& each : kSources) {
      EXPECT_EQ(value(each.label), each.share) << each.label;
      EXPECT_FALSE(broken(each.label)) << each.label << " is no fault";
      EXPECT_THAT(hint(each.label), HasSubstr(each.help));
    }
  }
  now_.energy = account_of({.own = -0.006});
  now_.compensation = 0.0009;
  draw();
  EXPECT_EQ(value("The coupling's own"), "?6.00 mJ");
  EXPECT_FALSE(broken("The coupling's own"));
  EXPECT_THAT(hint("The coupling's own"), HasSubstr("stays below zero while the coupling is"));
  EXPECT_THAT(hint("Controller energy E_c"), HasSubstr("The plots show the same E_c."));
  for (const Source& each : kSources)
    EXPECT_FALSE(find(each.label)) << each.label << ": too little";
  now_.energy_total = 0.0009;
  draw(true);
  EXPECT_FALSE(find("The coupling's own")) << "nothing was given";
  EXPECT_THAT(hint("Controller energy E_c"), HasSubstr("The second plot shows E_c."));
}

// A law with an account of its own promises something else, and shows that.
TEST_F(EnergyWords, SayWhatHelpsAgainstALawThatGives) {
  now_.energy = account_of({.own = 0.006});
  for (const int delay : {0, 3}) {
    p_.link_delay = delay;
    for (std::uint8_t i = 0; i < kLaws; ++i) {
      p_.kind = static_cast<CouplingKind>(i);
      const LawInfo& law = info(p_.kind);
      draw();
      EXPECT_EQ(value("The coupling's own"), "6.00 mJ") << law.key;
      const bool otherwise = law.keeps_ledger() || law.promise == Promise::port;
      EXPECT_EQ(broken("The coupling's own"), !otherwise) << law.key;
      if (otherwise) continue;
      const char* const remedy = law.on_device ? "use a softer wall, a hand with more damping"
                                 : delay > 0   ? "use a shorter link delay, a softer k_vc"
                                 : law.observes
                                     ? "lower the observer's gain, or use the predictive law"
                                     : "use a softer k_vc, more damping (condition (3))";
      EXPECT_THAT(hint("The coupling's own"),
                  AllOf(HasSubstr("The coupling has given 6.00 mJ more energy than it received."),
                        HasSubstr("not passive in this grip. Remedy: "), HasSubstr(remedy)))
          << law.key;
    }
  }
}

TEST_F(EnergyWords, JudgePassivityByTheoryAndByWhatWasMeasured) {
  for (const bool simple : {false, true}) {
    now_.energy = {};
    now_.chatters = false;
    a_.condition3 = {.device_margin = 0.002, .proxy_margin = 0.003, .known = true, .holds = true};
    p_.kind = CouplingKind::standard;
    draw(simple);
    EXPECT_EQ(value("Passive"), "yes");
    EXPECT_FALSE(broken("Passive"));
    EXPECT_EQ(hint("Passive"), "Why: condition (3) is met.");

    now_.energy = account_of({.own = 0.006});
    draw(simple);
    EXPECT_EQ(value("Passive"), "no, as measured");
    EXPECT_TRUE(broken("Passive"));
    EXPECT_THAT(hint("Passive"), AllOf(HasSubstr("has given 6.00 mJ more energy"),
                                       HasSubstr("Theory says yes: condition (3) is met.")));

    now_.chatters = true;
    draw(simple);
    EXPECT_EQ(value("Passive"), "no, the loop chatters");
    EXPECT_TRUE(broken("Passive"));
    EXPECT_THAT(hint("Passive"),
                AllOf(HasSubstr("The loop vibrates and gains energy. Remedy: use a softer k_vc"),
                      HasSubstr("Theory says yes: condition (3) is met.")));

    p_.kind = CouplingKind::direct;
    draw(simple);
    EXPECT_EQ(value("Passive"), "no, the loop chatters") << "theory knows no limit";
    EXPECT_THAT(hint("Passive"),
                AllOf(HasSubstr("Remedy: use a softer wall"), Not(HasSubstr("Theory"))));
    now_.chatters = false;
    now_.energy = {};
    draw(simple);
    EXPECT_EQ(value("Passive"), "not known");
    EXPECT_FALSE(broken("Passive"));
    EXPECT_THAT(hint("Passive"), HasSubstr("passivity depends on the hand's damping"));

    p_.kind = CouplingKind::standard;
    a_.condition3.holds = false;
    a_.condition3.device_margin = -0.002;
    now_.chatters = true;
    now_.energy = account_of({.own = 0.006});
    draw(simple);
    EXPECT_EQ(value("Passive"), "no") << "theory says so already";
    EXPECT_TRUE(broken("Passive"));
    EXPECT_THAT(hint("Passive"),
                HasSubstr("can give energy without limit. Reason: condition (3) is "
                          "broken. Remedy: use a softer k_vc"));
  }
}

// Each law has the shares that it tells of, under its own heading.
TEST_F(EnergyWords, HaveTheSharesOfEachLaw) {
  now_.contact_governor = 0.75;
  now_.damping_governor = 0.5;
  now_.torque_governor = 0.25;
  for (std::uint8_t i = 0; i < kLaws; ++i) {
    p_.kind = static_cast<CouplingKind>(i);
    const LawInfo& law = info(p_.kind);
    std::map<std::string, std::string> wanted;
    if (law.promise == Promise::tanks) {
      wanted = {{"Proxy moves freely", "75 %"}, {"Torque rendered", "25 %"}};
    } else if (law.promise == Promise::ledger) {
      wanted = {{"Wall force rendered", "75 %"},
                {"Damping removed", "50 %"},
                {"Torque rendered", "25 %"}};
    } else {
      if (law.torque_share != nullptr) wanted["Torque rendered"] = "25 %";
      if (law.damper_share != nullptr) wanted["Damper not needed"] = "50 %";
    }
    for (const bool simple : {false, true}) {
      draw(simple);
      for (const char* label : {"Proxy moves freely", "Torque rendered", "Wall force rendered",
                                "Damping removed", "Damper not needed"}) {
        EXPECT_EQ(find(label).has_value(), wanted.contains(label)) << law.key << ", " << label;
        if (!wanted.contains(label)) continue;
        EXPECT_EQ(value(label), wanted[label]) << law.key;
        EXPECT_TRUE(broken(label)) << law.key << ", " << label;
        EXPECT_NE(hint(label), "") << law.key << ", " << label;
      }
    }
    draw();
    const bool of_its_own = !law.keeps_ledger() && !wanted.empty();
    EXPECT_EQ(find(law.label).has_value(), of_its_own) << law.key << " as a heading";
  }
  now_.contact_governor = now_.damping_governor = now_.torque_governor = 1;
  p_.kind = CouplingKind::predictive;
  draw(true);
  EXPECT_FALSE(find("Torque rendered")) << "nothing is held back";
  draw();
  EXPECT_THAT(hint("Torque rendered"), HasSubstr("Share of all torque: 100 % unless"));
  EXPECT_THAT(hint("Reserve"), HasSubstr("Energy that the law may still give the hand."));
}

TEST_F(EnergyWords, SayWhatAMotorsLimitIsFeltAs) {
  const auto said = [&](double gap, double contact, bool chatters) {
    now_.limited = {1};
    now_.gap = gap;
    now_.contact = contact;
    now_.chatters = chatters;
    draw();
    EXPECT_EQ(value("Motor at its limit"), "joint 2");
    return sentences();
  };
  EXPECT_THAT(said(0.0011, 2, false), HasSubstr("so hand and avatar move apart. Press less hard."));
  EXPECT_THAT(said(0.0009, 2, false),
              HasSubstr("so the hand feels less than the contact force. Press less hard."));
  EXPECT_THAT(said(0.0011, 0, false), Not(HasSubstr("The hand presses harder")));
  EXPECT_THAT(said(0.0011, 2, true), Not(HasSubstr("The hand presses harder")))
      << "it shakes by itself";
}

TEST_F(EnergyWords, SayHowFarApartDeviceAndProxyAre) {
  now_.gap = 0.00312;
  now_.error = 0.0047;
  now_.contact = 1.236;
  draw();
  EXPECT_EQ(value("Apart at the tip"), "3.12 mm");
  EXPECT_EQ(value("Apart in the joints"), "4.70 mrad");
  EXPECT_EQ(value("Contact force"), "1.24 N");
  now_.error_unit = "m";
  draw();
  EXPECT_EQ(value("Apart in the joints"), "4.70 mm") << "of an arm that only slides";
  EXPECT_THAT(hint("Apart at the tip"), HasSubstr("the tip of its avatar, the proxy."));
  EXPECT_THAT(hint("Apart in the joints"), HasSubstr("minus joint angles of the proxy"));
  EXPECT_THAT(hint("Contact force"), HasSubstr("Force with which the scene pushes the proxy."));
}

TEST_F(EnergyWords, SayWhyTicksWereNotSolved) {
  now_.unsettled = 3;
  now_.left_out = 4;
  now_.stood_still = 5;
  now_.turned_less = 6;
  for (const bool simple : {false, true}) {
    draw(simple);
    for (const auto& [label, count, help] :
         {std::tuple("Ticks without a solution", "3", "Limpid held the proxy still"),
          {"Contact points left out", "4", "they may sink into each other"},
          {"Ticks in which Limpid held objects still", "5", "masses that differ less"},
          {"Ticks in which Limpid slowed objects", "6", "lost the rest of its energy"}}) {
      EXPECT_EQ(value(label), count) << label;
      EXPECT_THAT(hint(label), HasSubstr(help));
    }
  }
}

// Buttons of the laws, and the list of those for comparison.
class LawButtons : public EnergyWords {
 protected:
  void draw_choice(float width, bool everything = true) {
    show([this, width, everything] {
      ImGui::BeginChild("laws", {width, 0});
      draw_coupling(p_, {.analysis = a_, .arm = arm_, .everything = everything}, now_,
                    [this](std::string_view id) { asked_.emplace_back(id); });
      ImGui::EndChild();
    });
  }
  static std::vector<CouplingKind> with_buttons() {
    std::vector<CouplingKind> all;
    for (std::uint8_t i = 0; i < kLaws; ++i) {
      if (!info(CouplingKind{i}).for_comparison) all.push_back(CouplingKind{i});
    }
    return all;
  }
  std::vector<std::string> asked_;
};

TEST_F(LawButtons, StandInOneLineOrTwoByTwo) {
  const std::vector<CouplingKind> laws = with_buttons();
  ASSERT_EQ(laws.size(), 4u);
  for (const float width : {380.0f, 180.0f}) {
    draw_choice(width);
    std::vector<test::DrawnText> at;
    for (const CouplingKind kind : laws) {
      ASSERT_TRUE(find(info(kind).label)) << words();
      at.push_back(*find(info(kind).label));
      EXPECT_TRUE(at.back().whole()) << info(kind).label << " is cut off at " << width;
    }
    const bool one_line = width > 300;
    EXPECT_NEAR(at[0].middle().y, at[1].middle().y, 2);
    EXPECT_NEAR(at[2].middle().y, at[3].middle().y, 2);
    EXPECT_LT(at[0].max.x, at[1].min.x);
    EXPECT_LT(at[2].max.x, at[3].min.x);
    if (one_line) {
      EXPECT_NEAR(at[0].middle().y, at[2].middle().y, 1);
      EXPECT_LT(at[1].max.x, at[2].min.x);
    } else {
      EXPECT_LT(at[0].max.y, at[2].min.y);
      EXPECT_NEAR(at[0].middle().x, at[2].middle().x, 1) << "as wide as each other";
      EXPECT_NEAR(at[1].middle().x, at[3].middle().x, 1);
    }
  }
}

// Each button ends in an edge of its law's colour; the chosen one has it all over.
TEST_F(LawButtons, HaveTheColoursOfTheirLaws) {
  p_.kind = CouplingKind::tank;
  draw_choice(380);
  for (const CouplingKind kind : with_buttons()) {
    const auto at = find(info(kind).label);
    ASSERT_TRUE(at);
    const ImU32 law = colour(law_ink(current_palette(), static_cast<int>(kind)));
    const auto inked = [&](float y) {
      return test::inked({at->middle().x, y}, [=](ImU32 rgba) { return rgba == law; });
    };
    float edge = at->max.y;
    while (edge < at->max.y + 20 && !inked(edge)) edge += 0.5f;
    EXPECT_LT(edge, at->max.y + 20) << info(kind).label;
    EXPECT_EQ(inked(at->min.y - 1), kind == CouplingKind::tank) << info(kind).label;
    const ImU32 text = colour(kind == CouplingKind::tank
                                  ? text_on(law_ink(current_palette(), static_cast<int>(kind)))
                                  : current_palette().text);
    EXPECT_EQ(at->colour, text) << info(kind).label;
  }
}

TEST_F(LawButtons, ListLawsForComparisonWithTheirVerdicts) {
  draw_choice(380);
  EXPECT_THAT(hint("For comparison"), HasSubstr("Laws of other programs and papers"));
  click("For comparison");
  for (std::uint8_t i = 0; i < kLaws; ++i) {
    const LawInfo& law = info(CouplingKind{i});
    const auto label = find(law.label, "##Combo"), verdict = find(law.verdict, "##Combo");
    EXPECT_EQ(label.has_value(), law.for_comparison) << law.key;
    EXPECT_EQ(verdict.has_value(), law.for_comparison) << law.key;
    if (!label || !verdict) continue;
    EXPECT_GT(verdict->min.y, label->min.y) << law.key;
    EXPECT_EQ(verdict->colour, colour(current_palette().muted)) << law.key;
  }
  click(info(CouplingKind::direct).label, "##Combo");
  EXPECT_EQ(p_.kind, CouplingKind::direct);
  draw_choice(380, false);
  EXPECT_TRUE(find(info(CouplingKind::direct).label)) << "the present one is named in any window";
  EXPECT_FALSE(find("For comparison"));
  p_.kind = CouplingKind::standard;
  draw_choice(380, false);
  EXPECT_FALSE(find("For comparison")) << "not in the first hour";
}

TEST_F(LawButtons, LeadToAllSettingsAndBack) {
  draw_choice(380);
  EXPECT_THAT(hint("Show less"), HasSubstr("F8 switches between this and all settings."));
  click("Show less");
  draw_choice(380, false);
  EXPECT_THAT(hint("Show all"), HasSubstr("gains, passivity, energy and analysis. F8"));
  click("Show all");
  EXPECT_EQ(asked_, (std::vector<std::string>(2, "view.everything")));
}

// Changes of a re-run: each setting with both values, and buttons that take all of it back.
class RerunWords : public EnergyWords {
 protected:
  void draw_rerun() {
    show([this] {
      draw_coupling_of_rerun(p_, {recorded_, {}}, live_, {.analysis = a_, .arm = arm_});
    });
  }
  Parameters recorded_ = p_, live_ = p_;
};

TEST_F(RerunWords, HaveBothValuesOfWhatDiffers) {
  draw_rerun();
  EXPECT_THAT(sentences(), HasSubstr("All settings are as recorded."));
  live_.eta = 0.3;
  click("As recorded");  // there is nothing to take back
  EXPECT_EQ(p_, recorded_);
  p_.hand_stiffness = recorded_.hand_stiffness + 100;
  p_.friction = 0.5;
  draw_rerun();
  EXPECT_THAT(sentences(), Not(HasSubstr("All settings are as recorded.")));
  const auto text_of = [](const Parameters& p, const ParameterInfo& info) {
    std::string text = parameter_text(p, info);
    std::erase(text, '"');
    return text.empty() ? "the arm's" : text;
  };
  int differ = 0;
  for (const ParameterInfo& info : parameter_table()) {
    const std::string before = text_of(recorded_, info), after = text_of(p_, info);
    if (before == after) continue;
    ++differ;
    EXPECT_EQ(value(info.caption), before + " ? " + after) << info.key;
    EXPECT_THAT(hint(info.caption), HasSubstr("Left: the value in the recording."));
  }
  EXPECT_EQ(differ, 2);
  const auto left = find("As recorded"), right = find("Take mine");
  ASSERT_TRUE(left && right);
  EXPECT_NEAR(left->middle().y, right->middle().y, 1) << "side by side";
  EXPECT_LT(left->max.x, right->min.x);
  EXPECT_THAT(hint("As recorded"), HasSubstr("Cancels all changes of settings"));
  EXPECT_THAT(hint("Take mine"), HasSubstr("Uses all settings of the live loop"));
  click("Take mine");
  EXPECT_EQ(p_, live_);
  click("As recorded");
  EXPECT_EQ(p_, recorded_);
}

}  // namespace
}  // namespace limpid
