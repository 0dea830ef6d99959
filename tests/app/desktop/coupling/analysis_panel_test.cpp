// The panel of the analysis: its figures are those of theory, and what is broken is marked.
#include "app/desktop/coupling/analysis_panel.h"

#include <cmath>
#include <numbers>

#include "core/dynamics/arm.h"
#include "tests/app/desktop/widgets/read_panel.h"
#include "tests/support/built_in.h"
#include "tests/support/until.h"

namespace limpid {
namespace {

using testing::HasSubstr;
using testing::Not;

class AnalysisWords : public ReadPanel {
 protected:
  // Draws until the analysis is that of the present settings.
  void draw() {
    show([this] { panel_.draw(p_, arm_, scene_, pose_span(), band_); });
    frames(20);
  }
  std::span<const double> pose_span() const {
    return {pose_.data(), static_cast<std::size_t>(pose_.size())};
  }
  TipLimits limits() const { return tip_limits(arm_, pose_, p_, scene_); }
  const TipWall& wall(const TipLimits& l) const { return l.wall(p_.kind); }
  void set_wall(double stiffness) {
    scene_ = {};
    scene_.add({.shape = Plane{}, .material = {stiffness}});
  }

  AnalysisPanel panel_;
  ArmDescription arm_ = test::omni();
  Eigen::VectorXd pose_ = rest_pose(arm_);
  Parameters p_;
  Scene scene_;
  double band_ = 7;
};

TEST_F(AnalysisWords, SayWhatIsFeltAtTheBand) {
  for (const CouplingKind kind : {CouplingKind::proposed, CouplingKind::predictive}) {
    p_.kind = kind;
    p_.eta = 0.6;
    draw();
    const FeltAtTip felt = felt_at_tip(kind, p_, limits(), 7);
    EXPECT_EQ(value("felt at 7 Hz"),
              fmt::format("{:.3g} g, {:.2g} N s/m", 1e3 * felt.mass, felt.damping));
  }
}

TEST_F(AnalysisWords, SayHowStiffAWallEachLawRenders) {
  p_.kind = CouplingKind::proposed;
  draw();
  const TipLimits l = limits();
  for (std::size_t i = 0; i < kLaws; ++i) {
    const LawInfo& law = info(static_cast<CouplingKind>(i));
    const double stiffness = l.walls[i].stiffness;
    const std::string number = stiffness >= 1e4 ? fmt::format("{:.0f}k", stiffness / 1000)
                                                : fmt::format("{:.0f}", stiffness);
    EXPECT_EQ(find(std::string(law.key) + " " + number).has_value(), !law.for_comparison)
        << law.key << " in\n"
        << words();
  }
  EXPECT_THAT(words(), HasSubstr("stiffest wall [N/m]"));
  EXPECT_FALSE(find("stiffest in this scene")) << "there is nothing to touch";
}

TEST_F(AnalysisWords, MarkASceneThatIsTooStiffForTheLaw) {
  p_.kind = CouplingKind::proposed;
  const double most = wall(limits()).stiffness;
  set_wall(std::floor(0.9 * most));
  draw();
  EXPECT_EQ(value("stiffest in this scene"), fmt::format("{:.0f} N/m", std::floor(0.9 * most)));
  EXPECT_FALSE(broken("stiffest in this scene"));
  set_wall(std::ceil(1.1 * most));
  draw();
  EXPECT_TRUE(broken("stiffest in this scene"));
  EXPECT_THAT(hint("stiffest in this scene"), HasSubstr("the coupling proposed renders"));
  p_.kind = CouplingKind::tank;
  draw();
  EXPECT_FALSE(broken("stiffest in this scene")) << "felt through a spring, whatever it is";
}

TEST_F(AnalysisWords, SayWhatCameOfPressesOnTheWall) {
  p_.kind = CouplingKind::predictive;
  draw();
  EXPECT_FALSE(find("held in simulation"));
  const double named = wall(limits()).stiffness;
  click(fmt::format("Try a wall of {:.0f} N/m", named));
  ASSERT_TRUE(test::until([&] { return find("held in simulation").has_value(); },
                          [&] {
                            std::this_thread::sleep_for(std::chrono::milliseconds(1));
                            frames(1);
                          }));
  EXPECT_EQ(value("held in simulation"),
            fmt::format("{0:.0f} of {0:.0f} N/m, {1}", named, info(p_.kind).label));
  EXPECT_FALSE(broken("held in simulation"));
}

TEST_F(AnalysisWords, SayTheLimitsOfEta) {
  p_.kind = CouplingKind::proposed;
  draw();
  const Analysis a = analyze(arm_, pose_, p_, 2 * std::numbers::pi * 7);
  EXPECT_EQ(value("?_min, all frequencies"), fmt::format("{:.3f}", a.eta_min));
  EXPECT_EQ(value("?_min in the band"), fmt::format("{:.3f}", a.eta_min_band.value()));
  EXPECT_EQ(value("?_min in this grip"), fmt::format("{:.3f}", a.eta_min_grip));
  p_.eta = 1.01 * a.eta_min;
  draw();
  EXPECT_THAT(words(), HasSubstr(": passive"));
  p_.eta = 0.99 * a.eta_min;
  draw();
  EXPECT_THAT(words(), HasSubstr(": not passive"));
  p_.kind = CouplingKind::standard;
  draw();
  EXPECT_FALSE(find("?_min in this grip")) << "of laws that scale inertia alone";
}

TEST_F(AnalysisWords, MarkAPoleThatIsUnstable) {
  p_.kind = CouplingKind::proposed;
  draw();
  EXPECT_FALSE(broken("slowest pole in this grip"));
  p_.eta = 0.05;
  p_.hand_stiffness = 3000;
  p_.hand_damping = 0;
  draw();
  double worst = -HUGE_VAL;
  for (const auto& pole : handle_poles(arm_, pose_, p_)) worst = std::max(worst, pole.real());
  ASSERT_GT(worst, 0);
  EXPECT_TRUE(broken("slowest pole in this grip"));
  EXPECT_THAT(value("slowest pole in this grip"),
              testing::StartsWith(fmt::format("{:.1f} ", worst)));
}

TEST_F(AnalysisWords, AreOfTheBandThatIsChosen) {
  p_.kind = CouplingKind::proposed;
  draw();
  const auto slider = find("human below 7.0 Hz");
  ASSERT_TRUE(slider) << words();
  click(ImVec2{slider->max.x + 100, slider->middle().y});
  EXPECT_GT(band_, 7.5);
  frames(3);
  EXPECT_TRUE(find(fmt::format("felt at {:.3g} Hz", band_)));
}

// The tooltip of each chart names the numbers that it draws.
TEST_F(AnalysisWords, ExplainEachChart) {
  p_.kind = CouplingKind::proposed;
  p_.eta = 0.6;
  set_wall(400);
  draw();
  const TipLimits l = limits();
  const TipWall mine = wall(l);
  const auto within = [&](const std::string& title) {
    const auto at = find(title);
    EXPECT_TRUE(at) << title << " is not in:\n" << words();
    if (!at) return std::string();
    show_mouse({at->middle().x, at->max.y + 40});
    frames();
    std::string said;
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.window.starts_with("##Tooltip")) said += (said.empty() ? "" : " ") + each.text;
    }
    away();
    return said;
  };
  const std::string walls = within("stiffest wall [N/m]");
  EXPECT_THAT(walls, HasSubstr(fmt::format("{:.0f} N/m", mine.stiffness)));
  EXPECT_THAT(walls, HasSubstr(mine.bound));
  EXPECT_THAT(walls, HasSubstr(fmt::format("{:.0f} N/m", l.every_hand)));
  EXPECT_THAT(walls, HasSubstr("Colgate and Schenkel"));
  const std::string inertia = within("inertia felt [g at tip] against frequency [Hz]");
  EXPECT_THAT(inertia, HasSubstr("at ? 0.6"));
  EXPECT_THAT(inertia, HasSubstr(fmt::format("inertia of {:.3g} g", 1e3 * l.felt.m)));
  const std::string damping = within("damping felt [N s/m] against frequency [Hz]");
  EXPECT_THAT(damping, HasSubstr(fmt::format("{:.2g} N s/m", l.felt.least_damping(0.6, p_.band))));
  EXPECT_THAT(damping, HasSubstr(fmt::format("up to {:.3g} Hz", p_.band)));
}

TEST_F(AnalysisWords, ExplainEachFigure) {
  p_.kind = CouplingKind::proposed;
  set_wall(400);
  draw();
  for (const auto& [label, words] :
       {std::pair("stiffest in this scene", "This coupling renders this stiffness well"),
        {"felt at 7 Hz", "Inertia and damping at the tip"},
        {"?_min, all frequencies", "the mode with the highest limit"},
        {"?_min in the band", "only below the human's bandwidth"},
        {"?_min in this grip", "Routh"},
        {"modes of M_L", "Eigenvalues of M1 + M2"},
        {"slowest pole in this grip", "held by the grip"}}) {
    EXPECT_THAT(hint(label), HasSubstr(words)) << label;
  }
  EXPECT_THAT(words(), HasSubstr("for ")) << "on whose account they are";
}

}  // namespace
}  // namespace limpid
