// Experiments of the window on the arm that it shows.
#include <algorithm>
#include <string>

#include "app/experiments/experiment.h"
#include "tests/app/desktop/shell/whole_window.h"

namespace limpid {
namespace {

using testing::HasSubstr;
using testing::Not;

class ExperimentsOnAnArm : public WholeWindow {
 protected:
  void choose(const std::string& arm) {
    const auto list = noted_place("Experiments", "arm of the experiments");
    ASSERT_TRUE(list);
    click(*list);
    click(arm);
  }
};

TEST_F(ExperimentsOnAnArm, OfferTheBuiltInOneAlone) {
  run("experiments.show");
  frames(4);
  click("On the built-in arm, ideal", "Experiments");
  EXPECT_THAT(words(), Not(HasSubstr("with its readings")));
  EXPECT_THAT(words("Experiments"), Not(HasSubstr("has arms of its own")));
}

TEST_F(ExperimentsOnAnArm, MeasureAndKeepTheirResultsApart) {
  run("arm.touch");
  ASSERT_TRUE(until([&] { return desktop->live.stage().arm().name == "touch"; }));
  run("experiments.show");
  frames(4);
  EXPECT_TRUE(find("On the built-in arm, ideal", "Experiments")) << "until somebody chooses";
  choose("On touch with its readings");
  const auto observer = noted_place("Experiments", "Run observer");
  ASSERT_TRUE(observer);
  click(*observer);
  ASSERT_TRUE(until([&] { return said("observer on touch with its readings: "); }));
  frames(4);
  EXPECT_TRUE(said("observer on touch with its readings: measured"));
  EXPECT_THAT(sentences(), HasSubstr("Promised only for the built-in arm"));
  EXPECT_TRUE(std::filesystem::exists(
      dir / "data/limpid/experiments on touch with its readings/observer.json"));
  EXPECT_FALSE(std::filesystem::exists(dir / "data/limpid/experiments"));
}

}  // namespace
}  // namespace limpid
