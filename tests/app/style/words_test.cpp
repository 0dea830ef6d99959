#include "app/style/words.h"

#include <gmock/gmock.h>

#include <cctype>
#include <set>

#include "app/style/sliders.h"

namespace limpid {
namespace {

using testing::HasSubstr;

TEST(WordsOfSliders, SayOfEveryLawsSlidersWhatTheyAreBeforeTheSymbol) {
  for (std::uint8_t kind = 0; kind < kLaws; ++kind) {
    for (const char* key : info(static_cast<CouplingKind>(kind)).sliders) {
      const std::string words = find_parameter(key)->caption;
      EXPECT_TRUE(std::isupper(static_cast<unsigned char>(words.front())) != 0) << words;
      EXPECT_NE(words.find(' '), std::string::npos) << words;
    }
  }
  EXPECT_STREQ(find_parameter("coupling.eta")->caption, "Impedance scaling \xCE\xB7");
}

// ImGui's own font has 7 px a letter.
TEST(ShortenedNames, KeepBeginningAndEndWithinTheirRoom) {
  ImGui::CreateContext();
  unsigned char* pixels = nullptr;
  int wide = 0, high = 0;
  ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
  fonts.AddFontDefault();
  fonts.GetTexDataAsAlpha8(&pixels, &wide, &high);
  const ImFont& font = *fonts.Fonts[0];
  const std::string name = "a-recording-with-a-very-long-name-20261126.h5";
  EXPECT_EQ(shortened(name, 7 * static_cast<float>(name.size()), &font), name);
  for (const float room : {70.0f, 140.0f, 200.0f}) {
    const std::string shorter = shortened(name, room, &font);
    const std::size_t gap = shorter.find("\xE2\x80\xA6");
    ASSERT_NE(gap, std::string::npos);
    EXPECT_LE(font.CalcTextSizeA(font.FontSize, 1e9f, 0, shorter.c_str()).x, room);
    EXPECT_TRUE(name.starts_with(shorter.substr(0, gap))) << shorter;
    EXPECT_TRUE(name.ends_with(shorter.substr(gap + 3))) << shorter;
    EXPECT_GT(shorter.size(), room / 7 - 2 + 2) << "no more is left out than has to be";
  }
  EXPECT_EQ(shortened("\xC3\xA4\xC3\xB6\xC3\xBC", 1, &font), "\xE2\x80\xA6") << "no letter is cut";
  ImGui::DestroyContext();
}

TEST(WordsOfSliders, MarkAChangeAsTheSliderReads) {
  Parameters p;
  p.eta = 1 / 1.1;
  const ParameterInfo& eta = *find_parameter("coupling.eta");
  EXPECT_EQ(mark_text(eta, p), "\xCE\xB7 " + with_unit(eta, p.eta));
  EXPECT_THAT(mark_text(eta, p), HasSubstr("0.909"));
  p.kind = CouplingKind::predictive;
  EXPECT_THAT(mark_text(*find_parameter("coupling.kind"), p), HasSubstr("predictive"));
  EXPECT_THAT(mark_text(*find_parameter("device.torque_limit"), p), HasSubstr("the arm's"));
  EXPECT_THAT(mark_text(*find_parameter("coupling.damping"), p), HasSubstr("automatic"));
  p.anti_windup = false;
  EXPECT_THAT(mark_text(*find_parameter("observer.anti_windup"), p), HasSubstr("off"));
}

TEST(GreekWords, HaveLettersButNotInKeys) {
  EXPECT_EQ(with_greek("eta scales it, alpha not"), "\xCE\xB7 scales it, \xCE\xB1 not");
  EXPECT_EQ(with_greek("above eta_min, at eta."), "above \xCE\xB7_min, at \xCE\xB7.");
  EXPECT_EQ(with_greek("coupling.eta, eta=0.5, beta, detail, theta"),
            "coupling.eta, eta=0.5, beta, detail, theta");
  EXPECT_EQ(with_greek(""), "");
}

TEST(WordsOfSliders, WriteLargeEnergiesInJoules) {
  EXPECT_EQ(energy_text(5.761), "5.76 J");
  EXPECT_EQ(energy_text(0.0642), "64.2 mJ");
  EXPECT_EQ(energy_text(-0.0642),
            "\xE2\x88\x92"
            "64.2 mJ");
  EXPECT_EQ(energy_text(0), "0 mJ");
  EXPECT_EQ(energy_text(-1e-9), "0 mJ");
}

struct Stepped : testing::TestWithParam<const char*> {
  const ParameterInfo& info = *find_parameter(GetParam());
  const double usual = parameter_number(Parameters{}, info);
  double step(double value, int direction) const {
    return slider_step(info, value, usual, direction);
  }
};
INSTANTIATE_TEST_SUITE_P(Keys, Stepped,
                         testing::Values("coupling.eta", "observer.alpha", "coupling.k_vc",
                                         "hand.stiffness"));

TEST_P(Stepped, ComesBackToThePapersValueExactly) {
  for (int steps = 1; steps < 12; ++steps) {
    for (const int direction : {1, -1}) {
      double value = usual;
      for (int i = 0; i < steps; ++i) value = step(value, direction);
      EXPECT_NE(value, usual);
      for (int i = 0; i < steps; ++i) value = step(value, -direction);
      EXPECT_EQ(value, usual) << steps;
    }
  }
}

TEST_P(Stepped, MovesByAboutATenthToARoundNumber) {
  for (double value = info.slider_minimum; value < 0.8 * info.slider_maximum;) {
    const double next = step(value, 1);
    EXPECT_GT(next / value, 1.04);
    EXPECT_LT(next / value, 1.2);
    EXPECT_EQ(std::stod(fmt::format("{:.2g}", next)), next) << "two digits";
    value = next;
  }
}

TEST_P(Stepped, FromBetweenGoesToTheNextOneAndStaysInsideTheSlider) {
  EXPECT_GT(step(usual * 1.03, 1), usual * 1.03);
  EXPECT_EQ(step(usual * 1.03, -1), usual);
  EXPECT_EQ(step(info.slider_maximum, 1), info.slider_maximum);
  EXPECT_EQ(step(info.slider_minimum, -1), info.slider_minimum);
  EXPECT_GE(step(0, 1), info.slider_minimum);
}

}  // namespace
}  // namespace limpid
