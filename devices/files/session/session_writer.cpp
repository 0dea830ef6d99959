#include "devices/files/session/session_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <optional>

#include "devices/files/atomic_file.h"
#include "devices/files/session/derived_columns.h"
#include "devices/files/session/session_file.h"

namespace limpid {

namespace fs = std::filesystem;

namespace {

constexpr const char* kPart = ".part";

[[noreturn]] void fail(const fs::path& file, const char* what, int code) {
  throw FileError(fmt::format("{}: {}: {}", file.string(), what, std::strerror(code)));
}

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
  if (info.bodies.size() > kMostBodies) {
    throw FileError(fmt::format("{}: {} objects that move; allowed: 0 to {}", file.string(),
                                info.bodies.size(), kMostBodies));
  }
}

WriteLock::WriteLock(const fs::path& file, Make make)
    : descriptor_(
          ::open(file.c_str(), O_RDWR | O_CLOEXEC | (make == Make::yes ? O_CREAT : 0), 0644)) {
  if (descriptor_ < 0) fail(file, "cannot open", errno);
  // A lock of the open file, not of the process, so that it works between threads too; HDF5's own
  // locks (flock) are of another kind and do not meet it.
  struct flock whole {};
  whole.l_type = F_WRLCK;
  whole.l_whence = SEEK_SET;
  if (::fcntl(descriptor_, F_OFD_SETLK, &whole) != 0) {
    const int code = errno;
    ::close(descriptor_);
    if (code == EAGAIN || code == EACCES) {
      throw FileError(fmt::format("{}: is still being recorded", file.string()));
    }
    fail(file, "cannot lock", code);
  }
}

WriteLock::~WriteLock() { ::close(descriptor_); }

// Where a session may be written, and how it gets its name when it is complete.

namespace fs = std::filesystem;

struct SessionWriter::File {
  fs::path out;
  fs::path part;
  bool force;
  std::optional<WriteLock> lock;
  std::optional<SessionFile> session;
};

SessionWriter::SessionWriter(fs::path out, const SessionInfo& info, bool force)
    : file_(std::make_unique<File>()) {
  check_session_info(info, out);
  file_->out = std::move(out);
  file_->part = part_of(file_->out);
  file_->force = force;
  check_place(file_->out, force);
  if (fs::exists(file_->part)) WriteLock(file_->part, WriteLock::Make::no);  // nobody records there
  if (!force && fs::exists(file_->part)) {
    throw FileError(fmt::format(
        "{0}: left by a recording that was not closed; `limpid recover {0}` saves it, --force "
        "overwrites it",
        file_->part.string()));
  }
  file_->lock.emplace(file_->part, WriteLock::Make::yes);
  try {
    file_->session.emplace(file_->part, info);
  } catch (const FileError&) {
    std::error_code ignored;
    fs::remove(file_->part, ignored);  // it holds nothing yet
    throw;
  }
}

SessionWriter::~SessionWriter() = default;

void SessionWriter::append(std::span<const double> rows, std::size_t lane) {
  file_->session->append(rows, lane);
}
void SessionWriter::append(const SettingChange& change, std::size_t lane) {
  file_->session->append(change, lane);
}
void SessionWriter::append(const Mark& mark) { file_->session->append(mark); }
void SessionWriter::append_world(std::span<const double> world, std::size_t lane) {
  file_->session->append_world(world, lane);
}
std::uint64_t SessionWriter::rows_written() const { return file_->session->rows(); }
const fs::path& SessionWriter::part() const { return file_->part; }

void SessionWriter::close(const std::string& warnings) {
  if (!file_->lock) return;
  file_->session->close(warnings);
  publish(file_->part, file_->out, file_->force);
  file_->lock.reset();
}

Recovered recover_session(const fs::path& part, bool force) {
  const fs::path out = recovered_name(part);
  if (const std::string why = why_not_found(part, "no such file"); !why.empty()) {
    throw FileError(fmt::format("{}: {}", part.string(), why));
  }
  check_place(out, force);
  const WriteLock lock(part, WriteLock::Make::no);
  const Session session = read_session(part);

  fs::path copy = out;
  copy += ".recovering";
  try {
    SessionInfo info = session.info;
    info.arm = recorded_arm(info);
    SessionFile file(copy, info);
    const auto copy_run = [&file](const Session& run, std::size_t lane) {
      file.append_world(run.world, lane);
      for (const SettingChange& change : run.changes) file.append(change, lane);
      file.append(run.rows, lane);
    };
    copy_run(session, kMainLane);
    if (session.twin) copy_run(*session.twin, kTwinLane);
    for (const Mark& mark : session.marks) file.append(mark);
    file.close();
    publish(copy, out, force);
  } catch (const FileError&) {
    std::error_code ignored;
    fs::remove(copy, ignored);
    throw;
  }
  fs::remove(part);
  return {out, session.size()};
}

}  // namespace limpid
