#include "render/model/model_program.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "render/model/companions.h"

extern char** environ;

namespace limpid {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<unsigned char>;

constexpr int kLines = 3;  // the descriptor on which the program says how it goes on
constexpr std::chrono::milliseconds kBetweenLooks{50};
constexpr unsigned kPatience = 60;  // [s], and what it takes at a twentieth of a processor

class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int operator*() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

 private:
  int number_;
};

// Beside this program.
fs::path program() {
  std::error_code none;
  return fs::read_symlink("/proc/self/exe", none).replace_filename("limpid-model");
}

void write_all(int file, std::span<const unsigned char> bytes, const std::string& name) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) refuse(name, "is too large for the memory");
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

Bytes read_all(int file, const std::string& name) {
  struct stat about {};
  if (::fstat(file, &about) != 0) refuse(name, "cannot be read");
  Bytes bytes(static_cast<std::size_t>(about.st_size));
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t read =
        ::pread(file, bytes.data() + at, bytes.size() - at, static_cast<off_t>(at));
    if (read < 0 && errno == EINTR) continue;
    if (read <= 0) refuse(name, "cannot be read");
    at += static_cast<std::size_t>(read);
  }
  return bytes;
}

// The program at work; it ends at the latest with this.
class Child {
 public:
  Child(std::array<const char*, 5> words, int in, int out, int lines) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    // A copy first: descriptor 3 may be one of the others here.
    const Descriptor kept(::fcntl(lines, F_DUPFD_CLOEXEC, 10));
    posix_spawn_file_actions_adddup2(&actions, in, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, *kept, kLines);
    posix_spawn_file_actions_addclosefrom_np(&actions, kLines + 1);
    if (*kept < 0 || ::posix_spawn(&id_, words[0], &actions, nullptr,
                                   const_cast<char**>(words.data()), environ) != 0)
      id_ = -1;
    posix_spawn_file_actions_destroy(&actions);
  }
  ~Child() {
    if (id_ < 0) return;
    ::kill(id_, SIGKILL);
    wait();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  bool started() const { return id_ > 0; }
  // 0: all is well.
  int wait() {
    int status = 0;
    while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    id_ = -1;
    return status;
  }

 private:
  pid_t id_ = -1;
};

// What becomes of a model.
struct Following {
  ConvertedModel made;
  std::string error;
  ReaderLimits limits;
};

void take_line(const std::string& line, Following& following, const LoadProgress& progress) {
  ConvertedModel& out = following.made;
  const auto at = line.find(' ');
  const std::string word = line.substr(0, at), rest = at == line.npos ? "" : line.substr(at + 1);
  if (word == "part" && progress.part) *progress.part = 0.1 + 0.5 * std::atof(rest.c_str());
  if (word == "warning" && out.warnings.size() < 20) out.warnings.push_back(one_line(rest));
  if (word == "outside") out.outside = true;
  if (word == "error") following.error = rest;
  if (word == "memory") following.error = too_much_memory(following.limits);
  if (word == "bytes") {
    following.limits = reader_limits(std::strtoull(rest.c_str(), nullptr, 10));
  }
}

// What the program says until it ends.
void follow(int lines, Following& following, const LoadProgress& progress) {
  using Clock = std::chrono::steady_clock;
  const auto begun = Clock::now();
  std::string text;
  std::array<char, 4096> piece{};
  for (;;) {
    check_wanted(progress);
    // One that waits takes no processor time.
    const std::chrono::seconds most{kPatience + 20 * following.limits.seconds};
    if (Clock::now() - begun > most) {
      following.error = "is not read: what reads it says nothing for too long";
      return;
    }
    pollfd waiting{lines, POLLIN, 0};
    if (::poll(&waiting, 1, static_cast<int>(kBetweenLooks.count())) == 0) continue;
    const ssize_t read = ::read(lines, piece.data(), piece.size());
    if (read < 0 && errno == EINTR) continue;
    if (read <= 0) return;
    text.append(piece.data(), static_cast<std::size_t>(read));
    for (auto end = text.find('\n'); end != text.npos; end = text.find('\n')) {
      take_line(text.substr(0, end), following, progress);
      text.erase(0, end + 1);
    }
    if (text.size() > piece.size()) text.clear();
  }
}

}  // namespace

ConvertedModel convert_model(std::span<const unsigned char> bytes, const std::string& kind,
                             const std::string& name, const fs::path& folder,
                             const LoadProgress& progress) {
  const Descriptor in(::memfd_create("model", MFD_CLOEXEC)),
      out(::memfd_create("glb", MFD_CLOEXEC));
  std::array<int, 2> ends{-1, -1};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0 || *in < 0 || *out < 0)
    refuse(name, "cannot be read, there are too many open files");
  const Descriptor lines(ends[0]);
  Descriptor other_end(ends[1]);
  write_all(*in, bytes, name);
  const bool alone = kind == "stl" || kind == "ply";  // refers to no other file
  const std::string at = program().string(), place = alone ? "" : folder.string();
  Child child({at.c_str(), kind.c_str(), place.c_str(), "3", nullptr}, *in, *out, *other_end);
  if (!child.started())
    refuse(name, "cannot be read: the program " + at + ", which reads it, cannot be started");
  other_end.close();
  Following following{{}, {}, reader_limits(bytes.size())};
  follow(*lines, following, progress);
  if (!following.error.empty()) refuse(name, following.error);
  if (const std::string why = why_ended(child.wait(), following.limits); !why.empty()) {
    refuse(name, why);
  }
  following.made.glb = read_all(*out, name);
  return std::move(following.made);
}

std::string why_ended(int status, const ReaderLimits& limits) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    if (signal == SIGXCPU) return too_long(limits);
    const char* const name = ::sigabbrev_np(signal);
    return "is damaged: the program that reads it crashed (SIG" +
           std::string(name != nullptr ? name : std::to_string(signal)) + ")";
  }
  if (status == 0) return {};
  return "cannot be read: the program limpid-model ended with status " +
         std::to_string(WEXITSTATUS(status));
}

}  // namespace limpid
