// The name of this build, and what is said where another one recorded.
#include "app/run/program_build.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "app/base/version.h"

namespace limpid {
namespace {

const std::string kMayDiffer = "the numbers of this re-run can differ in their last digits";

TEST(ProgramBuild, NamesVersionCompilerProgramAndProcessor) {
  EXPECT_THAT(program_build(),
              testing::MatchesRegex("limpid [^,]+, (GCC|clang) .+, build [0-9a-f]{16}; [^;]+"));
  EXPECT_EQ(program_build().find(std::string("limpid ") + program_version() + ", "), 0u);
}

TEST(ProgramBuild, HasNothingToSayOfItsOwnRecordings) {
  EXPECT_EQ(other_build(program_build(), "a.h5"), "");
}

TEST(ProgramBuild, SaysWhatIsOtherAboutARecording) {
  const std::string& own = program_build();
  EXPECT_EQ(other_build("", "a.h5"), "a.h5 does not say which build recorded it; " + kMayDiffer);
  const std::string elsewhere = own.substr(0, own.find("; ")) + "; abacus";
  EXPECT_EQ(other_build(elsewhere, "b.h5"), "b.h5 was recorded on another kind of processor (" +
                                                elsewhere + ") than this one (" + own + "); " +
                                                kMayDiffer);
  EXPECT_EQ(
      other_build("limpid 0.1", "c.h5"),
      "c.h5 was recorded by another build (limpid 0.1) than this one (" + own + "); " + kMayDiffer);
  const std::string longest(200, 'x');
  EXPECT_EQ(other_build(longest + "xyz", "d.h5"), "d.h5 was recorded by another build (" + longest +
                                                      ") than this one (" + own + "); " +
                                                      kMayDiffer)
      << "a file's text may be of any length";
}

}  // namespace
}  // namespace limpid
