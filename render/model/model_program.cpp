#include "render/model/model_program.h"

#include <fcntl.h>
#include <poll.h>
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

#include "core/base/child.h"
#include "core/base/descriptor.h"
#include "render/model/companions.h"

namespace limpid {

namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<unsigned char>;

constexpr const char* kProgram = "limpid-model";
constexpr int kLines = 3;  // descriptor of the program's lines about its progress
constexpr std::chrono::milliseconds kBetweenLooks{50};
constexpr unsigned kPatience = 60;  // [s], and what it takes at a twentieth of a processor

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

// State of a conversion, from the lines of the program.
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

// Reads the program's lines until it ends.
void follow(int lines, Following& following, const LoadProgress& progress) {
  using Clock = std::chrono::steady_clock;
  const auto begun = Clock::now();
  std::string text;
  std::array<char, 4096> piece{};
  for (;;) {
    check_wanted(progress);
    // The limit counts time on the wall: a program that waits takes no processor time.
    const std::chrono::seconds most{kPatience + 20 * following.limits.seconds};
    if (Clock::now() - begun > most) {
      following.error = "cannot be read: the program that reads the model did not answer in time";
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

ConvertedModel convert_model(std::span<const unsigned char> bytes, const ModelKind& kind,
                             const std::string& name, const fs::path& folder,
                             const LoadProgress& progress) {
  const Descriptor in(::memfd_create("model", MFD_CLOEXEC)),
      out(::memfd_create("glb", MFD_CLOEXEC));
  std::array<int, 2> ends{-1, -1};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0 || *in < 0 || *out < 0)
    refuse(name, "cannot be read: too many files are open");
  const Descriptor lines(ends[0]);
  Descriptor other_end(ends[1]);
  if (!write_all(*in, bytes)) refuse(name, "is too large for this computer's memory");
  const std::string at = own_program(kProgram).string();
  const std::string place = kind.files == ModelFiles::one ? "" : folder.string();
  const std::array given{Given{*in, STDIN_FILENO}, Given{*out, STDOUT_FILENO},
                         Given{*other_end, kLines}};
  Child child({at, std::string(kind.suffix.substr(1)), place, std::to_string(kLines)}, given);
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
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) return too_long(limits);
  return why_failed(status, kProgram);
}

}  // namespace limpid
