#include "app/desktop/coupling/timing_panel.h"

#include <fmt/format.h>

#include <cmath>

#include "core/dynamics/arm.h"
#include "tests/app/desktop/widgets/read_panel.h"
#include "tests/support/built_in.h"
#include "tests/support/drawn_ink.h"

namespace limpid {
namespace {

using testing::HasSubstr;
using testing::Not;

// A person who holds a device with motors must not read that its ticks come in a burst after a
// stall.
TEST(TimingPanel, SaysThatWithMotorsLateTicksAreGivenUpAtOnce) {
  const LateTicks words = late_ticks(true);
  EXPECT_THAT(words.missed, Not(HasSubstr("runs faster until it is on time again")));
  EXPECT_THAT(words.slipped, HasSubstr("never runs skipped ticks later"));
  EXPECT_THAT(words.after_a_slip, HasSubstr("skipped ticks"));
  EXPECT_THAT(words.after_a_slip, Not(HasSubstr("20 ticks")));
}

TEST(TimingPanel, SaysThatTheVirtualArmCatchesUpUntilAStall) {
  const LateTicks words = late_ticks(false);
  EXPECT_THAT(words.missed, HasSubstr("runs faster until it is on time again"));
  EXPECT_THAT(words.after_a_slip, HasSubstr("more than 20 ticks"));
}

// A device in the loop, in ticks of 1 ms, on the built-in arm, whose file says no delay.
class TimingOfADevice : public ReadPanel {
 protected:
  TimingOfADevice() { p_.kind = CouplingKind::proposed; }
  // Draws with limits that are computed anew.
  void draw() {
    timing_ = DeviceTiming();
    show([this] {
      timing_.draw(pace_, arm_, p_, scene_, {pose_.data(), static_cast<std::size_t>(pose_.size())});
    });
  }
  // Lets a thousand readings come, `interval` [s] apart.
  void read_every(double interval) {
    pace_.start();
    for (int k = 0; k < 1000; ++k) {
      pace_.note(static_cast<std::uint64_t>(k + 1), 0, interval * k);
    }
  }

  DeviceTiming timing_;
  DevicePace pace_;
  ArmDescription arm_ = test::omni();
  Eigen::VectorXd pose_ = rest_pose(arm_);
  Parameters p_;
  Scene scene_;
};

TEST_F(TimingOfADevice, SaysWhetherTheDelayIsMeasuredOrSetOrNeither) {
  draw();
  EXPECT_EQ(value("delay"), "not measured");
  EXPECT_THAT(hint("delay"), HasSubstr("`limpid identify` measures this delay."));
  p_.delay = 3;
  draw();
  EXPECT_EQ(value("delay"), "3.00 ms, as set");
  p_.tick = 0.0005;
  draw();
  EXPECT_EQ(value("delay"), "1.50 ms, as set") << "it is set in ticks";
  arm_.delay = 0.0021;
  draw();
  EXPECT_EQ(value("delay"), "2.10 ms, measured") << "whatever is set";
}

TEST_F(TimingOfADevice, SaysHowOftenReadingsComeAndWhetherThatIsTooSeldom) {
  draw();
  EXPECT_EQ(value("readings"), "none yet");
  EXPECT_FALSE(find("jitter"));
  read_every(1e-3);
  draw();
  EXPECT_EQ(value("readings"), "1000 Hz, every 1.00 ms");
  EXPECT_FALSE(broken("readings"));
  EXPECT_EQ(value("jitter"), "0.00 ms, 99 % within 1.00 ms");
  read_every(2e-3);
  draw();
  EXPECT_EQ(value("readings"), "500 Hz, every 2.00 ms");
  EXPECT_TRUE(broken("readings"));
  EXPECT_THAT(hint("readings"), HasSubstr("than the ticks of the loop (1.00 ms)"));
}

// b_d / (T/2 + delay) is largest at once in ticks of 1 ms: b_d / 0.5 ms. Readings every 2 ms and a
// torque 2 ms late leave b_d / 3 ms of it.
TEST_F(TimingOfADevice, SaysWhatPaceAndDelayCostInStiffness) {
  read_every(2e-3);
  arm_.delay = 0.002;
  draw();
  const TipLimits late = tip_limits(arm_, pose_, p_, scene_);
  const TipLimits prompt = without_delay(arm_, pose_, p_, scene_);
  const auto of = [](double now, double at_once) {
    return fmt::format("{:.0f} of {:.0f} N/m", now, at_once);
  };
  EXPECT_EQ(value("stiffest passive wall"), of(prompt.every_hand / 6, prompt.every_hand));
  const double wall = late.wall(p_.kind).stiffness, wall_at_once = prompt.wall(p_.kind).stiffness;
  EXPECT_LT(wall, wall_at_once);
  EXPECT_EQ(value("stiffest wall"), of(wall, wall_at_once));
  EXPECT_THAT(hint("stiffest wall"),
              HasSubstr("the proposed law would render without delay. Reason for the limit: " +
                        late.wall(p_.kind).bound));
}

// Walls are computed four times a second, not with every picture.
TEST_F(TimingOfADevice, ReckonsItsWallsFourTimesASecond) {
  draw();
  const std::string before = value("stiffest wall");
  arm_.delay = 0.004;
  frames(3);
  EXPECT_EQ(value("delay"), "4.00 ms, measured");
  EXPECT_EQ(value("stiffest wall"), before);
  frames(15);  // 0.3 s
  EXPECT_NE(value("stiffest wall"), before);
  const TipLimits late = tip_limits(arm_, pose_, p_, scene_);
  EXPECT_THAT(value("stiffest wall"),
              testing::StartsWith(fmt::format("{:.0f} of ", late.wall(p_.kind).stiffness)));
}

TEST_F(TimingOfADevice, SaysWhatEachFigureIs) {
  read_every(1e-3);
  draw();
  EXPECT_TRUE(find("The device"));
  for (const auto& [label, help] :
       {std::pair("readings", "How often the device reports its position"),
        {"jitter", "Standard deviation of the time between two readings"},
        {"delay", "Delay from a reading to the torque computed from it."},
        {"stiffest wall", "First number: the stiffest wall with this delay."},
        {"stiffest passive wall", "b_d / (T/2 + delay) is the stiffest wall"}}) {
    EXPECT_THAT(hint(label), HasSubstr(help)) << label;
  }
}

// Bars of 50 stretches of time, 1 us to 100 ms by ratios: the n-th begins at 10^(n/10) us.
class HistogramOfTimes : public ReadPanel {
 protected:
  void draw(const LatencyHistogram& times, double late) {
    show([this, &times, late] {
      at_ = ImGui::GetCursorScreenPos();
      width_ = ImGui::GetContentRegionAvail().x;
      draw_time_histogram(times, late, "What it shows.");
      below_ = ImGui::GetCursorScreenPos().y;
    });
  }
  // Returns how tall the n-th bar is, and in which of two colours; 0 and 0 without a bar.
  std::pair<float, ImU32> bar(int n) const {
    const float step = width_ / 50, x = at_.x + step * static_cast<float>(n) + 0.4f * step;
    for (const ImU32 ink : {colour(current_palette().muted), colour(current_palette().broken)}) {
      float tall = 0;
      const auto inked = [&](float up) {
        return test::inked({x, at_.y + kHigh - up}, [=](ImU32 rgba) { return rgba == ink; });
      };
      while (inked(tall + 0.25f)) tall += 0.25f;
      if (tall > 0) return {tall, ink};
    }
    return {0, 0};
  }
  static constexpr float kHigh = 32;  // [px]
  ImVec2 at_{};
  float width_ = 0, below_ = 0;
};

}  // namespace
}  // namespace limpid
