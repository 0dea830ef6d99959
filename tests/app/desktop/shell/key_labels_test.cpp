// Characters of keyboards without Shift, as X has them (xkb-data), by hand.
#include "app/desktop/shell/key_labels.h"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

namespace limpid {
namespace {

// Four rows from the left, beginning with the key below Esc; "~" stands for nothing.
using Rows = std::vector<std::string>;

const std::vector<std::vector<int>> kRows{
    {GLFW_KEY_GRAVE_ACCENT, '1', '2', '3', '4', '5', '6', '7', '8', '9', '0', '-', '='},
    {'Q', 'W', 'E', 'R', 'T', 'Y', 'U', 'I', 'O', 'P', '[', ']'},
    {'A', 'S', 'D', 'F', 'G', 'H', 'J', 'K', 'L', ';', '\'', '\\'},
    {'Z', 'X', 'C', 'V', 'B', 'N', 'M', ',', '.', '/'}};

class Keyboard {
 public:
  explicit Keyboard(const Rows& rows) {
    for (std::size_t row = 0; row < rows.size(); ++row) {
      std::size_t at = 0;
      for (std::size_t place = 0; place < kRows[row].size(); ++place) {
        std::size_t size = 1;
        while (at + size < rows[row].size() && (rows[row][at + size] & 0xC0) == 0x80) ++size;
        names_[kRows[row][place]] = rows[row].substr(at, size);
        at += size;
      }
    }
  }
  KeyLabels labels() const {
    return KeyLabels([this](int place) -> const char* {
      const auto found = names_.find(place);
      return found == names_.end() || found->second == "~" ? nullptr : found->second.c_str();
    });
  }

 private:
  std::map<int, std::string> names_;
};

const Keyboard kUs({"`1234567890-=", "qwertyuiop[]", "asdfghjkl;'\\", "zxcvbnm,./"});
const Keyboard kFrench({"²&é\"'(-è_çà)=", "azertyuiop^$", "qsdfghjklmù*", "wxcvbn,;:!"});
const Keyboard kGerman({"~1234567890ß~", "qwertzuiopü+", "asdfghjklöä#", "yxcvbnm,.-"});
const Keyboard kSpanish({"º1234567890'¡", "qwertyuiop`+", "asdfghjklñ~ç", "zxcvbnm,.-"});
const Keyboard kRussian({"ё1234567890-=", "йцукенгшщзхъ", "фывапролджэ\\", "ячсмитьбю."});
const Keyboard kGreek({"`1234567890-=", ";ςερτυθιοπ[]", "ασδφγηξκλ~'\\", "ζχψωβνμ,./"});
const Keyboard kDvorak({"`1234567890[]", "',.pyfgcrl/=", "aoeuidhtns-\\", ";qjkxbmwvz"});

TEST(KeyLabels, AUsKeyboardIsAsGlfwNamesIt) {
  for (const auto& row : kRows) {
    for (const int place : row) {
      EXPECT_EQ(kUs.labels().at(place), place);
      EXPECT_EQ(KeyLabels().at(place), place);
    }
  }
}

TEST(KeyLabels, LettersAreWhereTheyStand) {
  const KeyLabels french = kFrench.labels(), german = kGerman.labels(), dvorak = kDvorak.labels();
  EXPECT_EQ(french.at(GLFW_KEY_Q), GLFW_KEY_A) << "Ctrl+A does not quit";
  EXPECT_EQ(french.at(GLFW_KEY_A), GLFW_KEY_Q);
  EXPECT_EQ(french.at(GLFW_KEY_W), GLFW_KEY_Z);
  EXPECT_EQ(french.at(GLFW_KEY_SEMICOLON), GLFW_KEY_M);
  EXPECT_EQ(german.at(GLFW_KEY_Y), GLFW_KEY_Z);
  EXPECT_EQ(german.at(GLFW_KEY_Z), GLFW_KEY_Y);
  EXPECT_EQ(dvorak.at(GLFW_KEY_F), GLFW_KEY_U) << "U does not arm a device";
  EXPECT_EQ(dvorak.at(GLFW_KEY_Y), GLFW_KEY_F);
  EXPECT_EQ(dvorak.at(GLFW_KEY_MINUS), GLFW_KEY_LEFT_BRACKET);
}

// Each command has its key on each keyboard.
TEST(KeyLabels, EveryLetterDigitAndBracketIsSomewhere) {
  for (const Keyboard* keyboard :
       {&kUs, &kFrench, &kGerman, &kSpanish, &kRussian, &kGreek, &kDvorak}) {
    std::map<int, int> times;
    for (const auto& row : kRows) {
      for (const int place : row) ++times[keyboard->labels().at(place)];
    }
    for (const char key : std::string("ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789[]")) {
      EXPECT_EQ(times[key], 1) << key;
    }
  }
}

TEST(KeyLabels, WhereThereAreNoLatinLettersTheyAreAtTheirPlaces) {
  for (char key = 'A'; key <= 'Z'; ++key) {
    EXPECT_EQ(kRussian.labels().at(key), key);
    EXPECT_EQ(kGreek.labels().at(key), key) << "also Q, where a Greek keyboard has a sign";
  }
  EXPECT_EQ(kRussian.labels().at(GLFW_KEY_LEFT_BRACKET), GLFW_KEY_LEFT_BRACKET);
}

TEST(KeyLabels, AFrenchRowOfDigitsIsOne) {
  for (char key = '0'; key <= '9'; ++key) EXPECT_EQ(kFrench.labels().at(key), key);
}

TEST(KeyLabels, BracketsAreRightOfTheLettersWhereNoKeyHasThem) {
  EXPECT_EQ(kGerman.labels().at(GLFW_KEY_LEFT_BRACKET), GLFW_KEY_LEFT_BRACKET);
  EXPECT_EQ(kFrench.labels().at(GLFW_KEY_RIGHT_BRACKET), GLFW_KEY_RIGHT_BRACKET);
}

TEST(KeyLabels, HelpSaysWhatStandsThere) {
  EXPECT_EQ(kUs.labels().text("["), "[");
  EXPECT_EQ(kDvorak.labels().text("]"), "]");
  EXPECT_EQ(kGerman.labels().text("["), "ü");
  EXPECT_EQ(kGerman.labels().text("]"), "+");
  EXPECT_EQ(kFrench.labels().text("["), "^") << "a dead key, by GLFW's name";
  EXPECT_EQ(kSpanish.labels().text("["), "`");
  EXPECT_EQ(kFrench.labels().text("]"), "$");
  EXPECT_EQ(kRussian.labels().text("["), "х");
  EXPECT_EQ(kRussian.labels().text("Q"), "Q");
}

TEST(KeyLabels, OtherKeysStayAndNoTwoShareANumber) {
  const KeyLabels spanish = kSpanish.labels();
  for (const int key : {GLFW_KEY_SPACE, GLFW_KEY_ESCAPE, GLFW_KEY_F1, GLFW_KEY_KP_1,
                        GLFW_KEY_LEFT_CONTROL, GLFW_KEY_UNKNOWN, GLFW_KEY_LAST}) {
    EXPECT_EQ(spanish.at(key), key);
  }
  EXPECT_GT(kFrench.labels().at(GLFW_KEY_WORLD_1), GLFW_KEY_LAST);
}

}  // namespace
}  // namespace limpid
