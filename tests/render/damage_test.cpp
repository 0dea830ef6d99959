// Damage: the area of a picture that has to be drawn anew.
#include "render/damage.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

namespace limpid {
namespace {

constexpr int kWide = 200, kHigh = 100;

std::span<const std::byte> bytes(const int& look) { return std::as_bytes(std::span(&look, 1)); }

// World and clip space are the same here: -1 to 1 over the picture.
class ADamage : public testing::Test {
 protected:
  ADamage() { frame({{1, {0, 0, 0}}}); }

  struct Thing {
    int look;
    glm::vec3 at;
    float margin = 3;
  };
  PixelArea frame(const std::vector<Thing>& things, const glm::mat4& to_clip = glm::mat4(1),
                  int width = kWide, int height = kHigh) {
    damage_.begin(to_clip, width, height);
    for (const Thing& thing : things) {
      damage_.add(bytes(thing.look), std::span(&thing.at, 1), thing.margin);
    }
    return damage_.end();
  }
  static void expect_all(const PixelArea& area, int width = kWide, int height = kHigh) {
    EXPECT_EQ(area.min(), Eigen::Vector2i(0, 0));
    EXPECT_EQ(area.max(), Eigen::Vector2i(width, height));
  }
  static void expect_area(const PixelArea& area, int x0, int y0, int x1, int y1) {
    EXPECT_EQ(area.min(), Eigen::Vector2i(x0, y0));
    EXPECT_EQ(area.max(), Eigen::Vector2i(x1, y1));
  }

  Damage damage_;
};

TEST_F(ADamage, IsAllOfItAtFirstAndNothingWhereNothingChanges) {
  Damage fresh;
  fresh.begin(glm::mat4(1), kWide, kHigh);
  expect_all(fresh.end());
  EXPECT_TRUE(frame({{1, {0, 0, 0}}}).isEmpty());
}

TEST_F(ADamage, IsAllOfItWhereTheSizeOrTheCameraIsAnother) {
  expect_all(frame({{1, {0, 0, 0}}}, glm::mat4(1), kWide + 1, kHigh), kWide + 1, kHigh);
  expect_all(frame({{1, {0, 0, 0}}}, glm::mat4(1), kWide + 1, kHigh - 1), kWide + 1, kHigh - 1);
  EXPECT_TRUE(frame({{1, {0, 0, 0}}}, glm::mat4(1), kWide + 1, kHigh - 1).isEmpty());
  const glm::mat4 aside = glm::translate(glm::mat4(1), glm::vec3(1e-3f, 0, 0));
  expect_all(frame({{1, {0, 0, 0}}}, aside, kWide + 1, kHigh - 1), kWide + 1, kHigh - 1);
}

TEST_F(ADamage, IsAllOfItOnceItIsSpoilt) {
  damage_.spoil();
  expect_all(frame({{1, {0, 0, 0}}}));
  EXPECT_TRUE(frame({{1, {0, 0, 0}}}).isEmpty());
}

// A point stands for a pixel and its margin: from 3 pixels before it to 3 behind; the next one is
// outside.
TEST_F(ADamage, IsWhereAThingLooksDifferentAndWhereItWas) {
  expect_area(frame({{2, {0, 0, 0}}}), 97, 47, 104, 54);
  expect_area(frame({{3, {0.5f, -0.5f, 0}}}), 97, 22, 154, 54);
  expect_area(frame({{4, {0.5f, -0.5f, 0}, 10}}), 140, 15, 161, 36);
  EXPECT_TRUE(frame({{4, {0.5f, -0.5f, 0}, 10}}).isEmpty());
}

TEST_F(ADamage, IsWhereAThingCameOrWent) {
  expect_area(frame({{1, {0, 0, 0}}, {7, {-0.5f, 0.5f, 0}}}), 47, 72, 54, 79);
  expect_area(frame({{1, {0, 0, 0}}}), 47, 72, 54, 79);
}

TEST_F(ADamage, EndsAtThePicturesEdges) {
  expect_area(frame({{1, {0, 0, 0}}, {7, {1, 1, 0}}}), 197, 97, 200, 100);
  EXPECT_TRUE(frame({{1, {0, 0, 0}}, {8, {3, 3, 0}}}).isEmpty() == false);
}

// A thing behind the eye may be anywhere in the picture.
TEST_F(ADamage, IsAllOfItForWhatIsBehindTheEye) {
  const glm::mat4 eye = glm::perspective(1.0f, 2.0f, 0.1f, 10.0f);
  frame({{1, {0, 0, -1}}}, eye);
  EXPECT_TRUE(frame({{1, {0, 0, -1}}}, eye).isEmpty());
  expect_all(frame({{2, {0, 0, 1}}}, eye));
}

TEST(Cropped, FillsTheViewWithAnArea) {
  const PixelArea whole(Eigen::Vector2i(0, 0), Eigen::Vector2i(kWide, kHigh));
  const PixelArea area(Eigen::Vector2i(50, 20), Eigen::Vector2i(150, 45));
  const glm::mat4 to_clip = cropped(glm::mat4(1), area, whole);
  const auto shown = [&](float x, float y) -> Eigen::Vector3f {  // clip space of a pixel's corner
    const glm::vec4 p = to_clip * glm::vec4(2 * x / kWide - 1, 2 * y / kHigh - 1, 0.25f, 1);
    return Eigen::Vector3f(p.x, p.y, p.z) / p.w;
  };
  EXPECT_TRUE(shown(50, 20).isApprox(Eigen::Vector3f(-1, -1, 0.25f), 1e-5f));
  EXPECT_TRUE(shown(150, 45).isApprox(Eigen::Vector3f(1, 1, 0.25f), 1e-5f));
  EXPECT_TRUE(shown(100, 45).isApprox(Eigen::Vector3f(0, 1, 0.25f), 1e-5f));
}

}  // namespace
}  // namespace limpid
