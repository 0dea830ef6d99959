// Files that are replaced whole: as they were or as they shall be, whatever happens meanwhile.
#pragma once

#include <signal.h>

#include <ctime>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace limpid {

// Makes writing past the file size limit of the shell (ulimit -f) an error alone. Without it the
// kernel also sends this thread a deadly signal.
class NoFileSizeSignal {
 public:
  NoFileSizeSignal() {
    sigemptyset(&signal_);
    sigaddset(&signal_, SIGXFSZ);
    pthread_sigmask(SIG_BLOCK, &signal_, &before_);
  }
  ~NoFileSizeSignal() {
    const timespec no_wait{};
    if (sigismember(&before_, SIGXFSZ) == 0) sigtimedwait(&signal_, nullptr, &no_wait);
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  NoFileSizeSignal(const NoFileSizeSignal&) = delete;
  NoFileSizeSignal& operator=(const NoFileSizeSignal&) = delete;

 private:
  sigset_t signal_{};
  sigset_t before_{};
};

// A new file in the folder of `file`, without a name of its own if the file system can do that.
// Unless it is kept, it is gone with this object or the process.
class Draft {
 public:
  // Errors, also of keep(): FileError naming `file`.
  explicit Draft(const std::filesystem::path& file);
  ~Draft();
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;

  int descriptor() const { return descriptor_; }  // for reading and writing
  bool has_name() const { return !name_.empty(); }
  // Brings it to the disk and gives it the name `file`, in place of what has that name. A link is
  // replaced: see past_links().
  void keep();

 private:
  std::filesystem::path file_, name_;
  int descriptor_;
};

// The file that a link leads to; any other file is returned as it is.
std::filesystem::path past_links(const std::filesystem::path& file);

// Writes the bytes to the disk beside `file`, then gives them its name. Errors: FileError; the file
// is then as it was. Pipes and devices are written into instead.
void write_atomically(const std::filesystem::path& file, std::span<const unsigned char> bytes);

// Writes text likewise, and makes the folder if needed. Returns the error instead of throwing,
// empty if none: for files not worth losing work over.
std::string try_write_atomically(const std::filesystem::path& file, std::string_view text);

// Changes a file that several programs change, each its own part. Hands `change` its present text,
// empty if there is no file, and writes what `change` returns. FILE.lock, which stays, is locked
// meanwhile: others that use this function wait. Where the file system has no locks, nobody waits.
// Makes the folder if needed. Errors: FileError if it cannot be read or written, or if another
// program holds the lock for more than two seconds. After these, and if `change` throws, the file
// is as it was.
void update_file_under_lock(const std::filesystem::path& file,
                            const std::function<std::string(const std::string& text)>& change);

// Copies a file that cannot be read, before it is replaced, to FILE.unread or the first
// FILE.unread-N that is new. Errors: FileError.
void keep_unread(const std::filesystem::path& file);

// The file OUT.part, in which a file that takes long to write grows until it is whole.
std::filesystem::path part_of(const std::filesystem::path& out);

// Refuses a name of another ending, ".h5", than that of what will be in the file. Errors:
// FileError.
void check_ending(const std::filesystem::path& out, std::string_view ending);
// Refuses names too long for the endings put behind them. Errors: FileError.
void check_name(const std::filesystem::path& out);
// Refuses an `out` whose folder cannot hold a new file, before it is made. Errors: FileError.
void check_folder(const std::filesystem::path& out);
// Refuses what check_name() or check_folder() refuses, folders, and without `force` any file.
// Errors: FileError.
void check_place(const std::filesystem::path& out, bool force);

// Brings a finished file to the disk and gives it the name `out`. Errors: FileError.
void publish(const std::filesystem::path& finished, const std::filesystem::path& out, bool force);

}  // namespace limpid
