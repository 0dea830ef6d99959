// The panel of the grip: how it is measured, what was found, and what follows for walls.
#include "app/desktop/coupling/grip_panel.h"

#include <fmt/format.h>

#include <cmath>

#include "tests/app/desktop/widgets/read_panel.h"
#include "tests/support/built_in.h"
#include "tests/support/until.h"

namespace limpid {
namespace {

using testing::HasSubstr;

class GripPanel : public ReadPanel {
 protected:
  GripPanel() {
    p_.hand_stiffness = 520;
    p_.hand_damping = 3;
    p_.hand_mass_at_tip = 0.1;
    session_.open(arm_, Scene{}, p_, Vec3(0.19, 0, 0));
    EXPECT_TRUE(turn_until([this] { return session_.loop().snapshot().arming == Arming::on; }));
    show([this] { draw_grip(meter_, arm_, Scene{}, p_); });
  }
  // Lets the loop go on between pictures.
  bool turn_until(const std::function<bool()>& done) {
    return test::until([&] {
      session_.turn([this](LaneRows rows, std::uint64_t) { meter_.take(rows[kMainLane]); });
      meter_.update();
      return done();
    });
  }

  const ArmDescription arm_ = test::omni();
  Parameters p_;
  LiveSession session_{{}};
  GripMeter meter_{session_};
};

TEST_F(GripPanel, BeginsAndEndsAMeasurement) {
  EXPECT_THAT(hint("Measure the grip"), HasSubstr("Press this button to begin."));
  EXPECT_FALSE(find("Stop measuring"));
  EXPECT_FALSE(find("Take as the hand")) << "nothing is known yet";
  click("Measure the grip");
  EXPECT_TRUE(meter_.busy());
  EXPECT_FALSE(find("Measure the grip"));
  ASSERT_TRUE(turn_until([this] { return meter_.time() > 0.1; }));
  frames();
  EXPECT_TRUE(find(fmt::format("hold still: {:.0f} s", meter_.time()))) << words();
  click("Stop measuring");
  EXPECT_FALSE(meter_.busy());
  EXPECT_TRUE(find("Measure the grip"));
  EXPECT_FALSE(find("stiffness"));
  session_.loop().cut();
  ASSERT_TRUE(turn_until([this] { return !meter_.why_not().empty(); }));
  frames();
  click("Measure the grip");
  EXPECT_FALSE(meter_.busy()) << "there is no force";
}

TEST_F(GripPanel, ShowsWhatWasFoundAndTakesItAsTheHand) {
  // A busy computer may stop the loop for a moment: the grip is measured again then.
  ASSERT_TRUE(test::until([this] {
    session_.loop().arm();
    EXPECT_TRUE(turn_until([this] { return meter_.why_not().empty(); }));
    frames();
    click("Measure the grip");
    EXPECT_TRUE(turn_until([this] { return !meter_.busy(); }));
    return meter_.found() != nullptr && meter_.found()->grip.known();
  }));
  const MeasuredHand& found = *meter_.found();
  p_.kind = CouplingKind::direct;
  frames();
  for (const GripLine& line : grip_lines(found)) {
    std::string value_there = value(line.label);
    const std::string start = line.value.substr(0, line.value.find(' '));
    EXPECT_THAT(value_there, testing::StartsWith(start)) << line.label;
    EXPECT_THAT(hint(line.label), HasSubstr("Bounds with 95 % confidence")) << line.label;
  }
  ASSERT_TRUE(found.hands);
  for (std::uint8_t i = 0; i < kLaws; ++i) {
    const auto kind = static_cast<CouplingKind>(i);
    const std::string label = std::string("stable walls, ") + info(kind).key;
    const bool told = kind == p_.kind || !info(kind).for_comparison;
    EXPECT_EQ(find(label).has_value(), told) << label;
    if (!told) continue;
    const SafeWalls& walls = found.hands->laws[i].in_range;
    EXPECT_EQ(value(label), !walls.up_to ? "not known"
                            : std::isinf(*walls.up_to)
                                ? "all"
                                : fmt::format("up to {:.0f} N/m", *walls.up_to));
    EXPECT_THAT(hint(label), HasSubstr("Walls that are stable in this hand")) << label;
  }
  const Parameters taken = with_grip(p_, found.grip);
  EXPECT_THAT(hint("Take as the hand"), HasSubstr("Sets grip stiffness, grip damping and hand"));
  click("Take as the hand");
  EXPECT_EQ(p_, taken);
  EXPECT_NEAR(p_.hand_stiffness, 520, 0.1 * 520);
}

}  // namespace
}  // namespace limpid
