// The watch over the running loop for chatter: whom it blames, and for how long.
#include "tests/app/desktop/shell/a_desktop.h"

namespace limpid {
namespace {

using testing::StartsWith;

// The twin alone presses on the table under a law that does not hold it.
TEST_F(ADesktop, BlamesTheTwinThatChattersAndStillDoesWhenItHasLetGo) {
  LaneSettings& lanes = desktop->settings.lanes;
  lanes.parameters[0].kind = CouplingKind::predictive;
  desktop->tuning.toggle_twin();
  lanes.parameters[1].kind = CouplingKind::proposed;
  lanes.parameters[1].eta = 1;
  ASSERT_EQ(document().scene().objects[0].name, "table top");
  Object table = document().scene().objects[0];
  table.material.stiffness = 5000;
  document().editor().set(0, table, "stiffness");
  Controls& controls = desktop->live.controls();
  controls.goal = Vec3(0.2, 0, 0);
  controls.grab = true;
  frames(50);
  for (int i = 1; i <= 100; ++i) {
    controls.goal.z() = -0.045 * i / 100;
    frames(1);
  }
  ASSERT_TRUE(until([&] { return desktop->chatter.found().has_value(); }));
  const std::string blame =
      ", because table top (5000 N/m) is stiffer than the proposed law of the twin can render "
      "there without chatter.";
  EXPECT_EQ(desktop->chatter.text(), "The loop chatters" + blame);
  EXPECT_EQ(desktop->chatter.found()->lane, 1u);
  controls.grab = false;
  const auto over = [&] {
    return !desktop->chatter.found() || desktop->chatter.text() == "The loop chattered" + blame;
  };
  ASSERT_TRUE(until(over));
  ASSERT_TRUE(desktop->chatter.found()) << "it is told of for a while";
  lanes.parameters[0].eta = 0.9;
  frames(5);
  EXPECT_TRUE(desktop->chatter.found()) << "the first run's settings are not to blame";
  run("coupling.mend_chatter");
  EXPECT_FALSE(desktop->chatter.found());
  EXPECT_EQ(lanes.parameters[1].kind, CouplingKind::predictive);
  EXPECT_EQ(lanes.parameters[1].eta, 1);
}

// Each command about the runs says what has become of them.
TEST_F(ADesktop, SaysHowManyCouplingsThereAre) {
  LaneSettings& lanes = desktop->settings.lanes;
  const auto told = [&] { return desktop->notices.all().back().text; };
  desktop->tuning.toggle_twin();
  EXPECT_EQ(lanes.count, 2u);
  EXPECT_THAT(told(), StartsWith("Two couplings on one hand."));
  EXPECT_NE(lanes.parameters[1].kind, lanes.parameters[0].kind) << "it would be the same run";
  desktop->tuning.add_lane();
  EXPECT_EQ(lanes.count, 3u);
  EXPECT_THAT(told(), StartsWith("Three couplings on one hand."));
  EXPECT_NE(lanes.parameters[2].kind, lanes.parameters[0].kind);
  EXPECT_NE(lanes.parameters[2].kind, lanes.parameters[1].kind);
  lanes.edited = 2;
  frames(2);
  EXPECT_EQ(&desktop->tuning.edited(), &lanes.parameters[2]);
  desktop->tuning.drop_lane();
  EXPECT_EQ(lanes.count, 2u);
  EXPECT_EQ(lanes.edited, 0u);
  EXPECT_EQ(told(), "The third run has ended.");
  desktop->tuning.toggle_twin();
  EXPECT_EQ(lanes.count, 1u);
  EXPECT_EQ(told(), "The twin (second run) has ended. Key B starts the twin again.");
  desktop->tuning.toggle_twin();
  desktop->tuning.add_lane();
  desktop->tuning.toggle_twin();
  EXPECT_EQ(lanes.count, 1u);
  EXPECT_EQ(told(), "Only the first run is left. Key B starts a second run again.");
  desktop->tuning.add_lane();
  EXPECT_THAT(told(), StartsWith("Two couplings on one hand."));
}

TEST_F(ADesktop, GoesThroughTheLawsThatHaveButtons) {
  Parameters& p = desktop->settings.parameters();
  for (const bool linked : {false, true}) {
    p.link_delay = linked ? 2 : 0;
    p.kind = CouplingKind::standard;
    std::vector<CouplingKind> seen;
    do {
      seen.push_back(p.kind);
      desktop->tuning.next_law();
    } while (p.kind != CouplingKind::standard && seen.size() < kLaws);
    std::vector<CouplingKind> wanted;
    for (std::uint8_t i = 0; i < kLaws; ++i) {
      const LawInfo& law = info(CouplingKind{i});
      if (!law.for_comparison && (linked || !law.for_links)) wanted.push_back(CouplingKind{i});
    }
    EXPECT_THAT(seen, testing::UnorderedElementsAreArray(wanted)) << "linked: " << linked;
  }
}

TEST_F(ADesktop, SaysWhatUsualValuesAndPresetsDo) {
  Parameters& p = desktop->settings.parameters();
  p.eta = 0.2;
  p.hand_stiffness = 777;
  desktop->tuning.reset();
  EXPECT_EQ(p.eta, Parameters{}.eta);
  EXPECT_EQ(p.hand_stiffness, Parameters{}.hand_stiffness);
  EXPECT_TRUE(said("All settings"));
  desktop->tuning.use_preset("no preset of this name");
  EXPECT_FALSE(said("no preset of this name"));
  desktop->tuning.use_preset("Light hand");
  EXPECT_TRUE(said("Settings: Light hand. Ctrl+Z brings back the earlier settings."));
  EXPECT_EQ(p.kind, CouplingKind::predictive);
  EXPECT_EQ(p.eta, 0.3);
}

}  // namespace
}  // namespace limpid
