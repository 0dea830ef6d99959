#include <gmock/gmock.h>

#include <fstream>

#include "app/desktop/playback/film_process.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

using testing::ElementsAre;

TEST(VideoOrders, BecomeTheCommandLinesWords) {
  VideoRequest order;
  EXPECT_THAT(words_of(order), ElementsAre("--size", "1280x720", "--speed", "1", "--from", "0"));
  order = {.width = 640,
           .height = 360,
           .fps = 25,
           .speed = 0.5,
           .plots = false,
           .overlaid = true,
           .lens = true,
           .rerun = {"coupling.kind=standard", "coupling.k_vc=8"},
           .from = 1.25,
           .to = 3.5};
  EXPECT_THAT(words_of(order),
              ElementsAre("--size", "640x360", "--speed", "0.5", "--from", "1.25", "--fps", "25",
                          "--to", "3.5", "--no-plots", "--overlaid", "--lens", "--rerun",
                          "coupling.kind=standard", "--rerun", "coupling.k_vc=8"));
}

TEST(VideoOrders, NeverGetANameThatIsTaken) {
  const test::TempDir temp;
  const std::filesystem::path folder = temp / "sessions";
  std::filesystem::create_directory(folder);
  const auto session = folder / "a.h5";
  EXPECT_EQ(video_of(session, VideoRequest::Kind::gif, "/other"), folder / "a.gif");
  std::ofstream(folder / "a.mp4") << "x";
  EXPECT_EQ(video_of(session, VideoRequest::Kind::mp4, "/other"), folder / "a-2.mp4");
  EXPECT_EQ(video_of(session, VideoRequest::Kind::png, "/other").extension(), "");
  EXPECT_EQ(video_of("/nowhere/a.h5", VideoRequest::Kind::mp4, folder), folder / "a-2.mp4")
      << "where nothing can be written";
}

}  // namespace
}  // namespace limpid
