// The stand-in of the Haply Inverse Service (inverse_service.py) as a child process of the test.
#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "devices/hid/web_socket.h"

namespace limpid::test {

class InverseService {
 public:
  // Serves on this port; "0" takes a free one.
  explicit InverseService(const std::string& port = "0") {
    int in[2] = {-1, -1}, out[2] = {-1, -1};
    EXPECT_EQ(pipe(in), 0);
    EXPECT_EQ(pipe(out), 0);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, in[0], 0);
    posix_spawn_file_actions_adddup2(&files, out[1], 1);
    for (const int end : {in[0], in[1], out[0], out[1]}) {
      posix_spawn_file_actions_addclose(&files, end);
    }
    const std::string program = LIMPID_SOURCE_DIR "/tests/support/inverse_service.py";
    const char* words[] = {"python3", program.c_str(), port.c_str(), nullptr};
    EXPECT_EQ(posix_spawn(&process_, "/usr/bin/python3", &files, nullptr,
                          const_cast<char* const*>(words), environ),
              0);
    posix_spawn_file_actions_destroy(&files);
    close(in[0]);
    close(out[1]);
    orders_ = in[1];
    reader_ = std::thread([this, end = out[0]] { listen(end); });
    const std::string line = wait_for([](const auto& said) { return said.starts_with("port "); });
    address_ = {"127.0.0.1", line.substr(5)};
  }
  ~InverseService() {
    end();
    reader_.join();
    close(orders_);
  }
  InverseService(const InverseService&) = delete;
  InverseService& operator=(const InverseService&) = delete;

  const ServiceAddress& address() const { return address_; }
  void tell(const std::string& order) const {
    const std::string line = order + "\n";
    EXPECT_EQ(write(orders_, line.data(), line.size()), static_cast<ssize_t>(line.size()));
  }
  // Kills the process without a message.
  void end() {
    if (process_ <= 0) return;
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
    process_ = 0;
  }

  // Waits for the first line that is `wanted`, said already or to come; forgets it and all earlier
  // ones. Fails after a minute.
  std::string wait_for(const std::function<bool(const std::string&)>& wanted) {
    std::unique_lock lock(mutex_);
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    for (;;) {
      const auto found = std::ranges::find_if(said_, wanted);
      if (found != said_.end()) {
        std::string line = *found;
        said_.erase(said_.begin(), found + 1);
        return line;
      }
      if (changed_.wait_until(lock, end) == std::cv_status::timeout) {
        ADD_FAILURE() << "the service has not said it";
        return {};
      }
    }
  }
  // Whether a line not yet forgotten is `wanted`; forgets none.
  bool heard(const std::function<bool(const std::string&)>& wanted) {
    const std::lock_guard lock(mutex_);
    return std::ranges::any_of(said_, wanted);
  }
  std::string wait_for(const std::string& line) {
    return wait_for([&](const std::string& each) { return each == line; });
  }

 private:
  void listen(int end) {
    FILE* lines = fdopen(end, "r");
    char line[4096];
    while (std::fgets(line, sizeof(line), lines) != nullptr) {
      const std::lock_guard lock(mutex_);
      said_.emplace_back(line);
      if (said_.back().ends_with('\n')) said_.back().pop_back();
      changed_.notify_all();
    }
    std::fclose(lines);
  }

  pid_t process_ = 0;
  int orders_ = -1;
  ServiceAddress address_;
  std::thread reader_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> said_;
};

}  // namespace limpid::test
