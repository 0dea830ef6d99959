// The program run within a test: its words, exit status and output.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "app/program.h"
#include "tests/support/temp_dir.h"

namespace limpid::test {

struct Said {
  int status = -1;
  std::string out, err;
};

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

// A program with a home of its own, at a place without files.
class Program : public testing::Test {
 protected:
  Program() {
    for (const char* name : {"HOME", "XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_CACHE_HOME",
                             "XDG_STATE_HOME", "XDG_RUNTIME_DIR"}) {
      setenv(name, (temp_ / "home").c_str(), 1);
    }
    std::filesystem::create_directories(temp_ / "home");
    before_ = std::filesystem::current_path();
    std::filesystem::current_path(temp_ / ".");
  }
  ~Program() override { std::filesystem::current_path(before_); }

  // A video that was asked for.
  struct Video {
    std::string of;
    VideoOptions options;
    double text_scale = -1;
  };
  static Video& video() {
    static Video last;
    return last;
  }

  static Said run(std::vector<std::string> words) {
    words.insert(words.begin(), "limpid");
    std::vector<char*> all;
    for (std::string& word : words) all.push_back(word.data());
    all.push_back(nullptr);
    const VideoMakers makers{
        [](const std::string& session, const VideoOptions& options, double scale, char**) {
          video() = {session, options, scale};
          return 0;
        },
        [](const std::string& script, const VideoOptions& options, char**) {
          video() = {script, options, -1};
          return 0;
        }};
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    Said said;
    said.status = run_program(static_cast<int>(words.size()), all.data(), makers);
    std::fflush(stdout);
    said.out = testing::internal::GetCapturedStdout();
    said.err = testing::internal::GetCapturedStderr();
    return said;
  }
  // Runs a command that is to be refused; returns the only line that it says.
  static std::string refused(const std::vector<std::string>& words) {
    const Said said = run(words);
    EXPECT_EQ(said.status, 2) << testing::PrintToString(words) << said.out << said.err;
    EXPECT_EQ(said.out, "");
    EXPECT_EQ(lines_of(said.err).size(), 1u) << said.err;
    EXPECT_THAT(said.err, testing::StartsWith("limpid: "));
    return said.err;
  }
  // Runs a command that is to succeed and warn of nothing.
  static std::string done(const std::vector<std::string>& words) {
    const Said said = run(words);
    EXPECT_EQ(said.status, 0) << testing::PrintToString(words) << said.out;
    EXPECT_EQ(said.err, "");
    return said.out;
  }
  void write(const char* name, const std::string& text) const {
    std::ofstream(temp_ / name) << text;
  }

  const TempDir temp_;

 private:
  std::filesystem::path before_;
};

}  // namespace limpid::test
