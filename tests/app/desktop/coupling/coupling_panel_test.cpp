// The coupling's panel: what it shows of each law, what is broken, and what its buttons do.
#include "app/desktop/coupling/coupling_panel.h"

#include <cmath>

#include "app/desktop/widgets/modal.h"
#include "app/run/fitted_gains.h"
#include "app/style/words.h"
#include "core/dynamics/arm.h"
#include "tests/app/desktop/widgets/read_panel.h"
#include "tests/support/built_in.h"

namespace limpid {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class CouplingWords : public ReadPanel {
 protected:
  CouplingWords() {
    p_.kind = CouplingKind::proposed;
    a_.w_f = {12, 80};
    a_.w_c = {20, 60};
    a_.eta_min = 0.6;
    a_.eta_min_grip = a_.eta_min_compliant = 0.4;
    a_.above_eta_min = true;
    a_.condition3 = {.device_margin = 0.002, .proxy_margin = 0.003, .known = true, .holds = true};
  }
  void draw() {
    show([this] {
      draw_coupling(p_,
                    {.analysis = a_,
                     .arm = arm_,
                     .real = real_,
                     .broken = repair_,
                     .everything = everything_},
                    now_, [this](std::string_view id) { asked_ = id; });
    });
  }

  // Chooses a law by its button, or from the list of those for comparison.
  void choose(CouplingKind kind) {
    if (info(kind).for_comparison) {
      click(info(p_.kind).for_comparison ? info(p_.kind).label : "For comparison");
    }
    click(info(kind).label);
    draw();
  }
  static bool has_conditions(CouplingKind kind) {
    return kind == CouplingKind::standard || kind == CouplingKind::proposed;
  }

  ArmDescription arm_ = test::omni();
  Parameters p_;
  Analysis a_;
  bool real_ = false, repair_ = false, everything_ = true;
  std::string asked_;
  CouplingReading now_{.energy_total = -0.0123,
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

TEST_F(CouplingWords, AreOfTheLawThatIsChosen) {
  draw();
  for (std::uint8_t i = 0; i < kLaws; ++i) {
    const auto kind = static_cast<CouplingKind>(i);
    const std::string label = info(kind).label;
    if (!info(kind).for_comparison) {
      const std::string help = hint(label);
      EXPECT_THAT(help, StartsWith(label + ": "));
      EXPECT_THAT(help, HasSubstr("C switches."));
    }
    choose(kind);
    EXPECT_EQ(p_.kind, kind);
    const std::string verdict = info(kind).verdict;
    EXPECT_THAT(words(), HasSubstr(verdict.substr(0, 12)));
    EXPECT_EQ(find("Passivity").has_value(), has_conditions(kind)) << label;
    EXPECT_EQ(find("Energy tanks").has_value(), kind == CouplingKind::tank);
    EXPECT_EQ(find("Energy account").has_value(), kind == CouplingKind::predictive);
    EXPECT_TRUE(find("Controller energy E_c")) << label;
  }
}

// A first hour needs the law, eta where the law has it, what is felt, one E_c, and one word on
// passivity. A broken promise is as red as in the whole bench.
TEST_F(CouplingWords, AreFewInTheSimpleWindow) {
  everything_ = false;
  now_.gap = 0.00062;
  now_.error = 0.0027;
  now_.contact = 1.25;
  for (std::uint8_t i = 0; i < kLaws; ++i) {
    p_.kind = static_cast<CouplingKind>(i);
    p_.eta = 0.7;
    draw();
    const LawInfo& law = info(p_.kind);
    const bool has_eta =
        std::ranges::find(law.sliders, std::string_view("coupling.eta")) != law.sliders.end();
    EXPECT_EQ(find("Impedance scaling").has_value() ||
                  words().find("Impedance scaling") != std::string::npos,
              has_eta)
        << law.key;
    EXPECT_EQ(value("Apart at the tip"), "0.62 mm");
    EXPECT_EQ(value("Apart in the joints"), "2.70 mrad");
    EXPECT_EQ(value("Contact force"), "1.25 N");
    now_.carries = true;
    draw();
    EXPECT_EQ(value("Contact force"), "1.25 N + magnet");
    now_.carries = false;
    EXPECT_TRUE(find("Controller energy E_c"));
    for (const char* left : {"Advanced", "Link", "Passivity", "Energy account", "Energy tanks",
                             "The coupling's own", "Condition (3), device"}) {
      EXPECT_FALSE(find(left)) << left << " of " << law.key;
    }
    EXPECT_EQ(find("For comparison").has_value(), false) << law.key;
  }
  p_.kind = CouplingKind::proposed;
  draw();
  EXPECT_EQ(value("Passive"), "yes");
  a_.above_eta_min = false;
  draw();
  EXPECT_EQ(value("Passive"), "no");
  EXPECT_TRUE(broken("Passive"));
  click("Show all");
  EXPECT_EQ(asked_, "view.everything");
}

TEST_F(CouplingWords, StayWhereTheyAreUnderLawsOfAsManySliders) {
  draw();
  std::map<std::size_t, float> heights;  // by the number of the usual sliders
  for (std::uint8_t i = 0; i < kLaws; ++i) {
    choose(static_cast<CouplingKind>(i));
    const LawInfo& law = info(p_.kind);
    if (law.on_device || law.for_comparison || law.solves_together) continue;
    const float at = find("Advanced")->min.y;
    const auto usual =
        static_cast<std::size_t>(std::ranges::count_if(law.sliders, [](std::string_view key) {
          return key == "coupling.eta" || key == "observer.alpha";
        }));
    EXPECT_EQ(heights.emplace(usual, at).first->second, at) << law.key;
  }
  EXPECT_GT(heights.size(), 1u);
}

// Sliders of a law: the usual ones at once, those of spring, dampers and energies in a part of
// their own, the link's in another.
TEST_F(CouplingWords, HaveASliderForEachParameterOfTheLaw) {
  for (std::uint8_t i = 0; i < kLaws; ++i) {
    p_.kind = static_cast<CouplingKind>(i);
    draw();
    const LawInfo& law = info(p_.kind);
    const auto shown = [&](std::string_view key) {
      const std::string words_of_it = find_parameter(std::string(key))->caption;
      const auto plain = std::ranges::find_if(words_of_it, [](char c) { return c < 0; });
      return words().find(std::string(words_of_it.begin(), plain)) != std::string::npos;
    };
    if (!law.on_device) click("Advanced");
    click("Link");
    for (const std::string_view key : law.sliders) {
      const bool left_out = (key.starts_with("link.") && !law.knows_link()) ||
                            key == "coupling.per_joint";  // all joints are alike here
      EXPECT_EQ(shown(key), !left_out) << law.key << " " << key;
    }
    EXPECT_EQ(find("Packets lost").has_value(), law.knows_link()) << law.key;
    EXPECT_EQ(sentences().find("has no link.") != std::string::npos, !law.knows_link());
    if (!law.on_device) click("Advanced");
    click("Link");
    EXPECT_FALSE(find("Coupling spring k_vc")) << "folded";
    EXPECT_FALSE(find("Packets lost"));
  }
}

// Nobody needs the switch where it would change nothing.
TEST_F(CouplingWords, OfferGainsForEachJointWhereItsDampingIsItsOwn) {
  draw();
  click("Advanced");
  EXPECT_FALSE(find("Gains grow with each joint's damping"));
  arm_.joints[1].damping *= 5;
  draw();
  ASSERT_TRUE(find("Gains grow with each joint's damping"));
  click("Gains grow with each joint's damping");
  EXPECT_TRUE(p_.per_joint);
}

TEST_F(CouplingWords, SayWhichPromiseIsBrokenAndByHowMuch) {
  draw();
  EXPECT_THAT(value("Least passive ?, ?_min"), HasSubstr("0.600"));
  EXPECT_FALSE(broken("Condition (3), device"));
  EXPECT_EQ(value("Condition (3), device"), "ok  +0.002");
  EXPECT_EQ(value("Condition (3), proxy"), "ok  +0.003");
  EXPECT_EQ(value("Least stable ? in this grip"), "0.400");
  EXPECT_THAT(hint("Condition (3), device"), HasSubstr("b_d minus (2 b_vc + k_vc T) [N m s/rad]"));
  EXPECT_THAT(hint("Condition (3), proxy"), HasSubstr("b_v minus (k_vc T / 2) [N m s/rad]"));
  a_.condition3 = {.device_margin = -0.004, .proxy_margin = -0.005, .known = true, .holds = false};
  a_.above_eta_min = false;
  p_.eta = 0.35;
  draw();
  EXPECT_TRUE(broken("Condition (3), device"));
  EXPECT_EQ(value("Condition (3), device"), "broken  -0.004");
  EXPECT_EQ(value("Condition (3), proxy"), "broken  -0.005");
  EXPECT_THAT(hint("Condition (3), device"), HasSubstr("b_d is 0.004 N m s/rad smaller than"));
  EXPECT_THAT(hint("Condition (3), proxy"), HasSubstr("b_v is 0.005 N m s/rad smaller than"));
  EXPECT_TRUE(find("Advanced: condition (3) broken"));
  EXPECT_TRUE(broken("Least stable ? in this grip")) << "0.35 is below 0.4";
  EXPECT_THAT(hint("Least stable ? in this grip"),
              HasSubstr("? 0.35 is below 0.400, the limit of this grip"));
}

// A slider's tooltip comes half a second after the mouse.
TEST_F(CouplingWords, SayAtASliderWhichPromiseItsValueBreaks) {
  const auto said = [&] {
    draw();
    const auto slider = noted_place("panel", "coupling.eta");
    EXPECT_TRUE(slider) << words();
    if (!slider) return std::string();
    show_mouse(*slider);
    frames(40);
    std::string all;
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.window.starts_with("##Tooltip")) all += each.text + ' ';
    }
    return all;
  };
  p_.eta = 0.7;
  EXPECT_THAT(said(), AllOf(HasSubstr("coupling.eta, "), Not(HasSubstr("is below"))));
  p_.eta = 0.35;
  a_.above_eta_min = false;
  EXPECT_THAT(said(), HasSubstr("0.35 is below ?_min 0.600 of equation (25)"));
}

// Condition (3) asks, by core/coupling/laws.h: of the device (2 + j/2) b_vc + k_vc (T +
// 3/2 t_d + t_l), of the proxy j/2 b_vc + k_vc ((T + t_d)/2 + t_l).
TEST_F(CouplingWords, SayWhatConditionThreeAsksForThroughDelays) {
  const auto asked = [&](double delay, double link, int jitter) {
    a_.delay = delay;
    a_.link = link;
    p_.link_jitter = jitter;
    draw();
    return hint("Condition (3), device") + "|" + hint("Condition (3), proxy");
  };
  const std::string late = asked(0.002, 0, 0);
  EXPECT_THAT(late, HasSubstr("2 b_vc + k_vc (T + 3/2 delay), delay 2.0 ms"));
  EXPECT_THAT(late, HasSubstr("b_v minus (k_vc (T + delay) / 2, delay 2.0 ms"));
  const std::string linked = asked(0, 0.005, 0);
  EXPECT_THAT(linked, HasSubstr("2 b_vc + k_vc (T + link), link 5 ms"));
  EXPECT_THAT(linked, HasSubstr("b_v minus (k_vc (T / 2 + link), link 5 ms"));
  const std::string both = asked(0.002, 0.005, 4);
  EXPECT_THAT(both, HasSubstr("4 b_vc + k_vc (T + 3/2 delay + link)"));
  EXPECT_THAT(both, HasSubstr("b_v minus (2 b_vc + k_vc ((T + delay) / 2 + link)"));
  a_.condition3.known = false;
  draw();
  EXPECT_THAT(hint("Condition (3), device"), HasSubstr("no limit is known"));
}

TEST_F(CouplingWords, SayWhetherFiguresAreMeasuredWhereThatMatters) {
  draw();
  EXPECT_FALSE(find("These figures are"));
  real_ = true;
  draw();
  EXPECT_EQ(value("These figures are"), "assumed");
  EXPECT_THAT(hint("These figures are"),
              HasSubstr("`limpid identify` measures inertia, damping and delay."));
  a_.measured = true;
  draw();
  EXPECT_EQ(value("These figures are"), "measured");
  EXPECT_EQ(value("Observer bandwidth ?_f"), "12 to 80 rad/s");
}

TEST_F(CouplingWords, OfALedgerSayWhatItHoldsBack) {
  p_.kind = CouplingKind::predictive;
  draw();
  EXPECT_EQ(value("Reserve"), "20.0 mJ");
  for (const char* share : {"Wall force rendered", "Damping removed", "Torque rendered"}) {
    EXPECT_EQ(value(share), "100 %");
    EXPECT_FALSE(broken(share));
    EXPECT_NE(hint(share), "");
  }
  EXPECT_FALSE(find("Ticks without a solution"));
  EXPECT_FALSE(find("Contact points left out"));
  EXPECT_FALSE(find("Ticks in which Limpid held objects still"));
  EXPECT_FALSE(find("Ticks in which Limpid slowed objects"));
  now_.contact_governor = 0.994;
  now_.damping_governor = 0.5;
  now_.torque_governor = 0.25;
  now_.unsettled = 3;
  now_.left_out = 1;
  now_.stood_still = 2;
  now_.turned_less = 5;
  draw();
  EXPECT_EQ(value("Wall force rendered"), "99 %");
  EXPECT_EQ(value("Damping removed"), "50 %");
  EXPECT_EQ(value("Torque rendered"), "25 %");
  EXPECT_EQ(value("Ticks without a solution"), "3");
  EXPECT_EQ(value("Contact points left out"), "1");
  EXPECT_EQ(value("Ticks in which Limpid held objects still"), "2");
  EXPECT_EQ(value("Ticks in which Limpid slowed objects"), "5");
  for (const char* bad :
       {"Wall force rendered", "Damping removed", "Torque rendered", "Ticks without a solution",
        "Contact points left out", "Ticks in which Limpid held objects still",
        "Ticks in which Limpid slowed objects"}) {
    EXPECT_TRUE(broken(bad)) << bad;
  }
  EXPECT_THAT(hint("Damping removed"), HasSubstr("cancels a smaller part of the device's damping"));
  now_.contact_governor = 0.996;
  draw();
  EXPECT_FALSE(broken("Wall force rendered")) << "it reads 100 %";
}

TEST_F(CouplingWords, OfTanksSayWhatTheyHoldBack) {
  p_.kind = CouplingKind::tank;
  draw();
  EXPECT_EQ(value("In both tanks"), "20.0 mJ");
  EXPECT_EQ(value("Proxy moves freely"), "100 %");
  now_.contact_governor = 0.5;
  now_.torque_governor = 0.75;
  draw();
  EXPECT_EQ(value("Proxy moves freely"), "50 %");
  EXPECT_EQ(value("Torque rendered"), "75 %");
  EXPECT_THAT(hint("Torque rendered"), HasSubstr("The device's energy tank is low"));
}

TEST_F(CouplingWords, NameMotorsAtTheirLimit) {
  draw();
  EXPECT_FALSE(find("Motor at its limit"));
  now_.limited = {0, 2};
  draw();
  EXPECT_EQ(value("Motor at its limit"), "joint 1, joint 3");
  EXPECT_THAT(hint("Motor at its limit"), HasSubstr("(section 3.1 of the paper)"));
}

// A warm motor is named in the whole bench and in the simple window, whether or not any motor is at
// its limit.
TEST_F(CouplingWords, NameTheMotorThatItsWarmthHoldsBack) {
  const std::string warm = "The motors are warm: joint elbow gives at most 0.4 of 0.8 N m.";
  for (const bool everything : {true, false}) {
    for (const std::vector<int>& limited : {std::vector<int>{}, {1}}) {
      everything_ = everything;
      now_.limited = limited;
      now_.warm.clear();
      draw();
      EXPECT_THAT(sentences(), Not(HasSubstr("motors are warm"))) << everything;
      now_.warm = warm;
      draw();
      EXPECT_THAT(sentences(), HasSubstr(warm)) << everything;
      EXPECT_EQ(find("Motor at its limit").has_value(), !limited.empty()) << everything;
    }
  }
}

TEST_F(CouplingWords, BreakAndRepairPassivityOfTheVirtualArm) {
  draw();
  EXPECT_THAT(hint("Break passivity"), HasSubstr("Repair puts all settings back."));
  click("Break passivity");
  EXPECT_EQ(asked_, "coupling.break_passivity");
  repair_ = true;
  draw();
  EXPECT_THAT(hint("Repair"), HasSubstr("Puts all settings back"));
  click("Repair");
  EXPECT_EQ(asked_, "coupling.end_break");
  real_ = true;
  draw();
  EXPECT_FALSE(find("Repair"));
}

TEST_F(CouplingWords, SayWhoseEnergyItIs) {
  draw();
  EXPECT_EQ(value("Controller energy E_c"), "?12.3 mJ");
  EXPECT_FALSE(find("From compensation, grip test"));
  now_.compensation = 0.004;
  draw();
  EXPECT_EQ(value("From compensation, grip test"), "4.00 mJ");
  EXPECT_FALSE(find("From switching"));
}

TEST_F(CouplingWords, FitGainsToTheArm) {
  p_ = fitted(arm_, p_);
  draw();
  click("Advanced");
  EXPECT_THAT(value("Gains for this arm"), testing::AnyOf("the paper's", "fitted"));
  const Parameters fit = p_;
  p_.k_vc = 2 * p_.k_vc;
  p_.eta = 0.77;
  draw();
  EXPECT_THAT(hint("Fit gains to this arm"), HasSubstr("condition (3) of the paper is just met"));
  click("Fit gains to this arm");
  EXPECT_EQ(p_.k_vc, fit.k_vc);
  EXPECT_EQ(p_.b_vc, fit.b_vc);
  EXPECT_EQ(p_.b_v, fit.b_v);
  EXPECT_EQ(p_.alpha, fit.alpha);
  EXPECT_EQ(p_.eta, 0.77) << "no gain";
}

TEST_F(CouplingWords, OfALinkSayHowLongItIs) {
  p_.link_delay = 5;
  p_.tick = 0.002;
  draw();
  EXPECT_TRUE(find("Link: 5 ticks, 10 ms each way"));
  click("Link: 5 ticks, 10 ms each way");
  EXPECT_EQ(value("Link"), info(p_.kind).through_link);
}

// A re-run makes the changes of the recording, but for settings that it begins otherwise.
TEST_F(CouplingWords, OfARerunTellWhichRecordedChangesItMakes) {
  p_.kind = CouplingKind::proposed;
  const Parameters recorded = p_;
  const auto draw_rerun = [&] {
    show([&] {
      draw_coupling_of_rerun(p_, {recorded, {"coupling.kind", "coupling.eta", "coupling.kind"}},
                             recorded, {.analysis = a_, .arm = arm_});
    });
  };
  draw_rerun();
  const std::string law = find_parameter("coupling.kind")->caption;
  const std::string eta = "Impedance scaling ?";
  EXPECT_THAT(sentences(),
              HasSubstr("after the start: " + law + ", " + eta + ". The re-run makes the"));
  EXPECT_THAT(sentences(), Not(HasSubstr("keeps its own value")));
  p_.kind = CouplingKind::tank;
  draw_rerun();
  EXPECT_THAT(sentences(), HasSubstr("after the start: " + eta + "."));
  EXPECT_THAT(sentences(), HasSubstr("In the recording, " + law +
                                     " changes after the start. The re-run keeps its own"));
}

TEST_F(CouplingWords, OfRerunsSayWhatCameOfEach) {
  const Parameters recorded = p_;
  const std::array runs{RunFigures{"recorded: standard", 4.63, 0.182, -1e-9},
                        RunFigures{"re-run: eta 0.5", 0.21, 0.199, 0.00312}};
  const auto draw_with = [&](std::span<const RunFigures> tried) {
    show([&] {
      draw_coupling_of_rerun(p_, {recorded, {}, tried}, recorded, {.analysis = a_, .arm = arm_});
    });
  };
  draw_with({});
  EXPECT_THAT(words(), Not(HasSubstr("recorded: standard"))) << "nothing was tried yet";
  draw_with(runs);
  for (const char* word : {"error", "mrad", "recorded: standard", "4.63", "re-run: eta 0.5", "0.21",
                           "0.199", "3.12"}) {
    EXPECT_THAT(words(), HasSubstr(word));
  }
}

TEST_F(CouplingWords, OfARerunHaveNothingOfTheLoop) {
  const Parameters recorded = p_;
  Parameters live = p_;
  live.eta = 0.3;
  show([&] { draw_coupling_of_rerun(p_, {recorded, {}}, live, {.analysis = a_, .arm = arm_}); });
  EXPECT_THAT(sentences(), HasSubstr("Change a setting, then press E"));
  EXPECT_TRUE(find("Passivity"));
  EXPECT_FALSE(find("Break passivity"));
  EXPECT_FALSE(find("Controller energy E_c"));
  click("Tank");
  EXPECT_EQ(p_.kind, CouplingKind::tank);
  EXPECT_FALSE(find("Passivity"));
  EXPECT_THAT(value("Coupling"), AllOf(StartsWith(name(recorded.kind)), EndsWith(" tank")));
  click("As recorded");
  EXPECT_EQ(p_, recorded);
  click("Take mine");
  EXPECT_EQ(p_, live);
}

}  // namespace
}  // namespace limpid
