#include "devices/files/file_update.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "devices/files/atomic_file.h"
#include "devices/files/file_error.h"
#include "devices/files/text_file.h"

namespace limpid {
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

}  // namespace limpid
