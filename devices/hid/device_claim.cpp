#include "devices/hid/device_claim.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <thread>
#include <utility>

#include "devices/hid/hid_transport.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

// Tries before a claim fails. A lock that somebody only looks at is free again within microseconds;
// the guardian of a killed program takes some milliseconds for its stop.
constexpr int kClaimTries = 5;
constexpr std::chrono::milliseconds kPause{10};
constexpr std::size_t kMostText = 100;  // of a command line that is shown
constexpr std::size_t kMostName = 240;  // of a file's name
constexpr mode_t kForEverybody = 0666;

std::string file_name(const std::string& key) {
  std::string name = "limpid-";
  for (const char c : key) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                       c == '-' || c == '_' || c == '.' || c == ':';
    name += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  if (name.size() > kMostName) {
    throw HidError(fmt::format(
        "the device cannot be reserved, because the name of its connection is too long: {}", key));
  }
  return name + ".lock";
}

// Opens or makes the file of a claim. Anybody may have made it: it is used only if it is a plain
// file under this one name. In such folders the kernel lets nobody open another user's file with
// O_CREAT.
int open_file(const fs::path& path) {
  constexpr int kHow = O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK | O_NOCTTY;
  int file = -1;
  for (int i = 0; i < kClaimTries && file < 0; ++i) {
    file = open(path.c_str(), O_RDWR | kHow);
    if (file < 0 && errno == EACCES) file = open(path.c_str(), O_RDONLY | kHow);
    if (file >= 0 || errno != ENOENT) break;
    file = open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | kHow, kForEverybody);
    if (file >= 0) fchmod(file, kForEverybody);  // whatever the umask is
    if (file < 0 && errno != EEXIST) break;
  }
  struct stat is {};
  if (file >= 0 && fstat(file, &is) == 0 && S_ISREG(is.st_mode) && is.st_nlink <= 1) return file;
  const std::string why =
      file >= 0 || errno == ELOOP ? "this must be a plain file, but is not" : std::strerror(errno);
  if (file >= 0) close(file);
  throw HidError(fmt::format("{}: {}, so nobody can tell whether another program uses the device",
                             path.string(), why));
}

// Takes the lock of an open file. Returns false if another program has it. Errors: HidError.
bool take_lock(int file, const fs::path& path) {
  if (flock(file, LOCK_EX | LOCK_NB) == 0) return true;
  if (errno == EWOULDBLOCK || errno == EINTR) return false;
  throw HidError(
      fmt::format("{}: cannot be locked: {}, so nobody can tell whether another program uses the "
                  "device",
                  path.string(), std::strerror(errno)));
}

// Returns whether `path` still is this file: a lock on a removed file would hold nobody back.
bool still_there(int file, const fs::path& path) {
  struct stat is {
  }, named{};
  return fstat(file, &is) == 0 && lstat(path.c_str(), &named) == 0 && is.st_dev == named.st_dev &&
         is.st_ino == named.st_ino;
}

std::string printable(std::string text) {
  if (text.size() > kMostText) text = text.substr(0, kMostText) + "...";
  for (char& c : text) {
    if (c < 0x20 || c > 0x7E) c = '?';
  }
  return text;
}

std::string own_command() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::string words{std::istreambuf_iterator<char>(file), {}};
  while (!words.empty() && words.back() == '\0') words.pop_back();
  const std::size_t slash = words.substr(0, words.find('\0')).rfind('/');
  if (slash != std::string::npos) words.erase(0, slash + 1);
  for (char& c : words) c = c == '\0' ? ' ' : c;
  return printable(words);
}

void write_owner(int file) {
  const std::string text = fmt::format("{}\n{}\n{:%Y-%m-%d %H:%M}\n", getpid(), own_command(),
                                       fmt::localtime(std::time(nullptr)));
  if (ftruncate(file, 0) != 0) return;  // another user's file that cannot be written to
  [[maybe_unused]] const ssize_t written = pwrite(file, text.data(), text.size(), 0);
}

struct Owner {
  pid_t process = 0;  // 0: unknown
  std::string text = "another program";
};

// Reads the owner from a file that anybody can write to.
Owner read_owner(int file) {
  std::array<char, 512> bytes{};
  const ssize_t size = pread(file, bytes.data(), bytes.size(), 0);
  std::istringstream lines(
      std::string(bytes.data(), static_cast<std::size_t>(size > 0 ? size : 0)));
  std::string process, command, since;
  if (!std::getline(lines, process) || !std::getline(lines, command)) return {};
  std::getline(lines, since);
  const long id = std::strtol(process.c_str(), nullptr, 10);
  if (id <= 0 || (kill(static_cast<pid_t>(id), 0) != 0 && errno == ESRCH)) return {};
  return {static_cast<pid_t>(id),
          fmt::format("process {} ({}), since {}", id, printable(command), printable(since))};
}

}  // namespace

fs::path claim_folder(std::span<const fs::path> among) {
  for (const fs::path& folder : among) {
    struct stat is {};
    if (stat(folder.c_str(), &is) == 0 && S_ISDIR(is.st_mode) && (is.st_mode & S_IWOTH) != 0) {
      return folder;
    }
  }
  std::string names;
  for (const fs::path& folder : among) names += (names.empty() ? "" : " or ") + folder.string();
  throw HidError(
      fmt::format("there is no folder for files that say which program uses a device; needed: {}, "
                  "where every user may create files",
                  names));
}

// Has the same places for all users, whatever their environment says.
fs::path claim_folder() {
  static const std::array<fs::path, 2> kPlaces{"/run/lock", "/tmp"};
  return claim_folder(kPlaces);
}

DeviceClaim::DeviceClaim(const std::string& key, const fs::path& folder) : DeviceClaim() {
  const fs::path path = folder / file_name(key);
  for (int i = 0; i < kClaimTries; ++i) {
    if (i > 0) std::this_thread::sleep_for(kPause);
    release();
    file_ = open_file(path);
    if (take_lock(file_, path) && still_there(file_, path)) {
      write_owner(file_);
      return;
    }
    const Owner owner = read_owner(file_);
    if (i + 1 == kClaimTries) throw ClaimTaken("in use by " + owner.text);
  }
}

DeviceClaim DeviceClaim::on_node(const fs::path& node) {
  DeviceClaim claim;
  claim.file_ = open(node.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (claim.file_ < 0) throw HidError(fmt::format("{}: {}", node.string(), std::strerror(errno)));
  for (int i = 0; i < kClaimTries; ++i) {
    if (i > 0) std::this_thread::sleep_for(kPause);
    if (take_lock(claim.file_, node)) return claim;
  }
  throw ClaimTaken(
      fmt::format("{}: in use by another program, perhaps in a container", node.string()));
}

DeviceClaim::DeviceClaim(DeviceClaim&& other) noexcept : file_(std::exchange(other.file_, -1)) {}

DeviceClaim& DeviceClaim::operator=(DeviceClaim&& other) noexcept {
  if (this == &other) return *this;
  release();
  file_ = std::exchange(other.file_, -1);
  return *this;
}

DeviceClaim::~DeviceClaim() { release(); }

void DeviceClaim::release() noexcept {
  if (file_ >= 0) close(std::exchange(file_, -1));
}

std::string claimed_by(const std::string& key, const fs::path& folder) {
  const fs::path path = folder / file_name(key);
  const int file = open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (file < 0) return {};
  const bool free = flock(file, LOCK_SH | LOCK_NB) == 0 || errno != EWOULDBLOCK;
  const Owner owner = free ? Owner{getpid(), {}} : read_owner(file);
  close(file);
  return owner.process == getpid() ? std::string() : owner.text;
}

}  // namespace limpid
