// UTF-8 against encodings that the standard spells out: U+00E9, U+20AC, U+1F916.
#include "core/base/utf8.h"

#include <gtest/gtest.h>

#include <string>

namespace limpid {
namespace {

using namespace std::string_literals;

const std::string kUtf8 = "<a>\xC3\xA9\xE2\x82\xAC\xF0\x9F\xA4\x96</a>";
const std::string kLittle = "<\0a\0>\0\xE9\0\xAC\x20\x3E\xD8\x16\xDD<\0/\0a\0>\0"s;
const std::string kBig = "\0<\0a\0>\0\xE9\x20\xAC\xD8\x3E\xDD\x16\0<\0/\0a\0>"s;

TEST(Utf8Of, LeavesUtf8AsItIsButForItsMark) {
  EXPECT_EQ(utf8_of(kUtf8), kUtf8);
  EXPECT_EQ(utf8_of("\xEF\xBB\xBF" + kUtf8), kUtf8);
  EXPECT_EQ(utf8_of(""), "");
}

TEST(Utf8Of, ReadsUtf16OfBothByteOrdersWithAndWithoutAMark) {
  EXPECT_EQ(utf8_of(kLittle), kUtf8);
  EXPECT_EQ(utf8_of("\xFF\xFE" + kLittle), kUtf8);
  EXPECT_EQ(utf8_of(kBig), kUtf8);
  EXPECT_EQ(utf8_of("\xFE\xFF" + kBig), kUtf8);
}

TEST(Utf8Of, PutsTheReplacementCharacterForHalvesOfPairs) {
  EXPECT_EQ(utf8_of("\xFF\xFE\x3E\xD8<\0"s), "\xEF\xBF\xBD<");
  EXPECT_EQ(utf8_of("\xFF\xFE\x16\xDD"s), "\xEF\xBF\xBD");
  EXPECT_EQ(utf8_of("\xFF\xFE<\0a"s), "<");  // cut off within a character
}

TEST(Utf8Of, TakesForLatin1WhatIsNoUtf8) {
  EXPECT_EQ(utf8_of("caf\xE9"), "caf\xC3\xA9");
  for (const char* broken : {"\xC0\xAF", "\xE0\x80\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80",
                             "\xF0\"/>", "\x80", "\xE2\x82"}) {
    EXPECT_NE(utf8_of(broken), broken);
    EXPECT_EQ(utf8_of(utf8_of(broken)), utf8_of(broken)) << "is UTF-8 then";
  }
}

TEST(Utf8Of, MakesTheDeclarationSayWhatTheTextIs) {
  EXPECT_EQ(utf8_of("<?xml version='1.0' encoding='ISO-8859-1'?><a b='\xE9'/>"),
            "<?xml version='1.0' encoding='UTF-8'?><a b='\xC3\xA9'/>");
}

TEST(CountCharacters, CountsNoByteThatContinuesACharacter) {
  EXPECT_EQ(count_characters(""), 0u);
  EXPECT_EQ(count_characters("eta"), 3u);
  EXPECT_EQ(count_characters("\xCE\xB7 \xE2\x89\xA5 1"), 5u);  // of two, one, three bytes
  EXPECT_EQ(count_characters("\xF0\x9D\x84\x9E"), 1u);
}

}  // namespace
}  // namespace limpid
