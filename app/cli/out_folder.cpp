#include "app/cli/out_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "app/cli/options.h"
#include "devices/files/atomic_file.h"
#include "devices/files/text_file.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestNote = 4096;  // [bytes]

// Tries to write a file in `dir`; returns 0 or errno.
int try_to_write(const fs::path& dir) {
  const std::string probe = (dir / fmt::format(".{}.probe", getpid())).string();
  const int descriptor = open(probe.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (descriptor < 0) return errno;
  const std::vector<char> some(1 << 16);
  errno = ENOSPC;  // the meaning of a short write
  const bool written =
      ::write(descriptor, some.data(), some.size()) == std::ssize(some) && fsync(descriptor) == 0;
  const int code = written ? 0 : errno;
  close(descriptor);
  unlink(probe.c_str());
  return code;
}

bool made_before(const OutFolder& folder) {
  std::error_code none;
  const fs::path note = folder.path / kOutNote;
  if (!fs::is_regular_file(note, none)) return false;
  try {
    return read_text(note, kLongestNote).starts_with(folder.made_by + "\n");
  } catch (const FileError&) {
    return false;
  }
}

}  // namespace

void refuse_foreign(const OutFolder& folder) {
  if (folder.force) return;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.path, none)) {
    if (!std::ranges::count(folder.names, entry.path().stem().string())) continue;
    if (entry.is_directory(none)) continue;
    throw UsageError(fmt::format(
        "--out {}: {} was not written by {}; choose another folder, or replace the file with "
        "--force",
        folder.path.string(), entry.path().filename().string(), folder.made_by));
  }
}

void prepare_out(const fs::path& dir) {
  std::error_code error;
  const bool created = fs::create_directories(dir, error);
  if (!error && !fs::is_directory(dir)) error = std::make_error_code(std::errc::not_a_directory);
  if (!error) error = {try_to_write(dir), std::generic_category()};
  if (!error) return;
  std::error_code none;
  if (created) fs::remove(dir, none);
  throw UsageError(fmt::format("--out {}: {}", dir.string(), error.message()));
}

void claim_out(const OutFolder& folder) {
  prepare_out(folder.path);
  if (made_before(folder)) return;
  refuse_foreign(folder);
  const std::string note =
      folder.made_by + "\nThis command may replace its own results in this folder.\n";
  const std::string wrong = try_write_atomically(folder.path / kOutNote, note);
  if (!wrong.empty()) throw UsageError("--out " + wrong);
}

void add_force(CLI::App& command, bool& force) {
  command.add_flag("--force", force, "replace files in DIR that another command or a person left");
}

}  // namespace limpid
