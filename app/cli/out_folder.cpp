#include "app/cli/out_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>

#include "app/cli/options.h"
#include "devices/files/atomic_file.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestNote = 4096;  // [lines]

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

constexpr const char* kOurs = "limpid ";  // begins each note

// Returns the lines of a folder's note; none if it has none. Errors: UsageError for a file of a
// person's.
std::vector<std::string> lines_of_note(const OutFolder& folder) {
  std::error_code none;
  const fs::path note = folder.path / kOutNote;
  if (!fs::exists(note, none)) return {};
  std::vector<std::string> lines;
  std::ifstream in(note);
  for (std::string line; lines.size() < kLongestNote && std::getline(in, line);)
    lines.push_back(line);
  if (!lines.empty() && lines.front().starts_with(kOurs)) return lines;
  throw UsageError(
      fmt::format("--out {}: {} was not written by Limpid, but Limpid needs a file with this name; "
                  "choose another folder, or move the file",
                  folder.path.string(), kOutNote));
}

}  // namespace

void refuse_foreign(const OutFolder& folder) {
  if (folder.force) return;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.path, error)) {
    const fs::path file = entry.path().filename();
    std::error_code none;
    if (!std::ranges::count(folder.names, file.stem().string()) ||
        (entry.is_directory(none) && !file.has_extension())) {
      continue;
    }
    throw UsageError(
        fmt::format("--out {}: no mark shows that {} was written by {}; choose another folder, or "
                    "use --force to replace the file",
                    folder.path.string(), file.string(), folder.made_by));
  }
  if (error) throw UsageError(fmt::format("--out {}: {}", folder.path.string(), error.message()));
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
  std::vector<std::string> known = lines_of_note(folder);
  if (!known.empty() && known.front() != folder.made_by) known.clear();
  const auto is_known = [&](const std::string& name) {
    return std::ranges::count(known, name) > 0;
  };
  OutFolder unknown = folder;
  std::erase_if(unknown.names, is_known);
  refuse_foreign(unknown);
  if (known.empty()) known.push_back(folder.made_by);
  std::ranges::copy(unknown.names, std::back_inserter(known));
  const std::string wrong =
      try_write_atomically(folder.path / kOutNote, fmt::format("{}\n", fmt::join(known, "\n")));
  if (!wrong.empty()) throw UsageError("--out " + wrong);
}

void add_force(CLI::App& command, bool& force) {
  command.add_flag("--force", force, "replace files in DIR that another command or a person wrote");
}

}  // namespace limpid
