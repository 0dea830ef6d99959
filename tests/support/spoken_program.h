// A program that runs beside a test, and that prints a line once it is ready.
#pragma once

#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace limpid::test {

class SpokenProgram {
 public:
  // Starts the program that is the first of these words, and waits for its line.
  explicit SpokenProgram(std::vector<std::string> words) {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) return;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
    if (posix_spawnp(&pid_, arguments[0], &actions, nullptr, arguments.data(), environ) != 0) {
      pid_ = -1;
    }
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    std::array<char, 512> said{};
    for (ssize_t length = 0; (length = read(ends[0], said.data(), said.size())) > 0;) {
      const auto end = said.begin() + length, line = std::find(said.begin(), end, '\n');
      line_.append(said.begin(), line);
      ready_ = line != end;
      if (ready_) break;
    }
    close(ends[0]);
  }
  ~SpokenProgram() {
    if (pid_ < 0) return;
    kill(pid_, SIGTERM);
    waitpid(pid_, nullptr, 0);
  }
  SpokenProgram(const SpokenProgram&) = delete;
  SpokenProgram& operator=(const SpokenProgram&) = delete;
  bool ready() const { return ready_; }
  const std::string& line() const { return line_; }

 private:
  pid_t pid_ = -1;
  bool ready_ = false;
  std::string line_;
};

}  // namespace limpid::test
