// Where a session may be written, and how it gets its name when it is complete.
#include <fmt/format.h>

#include <optional>

#include "devices/files/place.h"
#include "devices/files/session/derived_columns.h"
#include "devices/files/session/session_file.h"
#include "devices/files/session/session_place.h"

namespace limpid {

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
std::uint64_t SessionWriter::rows_written() const { return file_->session->rows(); }
const fs::path& SessionWriter::part() const { return file_->part; }

void SessionWriter::close() {
  if (!file_->lock) return;
  file_->session->close();
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
      for (const SettingChange& change : run.changes) file.append(change, lane);
      file.append(run.rows, lane);
    };
    copy_run(session, kMainLane);
    if (session.twin) copy_run(*session.twin, kTwinLane);
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
