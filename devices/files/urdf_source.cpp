#include "devices/files/urdf_source.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

#include "core/base/utf8.h"
#include "devices/files/text_file.h"

namespace limpid {

namespace {

constexpr int kDeepestXml = 100;
constexpr int kMostAttributes = 1000;  // of an element

// Checks what TinyXML reads, element by element, and stops where it stops.
class Guard {
 public:
  Guard(std::string_view text, const std::string& where) : text_(text), where_(where) {}

  void look_through() {
    for (at_ = text_.find('<'); at_ < text_.size(); at_ = text_.find('<', at_)) {
      const auto next = static_cast<unsigned char>(at_ + 1 < text_.size() ? text_[at_ + 1] : '\0');
      if (stands_here("<!--")) {
        skip_behind("-->", 4);
      } else if (stands_here("<![CDATA[")) {
        skip_behind("]]>", 9);
      } else if (next == '?') {
        skip_instruction();
      } else if (next == '/') {
        depth_ = std::max(depth_ - 1, 0);
        skip_behind(">", 2);
      } else if (std::isalpha(next) || next == '_' || next >= 127) {
        read_element();
      } else {
        skip_behind(">", 1);
      }
    }
  }

 private:
  bool stands_here(std::string_view word) const { return text_.substr(at_, word.size()) == word; }

  void skip_behind(std::string_view end, std::size_t begun) {
    const std::size_t found = text_.find(end, at_ + begun);
    at_ = found == std::string_view::npos ? text_.size() : found + end.size();
  }

  // Refuses '<' and '>' inside of <?xml ...?>: TinyXML takes a quoted '>' for a part of some
  // attributes there and not of others.
  void skip_instruction() {
    const std::size_t end = text_.find("?>", at_);
    if (end != std::string_view::npos &&
        text_.substr(at_ + 1, end - at_ - 1).find_first_of("<>") != std::string_view::npos) {
      refuse("'<' or '>' between '<?' and '?>'");
    }
    skip_behind(">", 1);
  }

  // Reads an element; attribute values stand in quotes and may hold anything else.
  void read_element() {
    int attributes = 0;
    for (++at_; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '"' || c == '\'') {
        at_ = std::min(text_.find(c, at_ + 1), text_.size());
      } else if (c == '=') {
        if (++attributes > kMostAttributes) refuse("too many attributes in an element");
      } else if (c == '>') {
        if (text_[at_ - 1] != '/' && ++depth_ > kDeepestXml) refuse("XML nested too deep");
        return;
      }
    }
  }

  [[noreturn]] void refuse(const char* why) const {
    const auto lines =
        std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at_), '\n');
    throw FileError(fmt::format("{}:{}: {}", where_, lines + 1, why));
  }

  std::string_view text_;
  const std::string& where_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

namespace fs = std::filesystem;

constexpr std::size_t kLongestUrdf = 16 << 20;  // [bytes]
constexpr int kXacroPatience = 60'000;          // longest silence of xacro [ms]

// Returns whether a text has macros: not only their namespace's declaration, or comments, which
// expanded files keep.
bool has_macros(const std::string& text) {
  std::size_t at = 0;
  for (;;) {
    const std::size_t macro = text.find("<xacro:", at);
    if (macro == std::string::npos) return false;
    const std::size_t comment = text.find("<!--", at);
    if (comment > macro) return true;
    at = text.find("-->", comment);
    if (at == std::string::npos) return false;
  }
}

fs::path find_program(const std::string& name) {
  for (const fs::path& folder : search_path("PATH")) {
    const fs::path file = folder / name;
    if (file.is_absolute() && access(file.c_str(), X_OK) == 0) return file;
  }
  return {};
}

struct Pipe {
  std::array<int, 2> ends{-1, -1};
  Pipe() {
    if (pipe2(ends.data(), O_CLOEXEC) != 0)
      throw FileError("xacro: no connection (pipe) to the program xacro can be made");
  }
  ~Pipe() {
    for (const int end : ends) {
      if (end >= 0) close(end);
    }
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void close_in() { close(std::exchange(ends[1], -1)); }
};

// Reads some of both streams. False at the end: all is read, too much came, or nothing for too
// long.
bool read_some(std::array<pollfd, 2>& from, std::array<std::string, 2>& into) {
  if (from[0].fd < 0 && from[1].fd < 0) return false;
  if (poll(from.data(), from.size(), kXacroPatience) <= 0) return false;
  std::array<char, 65536> buffer{};
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (from[i].fd < 0 || from[i].revents == 0) continue;
    const ssize_t got = read(from[i].fd, buffer.data(), buffer.size());
    if (got <= 0) {
      from[i].fd = -1;
    } else {
      into[i].append(buffer.data(), static_cast<std::size_t>(got));
      if (into[i].size() > kLongestUrdf) return false;
    }
  }
  return true;
}

std::string last_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  const std::size_t before = text.rfind('\n');
  return before == std::string::npos ? text : text.substr(before + 1);
}

std::string expanded(const fs::path& program, const fs::path& file) {
  Pipe out, err;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, out.ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, err.ends[1], STDERR_FILENO);
  std::string name = program.string(), argument = fs::absolute(file).string();
  const std::array<char*, 3> arguments{name.data(), argument.data(), nullptr};
  pid_t child = 0;
  const int failed =
      posix_spawn(&child, name.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) throw FileError(fmt::format("{}: cannot be started", name));
  out.close_in();
  err.close_in();
  std::array<pollfd, 2> from{pollfd{out.ends[0], POLLIN, 0}, pollfd{err.ends[0], POLLIN, 0}};
  std::array<std::string, 2> said;
  while (read_some(from, said)) {
  }
  const bool whole = from[0].fd < 0 && from[1].fd < 0;
  if (!whole) kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  if (whole && WIFEXITED(status) && WEXITSTATUS(status) == 0) return said[0];
  throw FileError(fmt::format("{}: xacro: {}", file.string(),
                              whole ? last_line(said[1]) : "the program did not end"));
}

}  // namespace

void check_xml(const std::string& text, const std::string& where) {
  if (text.size() > kLongestXml) {
    throw FileError(
        fmt::format("{}: has {} bytes; allowed: at most {}", where, text.size(), kLongestXml));
  }
  Guard(text, where).look_through();
}

std::string urdf_text(const fs::path& file, Xacro xacro) {
  std::string text = utf8_of(read_text(file, kLongestUrdf));
  if (file.extension() != ".xacro" && !has_macros(text)) return text;
  if (xacro == Xacro::refuse) throw XacroToExpand(file);
  const fs::path program = find_program("xacro");
  if (!program.empty()) return expanded(program, file);
  throw FileError(
      fmt::format("{}: is written in xacro, and the program xacro, which expands such files, is "
                  "not installed; install xacro (it comes with ROS, or `pip install xacro`), or "
                  "expand the file on another computer: xacro {} > arm.urdf",
                  file.string(), file.filename().string()));
}

}  // namespace limpid
