#include "app/plot/band_names.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace limpid {
namespace {

constexpr NameLine kOfLaws{0, 400, 10, false}, kOfStates{0, 400, 10, true};

// Returns the left ends of the names that have room, each after its stretch's number.
std::vector<std::pair<std::size_t, double>> places(const std::vector<NamedStretch>& stretches,
                                                   const NameLine& line) {
  std::vector<std::pair<std::size_t, double>> all;
  for (const PlacedName& name : place_names(stretches, line)) {
    all.emplace_back(name.stretch, name.left);
  }
  return all;
}

using Places = std::vector<std::pair<std::size_t, double>>;

TEST(BandNames, BeginWithTheirStretches) {
  EXPECT_EQ(places({{0, 0, 100, 50}, {1, 100, 200, 50}}, kOfLaws), (Places{{0, 0}, {1, 100}}));
  EXPECT_EQ(places({{0, -20, 100, 50}}, kOfLaws), (Places{{0, 0}})) << "at the line's left end";
  EXPECT_TRUE(places({}, kOfLaws).empty());
}

TEST(BandNames, BeginWhereTheOneBeforeEndsIfTheyFit) {
  EXPECT_EQ(places({{0, 0, 55, 50}, {1, 55, 200, 50}}, kOfLaws), (Places{{0, 0}, {1, 60}}));
  EXPECT_EQ(places({{0, 0, 55, 50}, {1, 55, 109, 50}}, kOfLaws), (Places{{0, 0}}));
  // A state's name sticks out to the right, over the next one's left end.
  EXPECT_EQ(places({{1, 0, 5, 50}, {2, 20, 200, 50}}, kOfStates), (Places{{0, 0}, {1, 60}}));
  EXPECT_EQ(places({{1, 0, 5, 50}, {2, 20, 90, 50}}, kOfStates), (Places{{0, 0}}));
}

TEST(BandNames, OfALawWithoutRoomWaitForItsNextStretch) {
  EXPECT_EQ(places({{0, 0, 100, 50}, {1, 100, 120, 50}, {1, 150, 250, 50}}, kOfLaws),
            (Places{{0, 0}, {2, 150}}));
  EXPECT_EQ(places({{1, 0, 20, 50}, {0, 20, 100, 50}, {1, 100, 200, 50}}, kOfLaws),
            (Places{{1, 20}, {2, 100}}));
}

TEST(BandNames, AreSaidOnceUntilAnotherValueComes) {
  EXPECT_EQ(places({{0, 0, 100, 50}, {0, 110, 200, 50}}, kOfLaws), (Places{{0, 0}}));
  EXPECT_EQ(places({{0, 0, 100, 50}, {1, 100, 110, 50}, {0, 110, 200, 50}}, kOfLaws),
            (Places{{0, 0}, {2, 110}}));
}

// The usual value has no name. What flickers is named once, and again where it lasts.
TEST(BandNames, OfAStateMayStickOutTheFirstTime) {
  EXPECT_EQ(places({{0, 0, 100, 0}, {1, 100, 110, 50}, {0, 110, 200, 0}}, kOfStates),
            (Places{{1, 100}}));
  EXPECT_EQ(places({{1, 100, 110, 50},
                    {0, 110, 200, 0},
                    {1, 200, 210, 50},
                    {0, 210, 220, 0},
                    {1, 220, 300, 50}},
                   kOfStates),
            (Places{{0, 100}, {4, 220}}));
}

TEST(BandNames, StayWithinTheLine) {
  EXPECT_EQ(places({{1, 380, 400, 50}}, kOfStates), (Places{{0, 350}}));
  EXPECT_TRUE(places({{1, 380, 400, 50}}, kOfLaws).empty());
  EXPECT_EQ(places({{1, -30, 5, 50}}, kOfStates), (Places{{0, 0}})) << "seen in part";
  EXPECT_EQ(places({{1, 200, 400, 600}}, kOfStates), (Places{{0, 0}})) << "wider than the line";
  EXPECT_EQ(places({{1, 300, 320, 50}, {2, 390, 400, 50}}, kOfStates), (Places{{0, 300}}))
      << "there is no room left of it";
}

TEST(LawEdges, AreAsManyAsTheLastLaneNeeds) {
  EXPECT_EQ(law_edges({}), 1);
  const std::vector<Band> bands{{.laws = true}, {.laws = true, .lane = 2}, {.striped = true}};
  EXPECT_EQ(law_edges(bands), 3);
}

}  // namespace
}  // namespace limpid
