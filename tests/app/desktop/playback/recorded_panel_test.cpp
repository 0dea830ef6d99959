#include "app/desktop/playback/recorded_panel.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace limpid {
namespace {

const RecordedSetting* find(const std::vector<RecordedSetting>& all, const std::string& name) {
  const auto found = std::ranges::find_if(
      all, [&](const RecordedSetting& each) { return each.name.starts_with(name); });
  return found == all.end() ? nullptr : &*found;
}

TEST(RecordedSettings, TellLawGripAndWhatIsNotAsUsual) {
  Parameters p;
  p.kind = CouplingKind::proposed;
  p.eta = 0.25;
  p.hand_stiffness = 450;
  const auto plain = recorded_settings(std::span(&p, 1));
  ASSERT_NE(find(plain, "Coupling"), nullptr);
  EXPECT_EQ(find(plain, "Coupling")->values, std::vector<std::string>{"proposed"});
  ASSERT_NE(find(plain, "Impedance scaling"), nullptr);
  EXPECT_NE(find(plain, "Impedance scaling")->values.at(0).find("0.25"), std::string::npos);
  EXPECT_TRUE(std::ranges::any_of(plain, [](const RecordedSetting& each) {
    return each.values.at(0).find("450") != std::string::npos;
  }));
  p.encoder_step = 1e-4;  // listed only if it is not the default
  EXPECT_EQ(recorded_settings(std::span(&p, 1)).size(), plain.size() + 1);
}

TEST(RecordedSettings, AreTheLawAndWhatIsNotAsUsualInTheSimpleWindow) {
  Parameters p;
  p.kind = CouplingKind::proposed;
  EXPECT_EQ(recorded_settings(std::span(&p, 1), false).size(), 1u);
  p.hand_stiffness = 450;
  const auto two = recorded_settings(std::span(&p, 1), false);
  ASSERT_EQ(two.size(), 2u);
  EXPECT_NE(two[1].values.at(0).find("450"), std::string::npos);
}

TEST(RecordedSettings, OfTwoRunsStandSideBySide) {
  std::vector<Parameters> lanes(2);
  lanes[0].kind = CouplingKind::standard;
  lanes[1].kind = CouplingKind::predictive;
  const auto both = recorded_settings(lanes);
  ASSERT_NE(find(both, "Coupling"), nullptr);
  EXPECT_EQ(find(both, "Coupling")->values, (std::vector<std::string>{"standard", "predictive"}));
  for (const std::string_view key : info(CouplingKind::predictive).sliders) {
    const ParameterInfo& slider = *find_parameter(std::string(key));
    const auto there = std::ranges::any_of(
        both, [&](const RecordedSetting& each) { return each.help == slider.meaning; });
    EXPECT_EQ(there, slider.kind != FieldInfo::Kind::flag) << key;
  }
  const std::string per_joint = find_parameter("coupling.per_joint")->caption;
  EXPECT_EQ(find(both, per_joint), nullptr) << "off, as ever";
  lanes[1].per_joint = true;
  EXPECT_NE(find(recorded_settings(lanes), per_joint), nullptr);
}

}  // namespace
}  // namespace limpid
