#include "devices/files/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "core/base/descriptor.h"
#include "devices/files/text_file.h"

namespace limpid {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, int code) {
  throw FileError(fmt::format("{}: cannot be written: {}", file.string(), std::strerror(code)));
}

// Other computers, too, may write in the same folder.
std::string this_process() {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  return fmt::format("{}.{}", host.data(), ::getpid());
}

// A pipe or a device, as /dev/stdout: another file in its place would be the end of it.
void write_into(const fs::path& file, std::span<const unsigned char> bytes) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor < 0) fail(file, errno);
  const int code = write_all(descriptor, bytes) ? 0 : errno;
  ::close(descriptor);
  if (code != 0) fail(file, code);
}

// A new file that is gone again unless it is kept.
class Draft {
 public:
  explicit Draft(const fs::path& file)
      : path_(file.string() + fmt::format(".{}.new", this_process())),
        descriptor_(::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
    if (descriptor_ < 0) fail(file, errno);
  }
  ~Draft() {
    ::close(descriptor_);
    if (!kept_) ::unlink(path_.c_str());
  }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;

  bool write(std::span<const unsigned char> bytes) {
    return write_all(descriptor_, bytes) && ::fsync(descriptor_) == 0;
  }
  bool keep_as(const fs::path& file) {
    kept_ = ::rename(path_.c_str(), file.c_str()) == 0;
    return kept_;
  }

 private:
  std::string path_;
  int descriptor_;
  bool kept_ = false;
};

// The name itself survives a power cut only once its folder is on the disk, too.
void sync_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

void write_atomically(const fs::path& file, std::span<const unsigned char> bytes) {
  std::error_code none;
  // What a link points to is replaced, not the link.
  const fs::path target = fs::is_symlink(file, none) ? fs::weakly_canonical(file, none) : file;
  const NoFileSizeSignal no_signal;
  if (fs::is_other(target, none)) return write_into(target, bytes);
  Draft draft(target);
  if (!draft.write(bytes) || !draft.keep_as(target)) fail(file, errno);
  sync_folder(fs::absolute(target).parent_path());
}

std::string try_write_atomically(const std::filesystem::path& file, std::string_view text) {
  try {
    std::filesystem::create_directories(file.parent_path());
    write_atomically(file, {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
    return {};
  } catch (const std::exception& e) {
    return e.what();
  }
}

namespace {

namespace fs = std::filesystem;
using SteadyClock = std::chrono::steady_clock;

constexpr std::size_t kLongest = 1 << 20;              // of a file [bytes]
constexpr auto kPatience = std::chrono::seconds(2);    // another one takes milliseconds
constexpr auto kPause = std::chrono::milliseconds(5);  // between two tries

// Held while it lives, also against others of this program.
class Lock {
 public:
  explicit Lock(const fs::path& file)
      : descriptor_(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666)) {
    if (descriptor_ < 0) fail(file, std::strerror(errno));
    const auto end = SteadyClock::now() + kPatience;
    while (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      if (errno == EWOULDBLOCK && SteadyClock::now() < end) {
        std::this_thread::sleep_for(kPause);
      } else if (errno != EINTR) {
        const int code = errno;
        ::close(descriptor_);
        fail(file, code == EWOULDBLOCK ? "another program has held it for two seconds"
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

}  // namespace

void update_file_under_lock(const fs::path& file,
                            const std::function<std::string(const std::string& text)>& change) {
  try {
    fs::create_directories(file.parent_path());
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

namespace fs = std::filesystem;

namespace {

constexpr const char* kPart = ".part";

[[noreturn]] void fail(const fs::path& file, const char* what, int code) {
  throw FileError(fmt::format("{}: {}: {}", file.string(), what, std::strerror(code)));
}

fs::path directory_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

void sync(const fs::path& file, int flags) {
  const int descriptor = ::open(file.c_str(), flags | O_CLOEXEC);
  if (descriptor < 0) fail(file, "cannot open", errno);
  const int code = ::fsync(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  if (code != 0) fail(file, "cannot write", code);
}

}  // namespace

fs::path part_of(const fs::path& out) {
  fs::path part = out;
  part += kPart;
  return part;
}

void check_folder(const fs::path& out) {
  std::error_code error;
  const fs::path directory = directory_of(out);
  if (const std::string why = why_not_found(directory, "no such directory"); !why.empty()) {
    throw FileError(fmt::format("{}: {}: {}", out.string(), why, directory.string()));
  }
  if (!fs::is_directory(directory, error)) {
    throw FileError(fmt::format("{}: not a directory: {}", out.string(), directory.string()));
  }
  if (::faccessat(AT_FDCWD, directory.c_str(), W_OK | X_OK, AT_EACCESS) != 0)
    fail(out, "cannot write there", errno);
}

void check_place(const fs::path& out, bool force) {
  std::error_code error;
  if (out.filename().empty()) {
    throw FileError(fmt::format("'{}': not the name of a file", out.string()));
  }
  if (fs::is_directory(out, error)) {
    throw FileError(fmt::format("{}: is a directory", out.string()));
  }
  if (fs::exists(out, error) && !fs::is_regular_file(out, error)) {
    throw FileError(
        fmt::format("{}: is no ordinary file, and would be replaced by one", out.string()));
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
    throw FileError(fmt::format("{}: appeared meanwhile and was left alone; --force overwrites it",
                                out.string()));
  }
  fs::rename(finished, out, error);
  if (error) fail(out, "cannot rename to it", error.value());
  sync(directory_of(out), O_RDONLY | O_DIRECTORY);
}

}  // namespace limpid
