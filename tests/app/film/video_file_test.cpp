#include "app/film/video_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "devices/files/text_file.h"
#include "tests/app/film/read_video.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

constexpr VideoFormat kSmall{.width = 96, .height = 64, .fps = 20};
constexpr Colour kRed{200, 30, 40}, kBlue{25, 60, 210}, kGrey{120, 120, 120};
const std::atomic<bool> kGoOn{false}, kStop{true};

// A picture of two halves.
std::vector<unsigned char> halves(const VideoFormat& format, const Colour& left,
                                  const Colour& right) {
  std::vector<unsigned char> rgba;
  for (int y = 0; y < format.height; ++y) {
    for (int x = 0; x < format.width; ++x) {
      for (const double c : 2 * x < format.width ? left : right) {
        rgba.push_back(static_cast<unsigned char>(c));
      }
      rgba.push_back(255);
    }
  }
  return rgba;
}

void expect_close(const Colour& seen, const Colour& shown, double within) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(seen[i], shown[i], within) << "channel " << i;
}

std::string refusal(const auto& work) {
  try {
    work();
  } catch (const FileError& e) {
    return e.what();
  }
  return "";
}

class Videos : public testing::Test {
 protected:
  Videos() {
    std::string name = (fs::temp_directory_path() / "limpid-video-XXXXXX").string();
    dir_ = ::mkdtemp(name.data());
  }
  ~Videos() override { fs::remove_all(dir_); }

  std::vector<std::string> left_there() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(dir_)) {
      names.push_back(entry.path().filename().string());
    }
    return names;
  }
  // Writes pictures of red beside grey, from picture `turn` on of blue beside grey.
  void write(const fs::path& out, int pictures, int turn, bool force = false) {
    VideoFile video(out, kSmall, force);
    for (int i = 0; i < pictures; ++i) video.add(halves(kSmall, i < turn ? kRed : kBlue, kGrey));
    ASSERT_TRUE(video.finish(kGoOn, [](double) {}));
  }
  void expect_as_written(const SeenVideo& seen, std::size_t pictures, double within) {
    EXPECT_EQ(seen.width, kSmall.width);
    EXPECT_EQ(seen.height, kSmall.height);
    ASSERT_EQ(seen.left.size(), pictures);
    EXPECT_NEAR(seen.duration, static_cast<double>(pictures) / kSmall.fps, 0.011);
    expect_close(seen.left.front(), kRed, within);
    expect_close(seen.left.back(), kBlue, within);
    for (const Colour& right : seen.right) expect_close(right, kGrey, within);
    for (std::size_t i = 0; i < pictures; ++i) {
      EXPECT_NEAR(seen.times[i], static_cast<double>(i) / kSmall.fps, 0.0051) << "picture " << i;
    }
  }

  fs::path dir_;
};

TEST_F(Videos, AnMp4HasEveryPictureAtItsTimeInItsColours) {
  write(dir_ / "a.mp4", 31, 10);
  expect_as_written(read_video(dir_ / "a.mp4"), 31, 5);
  EXPECT_THAT(left_there(), UnorderedElementsAre("a.mp4"));
}

TEST_F(Videos, AGifHasEveryPictureAtItsTimeInItsColours) {
  write(dir_ / "a.gif", 31, 10);
  expect_as_written(read_video(dir_ / "a.gif"), 31, 2);
  EXPECT_THAT(left_there(), UnorderedElementsAre("a.gif"));
}

TEST_F(Videos, AFolderHasEveryPictureToThePixel) {
  write(dir_ / "pictures", 3, 2);
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(dir_ / "pictures")) {
    names.push_back(entry.path().filename().string());
  }
  EXPECT_THAT(names,
              UnorderedElementsAre("frame-000001.png", "frame-000002.png", "frame-000003.png"));
  expect_close(read_video(dir_ / "pictures/frame-000001.png").left.at(0), kRed, 0);
  expect_close(read_video(dir_ / "pictures/frame-000003.png").left.at(0), kBlue, 0);
  EXPECT_THAT(left_there(), UnorderedElementsAre("pictures"));
}

TEST_F(Videos, OnePictureIsAVideoToo) {
  for (const char* name : {"a.mp4", "a.gif"}) {
    write(dir_ / name, 1, 1);
    const SeenVideo seen = read_video(dir_ / name);
    ASSERT_EQ(seen.left.size(), 1u) << name;
    expect_close(seen.left[0], kRed, 5);
  }
}

TEST_F(Videos, NamesWithLettersThatMeanSomethingElsewhereAreNamesOfFiles) {
  for (const char* name : {"a:b.mp4", "it's [50 %d], really; yes.gif"}) {
    write(dir_ / name, 2, 1);
    EXPECT_EQ(read_video(dir_ / name).left.size(), 2u) << name;
  }
}

TEST_F(Videos, WhatIsNotFinishedLeavesNothing) {
  for (const char* name : {"a.mp4", "a.gif", "pictures"}) {
    VideoFile video(dir_ / name, kSmall, false);
    for (int i = 0; i < 5; ++i) video.add(halves(kSmall, kRed, kGrey));
  }
  EXPECT_THAT(left_there(), IsEmpty());
}

TEST_F(Videos, WhatIsStoppedAtTheEndLeavesNothing) {
  for (const char* name : {"a.mp4", "a.gif", "pictures"}) {
    VideoFile video(dir_ / name, kSmall, false);
    video.add(halves(kSmall, kRed, kGrey));
    EXPECT_FALSE(video.finish(kStop, [](double) {})) << name;
  }
  EXPECT_THAT(left_there(), IsEmpty());
}

TEST_F(Videos, WhatIsThereStaysUnlessForced) {
  for (const char* name : {"a.mp4", "a.gif"}) {
    std::ofstream(dir_ / name) << "mine";
    EXPECT_THAT(refusal([&] { VideoFile(dir_ / name, kSmall, false); }), HasSubstr("--force"));
    { VideoFile unfinished(dir_ / name, kSmall, true); }
    std::ifstream file(dir_ / name);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "mine");
    write(dir_ / name, 2, 1, true);
    EXPECT_EQ(read_video(dir_ / name).left.size(), 2u);
  }
}

TEST_F(Videos, AFolderKeepsWhatIsNoPictureOfAVideo) {
  const fs::path folder = dir_ / "pictures.d/";
  fs::create_directory(folder);
  write(folder, 4, 2);  // an empty folder, which nobody needs
  std::ofstream(folder / "notes.txt") << "mine";
  EXPECT_THAT(refusal([&] { VideoFile(folder, kSmall, false); }), HasSubstr("not empty"));
  write(folder, 2, 1, true);
  EXPECT_TRUE(fs::exists(folder / "notes.txt"));
  EXPECT_TRUE(fs::exists(folder / "frame-000002.png"));
  EXPECT_FALSE(fs::exists(folder / "frame-000003.png")) << "of the earlier video";
  EXPECT_THAT(left_there(), UnorderedElementsAre("pictures.d"));
}

TEST_F(Videos, NamesAndFormatsThatAreNoneAreRefusedAndNothingIsWritten) {
  const auto said = [&](const char* name, VideoFormat format) {
    return refusal([&] { VideoFile(dir_ / name, format, false); });
  };
  EXPECT_THAT(said("a.avi", kSmall), HasSubstr("OUT.mp4, OUT.gif"));
  EXPECT_THAT(said("no/a.mp4", kSmall), HasSubstr("no such directory"));
  EXPECT_THAT(said("no/pictures", kSmall), HasSubstr("no such directory"));
  EXPECT_THAT(said("a.mp4", {.width = 97, .height = 64, .fps = 20}), HasSubstr("97 x 64"));
  EXPECT_THAT(said("a.mp4", {.width = 96, .height = 62, .fps = 20}), HasSubstr("96 x 62"));
  EXPECT_THAT(said("a.mp4", {.width = 4098, .height = 64, .fps = 20}), HasSubstr("4096"));
  EXPECT_THAT(said("a.mp4", {.width = 96, .height = 64, .fps = 0}), HasSubstr("1 to 240"));
  EXPECT_THAT(said("a.gif", {.width = 96, .height = 64, .fps = 51}), HasSubstr("1 to 50"));
  EXPECT_THAT(left_there(), IsEmpty());
}

TEST_F(Videos, APictureOfAnotherSizeIsAMistake) {
  VideoFile video(dir_ / "a.mp4", kSmall, false);
  EXPECT_THROW(video.add(std::vector<unsigned char>(4 * 96 * 62)), std::invalid_argument);
}

// Players are told where a video comes from, how fast it goes and which colours it means.
TEST_F(Videos, AnMp4SaysItsOriginRateAndColours) {
  VideoFormat format = kSmall;
  format.comment = "made by a test";
  VideoFile video(dir_ / "a.mp4", format, false);
  for (int i = 0; i < 50; ++i) video.add(halves(format, i % 2 == 0 ? kRed : kBlue, kGrey));
  ASSERT_TRUE(video.finish(kGoOn, [](double) { FAIL() << "that is for a GIF"; }));
  AVFormatContext* opened = nullptr;
  checked(avformat_open_input(&opened, av_address(dir_ / "a.mp4").c_str(), nullptr, nullptr));
  const auto close = [](AVFormatContext* f) { avformat_close_input(&f); };
  const std::unique_ptr<AVFormatContext, decltype(close)> input(opened);
  checked(avformat_find_stream_info(input.get(), nullptr));
  const AVDictionaryEntry* comment = av_dict_get(input->metadata, "comment", nullptr, 0);
  ASSERT_NE(comment, nullptr);
  EXPECT_STREQ(comment->value, "made by a test");
  ASSERT_EQ(input->nb_streams, 1u);
  const AVStream& stream = *input->streams[0];
  EXPECT_NEAR(av_q2d(stream.avg_frame_rate), 20, 1e-6);
  EXPECT_EQ(stream.codecpar->color_space, AVCOL_SPC_BT709);
  EXPECT_EQ(stream.codecpar->color_primaries, AVCOL_PRI_BT709);
  EXPECT_EQ(stream.codecpar->color_trc, AVCOL_TRC_BT709);
  EXPECT_EQ(stream.codecpar->color_range, AVCOL_RANGE_MPEG);
  EXPECT_EQ(stream.codecpar->format, AV_PIX_FMT_YUV420P);
}

TEST_F(Videos, AGifTellsHowFarItsColoursAre) {
  std::vector<double> parts;
  {
    VideoFile video(dir_ / "a.gif", kSmall, false);
    for (int i = 0; i < 4; ++i) video.add(halves(kSmall, kRed, kGrey));
    ASSERT_TRUE(video.finish(kGoOn, [&](double part) { parts.push_back(part); }));
  }
  ASSERT_EQ(parts.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(parts[i], 0.25 * static_cast<double>(i + 1), 1e-12);
  }
  // Stopped in between, nothing of it is left.
  std::atomic<bool> stop{false};
  {
    VideoFile stopped(dir_ / "b.gif", kSmall, false);
    for (int i = 0; i < 4; ++i) stopped.add(halves(kSmall, kRed, kGrey));
    EXPECT_FALSE(stopped.finish(stop, [&](double) { stop = true; }));
  }
  EXPECT_THAT(left_there(), UnorderedElementsAre("a.gif"));
}

TEST(KindsOfVideos, AreToldByTheirNames) {
  EXPECT_EQ(video_kind("a.mp4"), VideoKind::mp4);
  EXPECT_EQ(video_kind("b/A.MP4"), VideoKind::mp4);
  EXPECT_EQ(video_kind("a.Gif"), VideoKind::gif);
  EXPECT_EQ(video_kind("pictures"), VideoKind::pictures);
  EXPECT_EQ(video_kind("/"), VideoKind::pictures);
  EXPECT_THROW(video_kind("a.mov"), FileError);
  EXPECT_EQ(most_fps(VideoKind::gif), 50);
  EXPECT_EQ(most_fps(VideoKind::mp4), 240);
  EXPECT_EQ(most_fps(VideoKind::pictures), 240);
  EXPECT_EQ(usual_fps(VideoKind::gif), 15);
  EXPECT_EQ(usual_fps(VideoKind::mp4), 30);
}

}  // namespace
}  // namespace limpid
