#include "devices/files/session/session_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <optional>
#include <thread>

#include "core/base/descriptor.h"
#include "devices/files/atomic_file.h"
#include "devices/files/session/derived_columns.h"
#include "devices/files/session/session_file.h"
#include "devices/files/session/session_stream.h"

namespace limpid {

namespace fs = std::filesystem;

namespace {

constexpr const char* kPart = ".part";

[[noreturn]] void fail(const fs::path& file, const char* what, int code) {
  throw FileError(fmt::format("{}: {}: {}", file.string(), what, std::strerror(code)));
}

constexpr auto kPause = std::chrono::milliseconds(20);  // between two tries

int open_no_link(const fs::path& file, int flags) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | flags, 0644);
  if (descriptor >= 0) return descriptor;
  if (errno == ELOOP) {
    throw FileError(
        fmt::format("{}: is a symbolic link; Limpid does not write through links; remove the link",
                    file.string()));
  }
  fail(file, "cannot open", errno);
}

// Disk space that is left to the recording itself [bytes].
constexpr std::uint64_t kRoomForOthers = 64 << 20;

// A packed second copy of the recording in a file without a name, which becomes OUT.h5. If anything
// fails here, OUT.h5.part still has all.
class PackedCopy {
 public:
  PackedCopy(const fs::path& out, const SessionInfo& info) {
    attempt([&] {
      draft_.emplace(out);
      // A draft with a name would stay if the program is killed.
      if (draft_->has_name())
        throw FileError(
            "this folder cannot have a file without a name, but the packed copy needs such a file");
      file_.emplace(out, draft_->descriptor(), info, Storage::packed);
    });
  }

  template <class Work>
  void with(Work work) {
    if (file_) attempt([&] { check_room(), work(*file_); });
  }
  // Returns whether the copy has taken the name.
  bool keep(const std::string& warnings) {
    with([&](SessionFile& file) {
      file.close(warnings);
      draft_->keep();
      kept_ = true;
    });
    return kept_;
  }

 private:
  template <class Work>
  void attempt(Work work) {
    try {
      work();
    } catch (const FileError&) {
      file_.reset();
      draft_.reset();
    }
  }
  void check_room() const {
    struct statvfs disk {};
    if (::fstatvfs(draft_->descriptor(), &disk) != 0) return;
    if (disk.f_bavail * disk.f_frsize < kRoomForOthers) throw FileError("the disk is nearly full");
  }

  std::optional<Draft> draft_;
  std::optional<SessionFile> file_;
  bool kept_ = false;
};

}  // namespace

fs::path recovered_name(const fs::path& part) {
  if (part.extension() != kPart || part.stem().empty()) {
    throw FileError(fmt::format("{}: not the .part file of a recording", part.string()));
  }
  return part.parent_path() / part.stem();
}

void check_session_info(const SessionInfo& info, const fs::path& file) {
  if (!(info.tick > 0 && info.tick <= 0.1)) {
    throw FileError(
        fmt::format("{}: tick {} s; allowed: more than 0, up to 0.1", file.string(), info.tick));
  }
  if (info.dof < 1 || info.dof > kMaxDof) {
    throw FileError(fmt::format("{}: dof {}; allowed: 1 to {}", file.string(), info.dof, kMaxDof));
  }
  if (info.lanes() > kMostLanes) {
    throw FileError(
        fmt::format("{}: {} runs; allowed: 1 to {}", file.string(), info.lanes(), kMostLanes));
  }
  if (info.bodies.size() > kMostBodies) {
    throw FileError(fmt::format("{}: {} objects that move; allowed: 0 to {}", file.string(),
                                info.bodies.size(), kMostBodies));
  }
}

WriteLock::WriteLock(const fs::path& file, Make make, std::chrono::milliseconds patience)
    : descriptor_(open_no_link(file, make == Make::yes ? O_CREAT : 0)) {
  // Locks the open file, not the process, so that it works between threads, too.
  struct flock whole {};
  whole.l_type = F_WRLCK;
  whole.l_whence = SEEK_SET;
  const auto end = std::chrono::steady_clock::now() + patience;
  while (::fcntl(descriptor_, F_OFD_SETLK, &whole) != 0) {
    const int code = errno;
    if (has_no_locks(code)) return;
    const bool taken = code == EAGAIN || code == EACCES;
    if (taken && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(kPause);
      continue;
    }
    ::close(descriptor_);
    if (!taken) fail(file, "cannot lock", code);
    throw FileError(
        fmt::format("{}: is still being recorded, or changed by another program", file.string()));
  }
  held_ = true;
}

WriteLock::~WriteLock() { ::close(descriptor_); }

struct SessionWriter::File {
  fs::path out;
  fs::path part;
  bool force;
  std::optional<WriteLock> lock;
  std::optional<SessionFile> session;
  std::optional<PackedCopy> packed;  // nothing: not packed

  template <class... What>
  void append(const What&... what) {
    session->append(what...);
    if (packed) packed->with([&](SessionFile& copy) { copy.append(what...); });
  }
};

SessionWriter::SessionWriter(fs::path out, const SessionInfo& info, bool force, Packing packing)
    : file_(std::make_unique<File>()) {
  check_session_info(info, out);
  check_ending(out, kSessionEnding);
  file_->out = std::move(out);
  file_->part = part_of(file_->out);
  file_->force = force;
  check_place(file_->out, force);
  const bool left = fs::exists(fs::symlink_status(file_->part));
  if (left) WriteLock(file_->part, WriteLock::Make::no);  // refuses if somebody records there
  if (!force && left) {
    throw FileError(
        fmt::format("{0}: belongs to a recording that was not closed; `limpid recover {0}` saves "
                    "that recording, --force overwrites the file",
                    file_->part.string()));
  }
  file_->lock.emplace(file_->part, WriteLock::Make::yes);
  try {
    file_->session.emplace(file_->part, file_->lock->descriptor(), info, Storage::safe);
    if (packing == Packing::yes) file_->packed.emplace(file_->out, info);
  } catch (const FileError&) {
    std::error_code ignored;
    fs::remove(file_->part, ignored);  // it holds nothing yet
    throw;
  }
}

SessionWriter::~SessionWriter() = default;

void SessionWriter::append(std::span<const double> rows, std::size_t lane) {
  file_->append(rows, lane);
}
void SessionWriter::append(const SettingChange& change, std::size_t lane) {
  file_->append(change, lane);
}
void SessionWriter::append(const Mark& mark) { file_->append(mark); }
void SessionWriter::append_world(std::span<const double> world, std::size_t lane) {
  file_->session->append_world(world, lane);
  if (!file_->packed) return;
  file_->packed->with([&](SessionFile& copy) { copy.append_world(world, lane); });
}
std::uint64_t SessionWriter::rows_written() const { return file_->session->rows(); }
const fs::path& SessionWriter::part() const { return file_->part; }
bool SessionWriter::is_locked() const { return file_->lock && file_->lock->held(); }

void SessionWriter::close(const std::string& warnings) {
  if (!file_->lock) return;
  file_->session->close(warnings);
  std::error_code none;
  const bool free = file_->force || !fs::exists(file_->out, none);
  if (free && file_->packed && file_->packed->keep(warnings)) {
    fs::remove(file_->part, none);
  } else {
    publish(file_->part, file_->out, file_->force);
  }
  file_->lock.reset();
}

Recovered recover_session(const fs::path& part, bool force, const fs::path& to) {
  const fs::path own = recovered_name(part);
  const fs::path out = to.empty() ? own : to;
  if (const std::string why = why_not_found(part, "no such file"); !why.empty()) {
    throw FileError(fmt::format("{}: {}", part.string(), why));
  }
  if (std::error_code none; fs::equivalent(out, part, none)) {
    throw FileError(fmt::format("{}: is the file to recover; choose another name", out.string()));
  }
  check_place(out, force);
  const WriteLock lock(part, WriteLock::Make::no);
  // In pieces: rows in memory or beside it would take room that the copy may need.
  std::optional<Session> about;
  std::optional<Draft> draft;
  std::optional<SessionFile> file;
  const auto begin = [&] {
    SessionInfo info = about->info;
    info.arm = recorded_arm(info);
    draft.emplace(out);
    file.emplace(out, draft->descriptor(), info, Storage::packed);
    for (std::size_t i = 0; i < about->lanes(); ++i) file->append_world(about->lane(i).world, i);
  };
  const Session rest = read_session(
      part, [&](const Session& it) { about = it; },
      [&](LaneRows rows) {
        if (!file) begin();
        for (std::size_t i = 0; i < rows.size(); ++i) file->append(rows[i], i);
      });
  if (!file) {
    throw FileError(
        fmt::format("{}: nothing was recorded; this file can be deleted", part.string()));
  }
  for (std::size_t i = 0; i < rest.lanes(); ++i) {
    for (const SettingChange& change : rest.lane(i).changes) file->append(change, i);
  }
  for (const Mark& mark : rest.marks) file->append(mark);
  const std::uint64_t rows = file->rows();
  file->close();
  if (!force && fs::exists(out)) {
    throw FileError(
        fmt::format("{}: another program made this file in the meantime; Limpid has not changed "
                    "it; --force overwrites the file",
                    out.string()));
  }
  draft->keep();
  fs::remove(part);
  return {out, rows};
}

}  // namespace limpid
