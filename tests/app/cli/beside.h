// A process of its own beside the test: a command that goes on, or who stops one.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <functional>
#include <utility>

namespace limpid::test {

class Beside {
 public:
  // Starts it; its exit status is what `work` returns.
  explicit Beside(const std::function<int()>& work) : process_(fork()) {
    if (process_ == 0) _exit(work());
  }
  ~Beside() { end(SIGKILL); }
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;

  // Sends a signal, unless it is 0; waits for the end. Returns the exit status, or -1.
  int end(int signal = 0) {
    if (process_ <= 0) return -1;
    if (signal != 0) kill(process_, signal);
    int status = 0;
    waitpid(std::exchange(process_, -1), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t process_;
};

}  // namespace limpid::test
