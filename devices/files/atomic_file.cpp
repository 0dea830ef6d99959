#include "devices/files/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <climits>
#include <cstring>
#include <random>
#include <thread>

#include "core/base/descriptor.h"
#include "devices/files/text_file.h"

namespace limpid {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, int code) {
  throw FileError(fmt::format("{}: cannot be written: {}", file.string(), std::strerror(code)));
}

// Writes into a pipe or a device, as /dev/stdout, which no file may replace.
void write_into(const fs::path& file, std::span<const unsigned char> bytes) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor < 0) fail(file, errno);
  const int code = write_all(descriptor, bytes) ? 0 : errno;
  ::close(descriptor);
  if (code != 0) fail(file, code);
}

// Makes a new name survive a power cut: that takes its folder on the disk, too.
void sync_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

// A name that nobody else takes, on any computer. Short, as names have at most 255 bytes.
fs::path fresh_name(const fs::path& folder) {
  std::random_device chance;
  return folder / fmt::format(".limpid-{:08x}{:08x}.new", chance(), chance());
}

using SteadyClock = std::chrono::steady_clock;

constexpr std::size_t kLongest = 1 << 20;              // of a file [bytes]
constexpr auto kPatience = std::chrono::seconds(2);    // others hold it for milliseconds
constexpr auto kPause = std::chrono::milliseconds(5);  // between two tries

// A lock that keeps out others, also threads of this program, while it lives. A file system without
// locks keeps nobody out.
class Lock {
 public:
  explicit Lock(const fs::path& file)
      : descriptor_(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666)) {
    if (descriptor_ < 0) fail(file, std::strerror(errno));
    const auto end = SteadyClock::now() + kPatience;
    while (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && !has_no_locks(errno)) {
      if (errno == EWOULDBLOCK && SteadyClock::now() < end) {
        std::this_thread::sleep_for(kPause);
      } else if (errno != EINTR) {
        const int code = errno;
        ::close(descriptor_);
        fail(file, code == EWOULDBLOCK ? "another program has held the file locked for two seconds"
                                       : std::strerror(code));
      }
    }
  }
  ~Lock() { ::close(descriptor_); }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

 private:
  [[noreturn]] static void fail(const fs::path& file, const char* why) {
    throw FileError(fmt::format("{}: cannot be locked: {}", file.string(), why));
  }

  int descriptor_;
};

constexpr const char* kPart = ".part";
// The longest name without the endings put behind it: .part, and .frames of a video [bytes].
constexpr std::size_t kLongestName = NAME_MAX - 12;

[[noreturn]] void fail(const fs::path& file, const char* what, int code) {
  throw FileError(fmt::format("{}: {}: {}", file.string(), what, std::strerror(code)));
}

void sync(const fs::path& file, int flags) {
  const int descriptor = ::open(file.c_str(), flags | O_CLOEXEC);
  if (descriptor < 0) fail(file, "cannot open", errno);
  const int code = ::fsync(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  if (code != 0) fail(file, "cannot write", code);
}

}  // namespace

Draft::Draft(const fs::path& file)
    : file_(file),
      descriptor_(::open(folder_of(file).c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666)) {
  if (descriptor_ >= 0) return;
  // File systems without nameless files get one with a temporary name.
  name_ = fresh_name(folder_of(file));
  descriptor_ = ::open(name_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail(file, errno);
}

Draft::~Draft() {
  ::close(descriptor_);
  if (!name_.empty()) ::unlink(name_.c_str());
}

void Draft::keep() {
  if (::fsync(descriptor_) != 0) fail(file_, errno);
  if (name_.empty()) {
    const fs::path name = fresh_name(folder_of(file_));
    const std::string here = fmt::format("/proc/self/fd/{}", descriptor_);
    if (::linkat(AT_FDCWD, here.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) != 0) {
      fail(file_, errno);
    }
    name_ = name;
  }
  if (::rename(name_.c_str(), file_.c_str()) != 0) fail(file_, errno);
  name_.clear();
  sync_folder(folder_of(file_));
}

fs::path past_links(const fs::path& file) {
  std::error_code none;
  return fs::is_symlink(file, none) ? fs::weakly_canonical(file, none) : file;
}

void write_atomically(const fs::path& file, std::span<const unsigned char> bytes) {
  std::error_code none;
  const fs::path target = past_links(file);
  const NoFileSizeSignal no_signal;
  if (fs::is_other(target, none)) return write_into(target, bytes);
  Draft draft(target);
  if (!write_all(draft.descriptor(), bytes)) fail(file, errno);
  draft.keep();
}

std::string try_write_atomically(const std::filesystem::path& file, std::string_view text) {
  try {
    fs::create_directories(folder_of(file));
    write_atomically(file, {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
    return {};
  } catch (const std::exception& e) {
    return e.what();
  }
}

void update_file_under_lock(const fs::path& file,
                            const std::function<std::string(const std::string& text)>& change) {
  try {
    fs::create_directories(folder_of(file));
  } catch (const fs::filesystem_error& e) {
    throw FileError(fmt::format("{}: cannot be written: {}", file.string(), e.code().message()));
  }
  const Lock lock(file.string() + ".lock");
  const std::string now = change(fs::exists(file) ? read_text(file, kLongest) : std::string());
  write_atomically(file, {reinterpret_cast<const unsigned char*>(now.data()), now.size()});
}

void keep_unread(const fs::path& file) {
  const std::string beside = file.string() + ".unread";
  fs::path kept = beside;
  for (int number = 2; fs::exists(kept); ++number) kept = fmt::format("{}-{}", beside, number);
  std::error_code error;
  fs::copy_file(file, kept, error);
  if (error) throw FileError(fmt::format("{}: {}", kept.string(), error.message()));
}

fs::path part_of(const fs::path& out) {
  fs::path part = out;
  part += kPart;
  return part;
}

void check_folder(const fs::path& out) {
  std::error_code error;
  const fs::path directory = folder_of(out);
  if (const std::string why = why_not_found(directory, "no such directory"); !why.empty()) {
    throw FileError(fmt::format("{}: {}: {}", out.string(), why, directory.string()));
  }
  if (!fs::is_directory(directory, error)) {
    throw FileError(fmt::format("{}: not a directory: {}", out.string(), directory.string()));
  }
  if (::faccessat(AT_FDCWD, directory.c_str(), W_OK | X_OK, AT_EACCESS) != 0)
    fail(out, "cannot write there", errno);
}

void check_ending(const fs::path& out, std::string_view ending) {
  if (out.extension() == ending) return;
  throw FileError(
      fmt::format("{}: is not allowed; allowed: a name that ends in {}", out.string(), ending));
}

void check_name(const fs::path& out) {
  if (const std::size_t size = out.filename().native().size(); size > kLongestName) {
    throw FileError(
        fmt::format("{}: a name of {} bytes; allowed: at most {}, because Limpid adds letters to "
                    "the name while it writes the file",
                    out.string(), size, kLongestName));
  }
}

void check_place(const fs::path& out, bool force) {
  std::error_code error;
  check_name(out);
  if (out.filename().empty()) {
    throw FileError(fmt::format("'{}': not the name of a file", out.string()));
  }
  if (fs::is_directory(out, error)) {
    throw FileError(fmt::format("{}: is a directory", out.string()));
  }
  if (fs::exists(out, error) && !fs::is_regular_file(out, error)) {
    throw FileError(fmt::format("{}: is not an ordinary file; Limpid replaces only ordinary files",
                                out.string()));
  }
  if (!force && fs::exists(out, error)) {
    throw FileError(fmt::format("{}: exists; --force overwrites it", out.string()));
  }
  check_folder(out);
}

void publish(const fs::path& finished, const fs::path& out, bool force) {
  sync(finished, O_RDWR);
  std::error_code error;
  if (!force && fs::exists(out, error)) {
    throw FileError(
        fmt::format("{}: another program made this file in the meantime; Limpid has not changed "
                    "it; --force overwrites the file",
                    out.string()));
  }
  fs::rename(finished, out, error);
  if (error) fail(out, "cannot rename to it", error.value());
  sync(folder_of(out), O_RDONLY | O_DIRECTORY);
}

}  // namespace limpid
