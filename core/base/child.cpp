#include "core/base/child.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <link.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <deque>
#include <thread>

#include "core/base/descriptor.h"

namespace limpid {

namespace fs = std::filesystem;

fs::path own_binary() {
  std::error_code none;
  Dl_info about{};
  link_map* loaded = nullptr;
  const auto* here = reinterpret_cast<const void*>(&own_binary);
  const int found = dladdr1(here, &about, reinterpret_cast<void**>(&loaded), RTLD_DL_LINKMAP);
  // The program itself has no name in this list.
  if (found != 0 && loaded != nullptr && *loaded->l_name != '\0') {
    return fs::canonical(loaded->l_name, none);
  }
  return fs::read_symlink("/proc/self/exe", none);
}

fs::path own_program(const char* name) {
  std::error_code none;
  const fs::path own = own_binary();
  fs::path beside = fs::path(own).replace_filename(name);
  if (fs::exists(beside, none)) return beside;
  for (fs::path folder = own; folder.has_relative_path();) {
    folder = folder.parent_path();
    if (fs::path program = folder / "libexec/limpid" / name; fs::exists(program, none)) {
      return program;
    }
  }
  return beside;
}

Child::Child(std::vector<std::string> words, std::span<const Given> given) {
  constexpr int kAboveAll = 10;  // copies get numbers from here on
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  std::deque<Descriptor> copies;
  bool complete = true;
  int last = STDERR_FILENO;
  for (const Given& one : given) {
    const Descriptor& copy = copies.emplace_back(::fcntl(one.here, F_DUPFD_CLOEXEC, kAboveAll));
    complete = complete && *copy >= 0;
    posix_spawn_file_actions_adddup2(&actions, *copy, one.there);
    last = std::max(last, one.there);
  }
  posix_spawn_file_actions_addclosefrom_np(&actions, last + 1);
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  if (!complete ||
      ::posix_spawn(&id_, arguments[0], &actions, nullptr, arguments.data(), environ) != 0) {
    id_ = -1;
  }
  posix_spawn_file_actions_destroy(&actions);
}

Child::~Child() {
  if (id_ >= 0) end();
}

void Child::kill() noexcept {
  if (id_ > 0) ::kill(id_, SIGKILL);
}

int Child::end() {
  kill();
  return wait();
}

int Child::end_within(std::chrono::milliseconds longest) {
  constexpr std::chrono::milliseconds kGlance{2};
  const auto until = std::chrono::steady_clock::now() + longest;
  siginfo_t ended{};
  while (std::chrono::steady_clock::now() < until) {
    const int asked = ::waitid(P_PID, static_cast<id_t>(id_), &ended, WEXITED | WNOHANG | WNOWAIT);
    if (asked == 0 && ended.si_pid != 0) return wait();
    std::this_thread::sleep_for(kGlance);
  }
  return end();
}

int Child::wait() {
  int status = 0;
  while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
  }
  id_ = -1;
  return status;
}

std::string why_failed(int status, const std::string& program) {
  if (status == 0) return {};
  if (!WIFSIGNALED(status)) {
    return "cannot be read: the program " + program + " ended with status " +
           std::to_string(WEXITSTATUS(status));
  }
  const int signal = WTERMSIG(status);
  const char* const name = ::sigabbrev_np(signal);
  return "is damaged: the program that reads it crashed (SIG" +
         std::string(name != nullptr ? name : std::to_string(signal)) + ")";
}

}  // namespace limpid
