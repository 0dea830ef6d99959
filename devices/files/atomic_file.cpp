#include "devices/files/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "core/process/descriptor.h"
#include "devices/files/file_error.h"
#include "devices/files/file_size_signal.h"

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

}  // namespace limpid
