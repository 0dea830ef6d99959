// Signs over the picture: where they stand, and what their buttons do.
#include "app/desktop/view/over_view.h"

#include <imgui_internal.h>

#include "tests/app/desktop/widgets/read_panel.h"

namespace limpid {
namespace {

class SignsOverThePicture : public ReadPanel {
 protected:
  // Draws banners in a view whose own signs take its upper left corner.
  void show_banners(float wide) {
    view_ = {{100, 50}, {100 + wide, 700}};
    show([&] {
      taken_ = draw_banners(banners_, view_, signs_, [&](std::string_view id) { ran_ = id; });
    });
  }
  static ScreenRect place(const char* window) {
    const ImGuiWindow* found = ImGui::FindWindowByName(window);
    EXPECT_TRUE(found);
    return found != nullptr ? ScreenRect{found->Pos, found->Rect().Max} : ScreenRect{};
  }
  void expect_in_view(const ScreenRect& rect) const {
    EXPECT_GE(rect.min.x, view_.min.x);
    EXPECT_LE(rect.max.x, view_.max.x);
    EXPECT_GE(rect.min.y, view_.min.y);
    EXPECT_LE(rect.max.y, view_.max.y);
  }
  static bool apart(const ScreenRect& a, const ScreenRect& b) {
    return a.max.x <= b.min.x || b.max.x <= a.min.x || a.max.y <= b.min.y || b.max.y <= a.min.y;
  }

  std::vector<Banner> banners_{
      {.id = "first", .text = "The force is off.", .bad = true, .buttons = {{"On", "force.on"}}},
      {.id = "second",
       .text =
           "A sentence that is so long that it has no room beside its buttons in a narrow view, "
           "where it goes on in the next line, and in the one after that.",
       .buttons = {{"Keep", "keep"}, {"Discard", "discard"}}}};
  ScreenRect view_, signs_{{100, 50}, {260, 130}}, taken_;
  std::string ran_;
};

TEST_F(SignsOverThePicture, AreBesideThoseOfTheViewWhereThereIsRoomElseBelow) {
  for (const float wide : {1200.f, 700.f, 450.f, 300.f}) {
    show_banners(wide);
    const ScreenRect first = place("first"), second = place("second");
    SCOPED_TRACE(wide);
    for (const ScreenRect& each : {first, second}) {
      expect_in_view(each);
      EXPECT_TRUE(apart(each, signs_));
      EXPECT_GE(taken_.max.y, each.max.y) << "what comes next stands below";
    }
    EXPECT_TRUE(apart(first, second));
    EXPECT_GE(second.min.y, first.max.y);
    EXPECT_EQ(first.min.y<signs_.max.y, wide> 650) << "beside";
    EXPECT_EQ(taken_.min.x, signs_.min.x);
    EXPECT_EQ(taken_.max.x, view_.max.x);
    for (const char* text : {"The force is off.", "On", "Keep", "Discard"}) {
      const auto found = find(text);
      ASSERT_TRUE(found) << text;
      EXPECT_TRUE(found->whole()) << text;
    }
  }
  banners_.clear();
  show_banners(700);
  EXPECT_EQ(taken_.max.y, signs_.max.y);
}

TEST_F(SignsOverThePicture, HaveButtonsInTheirLineOrBelow) {
  show_banners(1450);
  const auto at = [&](const char* text) { return find(text)->middle(); };
  EXPECT_NEAR(at("On").y, at("The force is off.").y, 3);
  EXPECT_GT(at("On").x, at("The force is off.").x);
  EXPECT_NEAR(at("Keep").y, at("Discard").y, 3);
  EXPECT_LT(at("Keep").x, at("Discard").x);
  show_banners(450);
  float lowest = 0;
  for (const test::DrawnText& each : test::drawn_texts()) {
    if (each.window == "second" && each.text != "Keep" && each.text != "Discard") {
      lowest = std::max(lowest, each.max.y);
    }
  }
  EXPECT_GT(find("Keep")->min.y, lowest) << "below the sentence";
  EXPECT_NEAR(at("Keep").y, at("Discard").y, 3);
}

TEST_F(SignsOverThePicture, RunTheirCommands) {
  show_banners(1450);
  for (const auto& [label, command] :
       {std::pair("On", "force.on"), {"Keep", "keep"}, {"Discard", "discard"}}) {
    click(label);
    EXPECT_EQ(ran_, command);
  }
}

TEST_F(SignsOverThePicture, TellNoticesBelowEachOtherWithinTheView) {
  Notices notices;
  notices.say("Started over");
  notices.say(
      "A recording could not be completed, as the disk is full; what is there stays where it is, "
      "and can be recovered once there is room.",
      true);
  for (const float wide : {1200.f, 700.f, 300.f}) {
    view_ = {{100, 50}, {100 + wide, 700}};
    NoticeSigns signs;
    show([&] { signs.draw(notices, view_, signs_, {}); });
    const auto first = find("Started over");
    ASSERT_TRUE(first);
    bool more = false;
    for (const test::DrawnText& each : test::drawn_texts()) {
      const ScreenRect rect{each.min, each.max};
      EXPECT_TRUE(apart(rect, signs_)) << each.text << " at " << wide;
      expect_in_view(rect);
      if (each.text == first->text) continue;
      more = true;
      EXPECT_GT(each.min.y, first->max.y) << each.text;
    }
    EXPECT_TRUE(more);
    EXPECT_EQ(first->min.y<signs_.max.y, wide> 650) << wide << ": beside";
  }
}

TEST_F(SignsOverThePicture, TellNoticesAtTheFootWhereATipIsAtTheTop) {
  Notices notices;
  notices.say("Started over, at rest.");
  NoticeSigns signs;
  view_ = {{100, 50}, {1300, 700}};
  const ScreenRect tip{{view_.min.x, view_.min.y}, {view_.max.x, view_.min.y + 100}};
  const float middle = (view_.min.y + view_.max.y) / 2;
  for (const bool low : {false, true}) {
    const Crowd crowd = low ? Crowd{{tip}, {}} : Crowd{};
    show([&] { signs.draw(notices, view_, signs_, crowd); });
    const auto said = find("Started over, at rest.");
    ASSERT_TRUE(said);
    EXPECT_EQ(said->min.y > middle, low);
    expect_in_view({said->min, said->max});
  }
}

TEST_F(SignsOverThePicture, TellNoticesBesideTipLensAndCardsWhereThereIsRoom) {
  Notices notices;
  notices.say(
      "A recording could not be completed, as the disk is full; what is there stays where it is, "
      "and can be recovered once there is room.");
  view_ = {{450, 50}, {1550, 700}};
  const ScreenRect legend{view_.min, {610, 130}};
  const ScreenRect tip{{950, 60}, {1010, 120}}, lens{{1290, 440}, {1543, 693}};
  const ScreenRect card{{623, 160}, {923, 480}};
  NoticeSigns signs;
  for (const bool with_card : {false, true}) {
    show([&] {
      if (with_card) {
        ImGui::SetNextWindowPos(card.min);
        ImGui::SetNextWindowSize(card.size());
        ImGui::Begin("card", nullptr, ImGuiWindowFlags_NoDecoration);
        ImGui::End();
      }
      signs.draw(notices, view_, legend, {{tip, lens}, {}});
    });
    ASSERT_FALSE(test::drawn_texts().empty());
    for (const test::DrawnText& each : test::drawn_texts()) {
      const ScreenRect rect{each.min, each.max};
      expect_in_view(rect);
      EXPECT_TRUE(apart(rect, legend)) << each.text;
      EXPECT_TRUE(apart(rect, tip)) << each.text;
      EXPECT_TRUE(apart(rect, lens)) << each.text;
      if (with_card) {
        EXPECT_TRUE(apart(rect, card)) << each.text;
      }
    }
  }
}

}  // namespace
}  // namespace limpid
