// Files that are either as they were or as they shall be, whatever happens meanwhile.
#pragma once

#include <signal.h>

#include <ctime>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace limpid {

// Writing past a limit of the shell as an error, not as a signal.

// Past the file size limit of the shell (ulimit -f) the kernel sends a deadly signal with the
// error. While this lives the thread sees the error alone.
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

// A new file in the folder of `file`, without a name of its own where the file system has such. It
// is gone, also with the process, unless it is kept.
class Draft {
 public:
  // Errors of both: FileError naming `file`.
  explicit Draft(const std::filesystem::path& file);
  ~Draft();
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;

  int descriptor() const { return descriptor_; }  // for reading and writing
  bool has_name() const { return !name_.empty(); }
  // Goes on to the disk and takes the name `file`, in place of what has it. A link is replaced:
  // see past_links().
  void keep();

 private:
  std::filesystem::path file_, name_;
  int descriptor_;
};

// The file that a link leads to; any other file itself.
std::filesystem::path past_links(const std::filesystem::path& file);

// Puts the bytes on the disk beside `file` and gives them its name then. Errors: FileError; the
// file is then as it was. Pipes and devices are written into instead.
void write_atomically(const std::filesystem::path& file, std::span<const unsigned char> bytes);

// The same for text and a folder that may not be there yet, for what is not worth losing work over:
// returns what went wrong, empty if nothing did.
std::string try_write_atomically(const std::filesystem::path& file, std::string_view text);

// Files that several programs change: one after the other, and each only its own part.

// Hands `change` the text of the file as it is now, empty where there is none, and puts what it
// returns in the file's place. Nobody else who comes this way reads or writes it meanwhile: they
// lock FILE.lock, which stays. The folder is made if need be. Errors: FileError where it cannot be
// read or written, or where another program holds the lock for more than two seconds; the file is
// then as it was, as it is when `change` throws.
void update_file_under_lock(const std::filesystem::path& file,
                            const std::function<std::string(const std::string& text)>& change);

// Before something else takes the place of a file that cannot be read: its bytes stay beside it, as
// FILE.unread, or with the first number that makes it a new one. Errors: FileError.
void keep_unread(const std::filesystem::path& file);

// Where files that take long to write go: OUT.part while they grow, OUT once they are whole.

// OUT -> OUT.part
std::filesystem::path part_of(const std::filesystem::path& out);

// Whether the name leaves room for what goes behind it. Errors: FileError.
void check_name(const std::filesystem::path& out);
// Whether there can be a new file in the folder of `out`, before it is made. Errors: FileError.
void check_folder(const std::filesystem::path& out);
// The same for `out` itself, which must not be a folder, nor, without `force`, a file.
void check_place(const std::filesystem::path& out, bool force);

// Brings a finished file to the disk and gives it its name. Errors: FileError.
void publish(const std::filesystem::path& finished, const std::filesystem::path& out, bool force);

}  // namespace limpid
