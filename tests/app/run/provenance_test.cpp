// Statements of origin in figures and tables.
#include "app/run/provenance.h"

#include <gmock/gmock.h>

#include <cstdlib>

#include "app/base/version.h"
#include "devices/files/config_file.h"

namespace limpid {
namespace {

using testing::MatchesRegex;

TEST(Provenance, IsVersionSettingsSeedAndDay) {
  const std::string version = program_version();
  EXPECT_EQ(provenance("3f2a94d1", 7, "2026-11-26"),
            "limpid " + version + ", settings 3f2a94d1, seed 7, 2026-11-26");
  EXPECT_EQ(provenance("", std::nullopt, ""), "limpid " + version);
}

TEST(Provenance, HasTheSameDigestForTheSameSettingsAndAnotherForOthers) {
  Parameters p;
  EXPECT_THAT(settings_digest(p), MatchesRegex("[0-9a-f]+"));
  EXPECT_EQ(settings_digest(p).size(), 8u);
  EXPECT_EQ(settings_digest(p), settings_digest(Parameters{}));
  p.eta = 0.6;
  EXPECT_NE(settings_digest(p), settings_digest(Parameters{}));
}

TEST(Provenance, OfARecordingIsThatOfItsMaker) {
  SessionInfo info;
  info.app_version = "0.1.0+5";
  info.config = config_text(Parameters{});
  info.seed = 3;
  info.created = "2025-01-02T03:04:05Z";
  EXPECT_EQ(provenance_of(info),
            "limpid 0.1.0+5, settings " + settings_digest(Parameters{}) + ", seed 3, 2025-01-02");
}

TEST(Provenance, TakesTheDayFromSourceDateEpoch) {
  ASSERT_EQ(setenv("SOURCE_DATE_EPOCH", "86400", 1), 0);
  EXPECT_EQ(today(), "1970-01-02");
  ASSERT_EQ(unsetenv("SOURCE_DATE_EPOCH"), 0);
  EXPECT_THAT(today(), MatchesRegex("20..-..-.."));
}

TEST(Provenance, StandsInASvgBehindItsFirstTag) {
  EXPECT_EQ(with_metadata("<?xml?>\n<svg width=\"1\"><g/></svg>", "a & b"),
            "<?xml?>\n<svg width=\"1\">\n<metadata>a &amp; b</metadata><g/></svg>");
  EXPECT_EQ(with_metadata("no picture", "a"), "no picture");
}

}  // namespace
}  // namespace limpid
