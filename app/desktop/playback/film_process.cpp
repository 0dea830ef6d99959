#include "app/desktop/playback/film_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

namespace limpid {

namespace fs = std::filesystem;

std::vector<std::string> words_of(const VideoRequest& request) {
  std::vector<std::string> words{"--size",  fmt::format("{}x{}", request.width, request.height),
                                 "--speed", fmt::format("{}", request.speed),
                                 "--from",  fmt::format("{}", request.from)};
  const auto add = [&](const char* option, const auto& value) {
    if (value) words.insert(words.end(), {option, fmt::format("{}", *value)});
  };
  add("--fps", request.fps);
  add("--to", request.to);
  if (!request.plots) words.emplace_back("--no-plots");
  if (request.overlaid) words.emplace_back("--overlaid");
  if (request.lens) words.emplace_back("--lens");
  for (const std::string& change : request.rerun) {
    words.insert(words.end(), {"--rerun", change});
  }
  return words;
}

fs::path video_of(const fs::path& session, VideoRequest::Kind kind, const fs::path& otherwise) {
  const bool writable = ::access(fs::absolute(session).parent_path().c_str(), W_OK) == 0;
  const fs::path folder = writable ? session.parent_path() : otherwise;
  const char* end = kind == VideoRequest::Kind::mp4   ? ".mp4"
                    : kind == VideoRequest::Kind::gif ? ".gif"
                                                      : "-pictures";
  const std::string stem = session.stem().string();
  fs::path out = folder / (stem + end);
  for (int i = 2; fs::exists(out); ++i) out = folder / fmt::format("{}-{}{}", stem, i, end);
  return out;
}

namespace {

constexpr int kNice = 10;
constexpr int kWait = 100;  // between two looks at `stop` [ms]

[[noreturn]] void fail(int code) {
  throw std::runtime_error(std::string("the video cannot be made: ") + std::strerror(code));
}

// Process that runs this program once more; its output can be read here.
class Process {
 public:
  explicit Process(std::vector<std::string> words) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail(errno);
    out_ = ends[0];
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&files, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files, ends[1], STDERR_FILENO);
    const int code =
        ::posix_spawn(&id_, "/proc/self/exe", &files, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    ::close(ends[1]);
    if (code != 0) {
      ::close(out_);
      fail(code);
    }
    ::setpriority(PRIO_PROCESS, static_cast<id_t>(id_), kNice);
  }
  ~Process() { ::close(out_); }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  // SIGINT may be ignored: whoever starts Limpid by a script and `&` has it so, and children
  // inherit it.
  void interrupt() const { ::kill(id_, SIGTERM); }
  // Adds new output, if any comes soon; returns false at its end.
  bool read(std::string& text) const {
    pollfd ready{out_, POLLIN, 0};
    if (::poll(&ready, 1, kWait) <= 0) return true;
    std::array<char, 4096> bytes{};
    const ssize_t count = ::read(out_, bytes.data(), bytes.size());
    if (count > 0) text.append(bytes.data(), static_cast<std::size_t>(count));
    return count > 0 || (count < 0 && errno == EINTR);
  }
  bool succeeded() const {
    int status = 0;
    while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }

 private:
  pid_t id_ = 0;
  int out_ = -1;
};

// Removes whole lines from `text`: numbers become `part`, the last other line becomes `said`.
void take_lines(std::string& text, std::atomic<double>& part, std::string& said) {
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n')) {
    double number = 0;
    const char* last = text.data() + end;
    if (std::from_chars(text.data(), last, number).ptr == last) {
      part = number;
    } else {
      said = text.substr(0, end);
    }
    text.erase(0, end + 1);
  }
}

}  // namespace

bool film_beside(const std::filesystem::path& session, const std::filesystem::path& out,
                 const std::vector<std::string>& options, const std::atomic<bool>& stop,
                 std::atomic<double>& part) {
  std::vector<std::string> words{"limpid",  "play",       session.string(),
                                 "--video", out.string(), "--print-progress"};
  words.insert(words.end(), options.begin(), options.end());
  const Process process(std::move(words));
  std::string text, said;
  bool asked = false;
  while (process.read(text)) {
    take_lines(text, part, said);
    if (stop && !asked) {
      asked = true;
      process.interrupt();
    }
  }
  if (process.succeeded()) return true;
  if (asked) return false;
  throw std::runtime_error(said.empty() ? "the process that makes the video ended too early"
                                        : said);
}

}  // namespace limpid
