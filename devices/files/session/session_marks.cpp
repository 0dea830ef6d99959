#include "devices/files/session/session_marks.h"

#include <fmt/format.h>
#include <sys/sendfile.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <set>
#include <string>
#include <utility>

#include "devices/files/atomic_file.h"
#include "devices/files/session/hdf5_descriptor.h"
#include "devices/files/session/session_lane.h"
#include "devices/files/session/session_program.h"
#include "devices/files/session/session_source.h"
#include "devices/files/session/session_writer.h"
#include "devices/files/text_file.h"

namespace limpid {

namespace fs = std::filesystem;

namespace {

constexpr hdf5::Chunks kMarkChunk{16};  // its texts take less than a page of memory, 4096 bytes
constexpr hdf5::RowShape kSingle;

hdf5::Datatype mark_type() {
  hdf5::Datatype type(H5Tcopy(H5T_C_S1));
  H5Tset_size(type.get(), kMarkLength);
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  return type;
}

// Marks that the file then has to hold: those of `order`, and all of other programs.
std::vector<Mark> merged(const MarkOrder& order, const std::vector<Mark>& found) {
  std::set<std::pair<std::uint64_t, std::string>> own;
  for (const auto* const marks : {&order.known, &order.marks}) {
    for (const Mark& mark : *marks) own.emplace(mark.tick, mark.text);
  }
  std::vector<Mark> all = order.marks;
  for (const Mark& mark : found) {
    if (!own.contains({mark.tick, mark.text})) all.push_back(mark);
  }
  return all;
}

constexpr auto kPatience = std::chrono::seconds(10);  // for others who change the same recording

// Identity of a file, and the time of its last change.
struct Version {
  dev_t device;
  ino_t number;
  off_t size;
  timespec changed;

  static Version of(const struct stat& about) {
    return {about.st_dev, about.st_ino, about.st_size, about.st_mtim};
  }
  bool operator==(const Version& other) const {
    return device == other.device && number == other.number && size == other.size &&
           changed.tv_sec == other.changed.tv_sec && changed.tv_nsec == other.changed.tv_nsec;
  }
};

struct stat about(const fs::path& file) {
  struct stat now {};
  if (::stat(file.c_str(), &now) != 0) {
    throw FileError(fmt::format("{}: {}", file.string(), std::strerror(errno)));
  }
  return now;
}

void copy_whole(const fs::path& file, int from, int to, const struct stat& as) {
  ::fchmod(to, as.st_mode & 07777);
  constexpr std::size_t kCopiedAtOnce = 1 << 30;
  while (true) {
    const ssize_t copied = ::sendfile(to, from, nullptr, kCopiedAtOnce);
    if (copied == 0) return;
    if (copied < 0 && errno != EINTR) {
      throw FileError(fmt::format("{}: cannot be copied to add marks: {}", file.string(),
                                  std::strerror(errno)));
    }
  }
}

}  // namespace

void check_mark(const Mark& mark, const fs::path& file) {
  if (mark.text.size() <= kMarkLength) return;
  throw FileError(fmt::format("{}: the text of a mark has {} bytes; allowed: at most {}",
                              file.string(), mark.text.size(), kMarkLength));
}

void MarkTable::create(hid_t root, const fs::path& file) {
  const hdf5::Datatype text = mark_type();
  tick_ =
      hdf5::create_growing(root, within_group(kMarkTickPath), H5T_STD_U64LE, kSingle, kMarkChunk);
  text_ = hdf5::create_growing(root, within_group(kMarkTextPath), text.get(), kSingle, kMarkChunk);
  hdf5::check(tick_ && text_, file, "cannot write");
  hdf5::make_scale(tick_, "tick", file);
  hdf5::attach_scale(text_, tick_, 0, file);
  hdf5::write_text(tick_.get(), "what", "row that was marked", file);
  hdf5::write_text(text_.get(), "what", "text of the mark", file);
}

void MarkTable::flush(const fs::path& file) {
  if (waiting_.empty()) return;
  std::vector<std::uint64_t> ticks;
  std::string texts;
  for (const Mark& mark : waiting_) {
    ticks.push_back(mark.tick);
    texts += mark.text;
    texts.resize(ticks.size() * kMarkLength, '\0');
  }
  const hdf5::Datatype text = mark_type();
  hdf5::append_to(text_, written_, ticks.size(), kSingle, text.get(), texts.data(), file);
  hdf5::append_to(tick_, written_, ticks.size(), kSingle, H5T_NATIVE_UINT64, ticks.data(), file);
  written_ += ticks.size();
  waiting_.clear();
}

bool MarkTable::close() {
  const bool tick = tick_.close(), text = text_.close();
  return tick && text;
}

std::vector<Mark> read_marks(hid_t root, std::uint64_t rows, const fs::path& file,
                             hdf5::Claims& claims) {
  if (!hdf5::has(root, kMarkTickPath, file) || !hdf5::has(root, kMarkTextPath, file)) return {};
  const Source ticks_at = open_source(root, kMarkTickPath, 1, file);
  const Source texts_at = open_source(root, kMarkTextPath, 1, file);
  for (const Source* source : {&ticks_at, &texts_at}) {
    if (source->rows > kMostMarks) {
      refuse(file, fmt::format("{}: {} marks; allowed: at most {}", source->path, source->rows,
                               kMostMarks));
    }
    claims.stored(source->dataset);
  }
  claims.take(ticks_at.rows, sizeof(std::uint64_t), ticks_at.path);
  claims.take(texts_at.rows, sizeof(std::string) + 2 * kMarkLength, texts_at.path);
  const auto ticks = read_row_numbers(ticks_at, file);
  const auto texts = read_texts(texts_at, kMarkLength, file);
  const bool leftover = is_leftover(file);
  if (ticks.size() != texts.size() && !leftover) {
    refuse(file, "/marks/tick and /marks/text differ in length; needed: the same");
  }
  std::vector<Mark> marks;
  for (std::size_t i = 0; i < std::min(ticks.size(), texts.size()); ++i) {
    if (ticks[i] < rows) {
      marks.push_back({ticks[i], texts[i]});
    } else if (!leftover) {
      refuse(file, fmt::format("/marks/tick: entry {}: row {}; allowed: 0 to {}", i, ticks[i],
                               static_cast<std::int64_t>(rows) - 1));
    }
  }
  std::ranges::stable_sort(marks, {}, &Mark::tick);
  return marks;
}

void write_marks_here(const fs::path& file, int descriptor, const MarkOrder& order) {
  const hdf5::Quiet quiet;
  const NoFileSizeSignal no_signal;
  hdf5::check_before_opening(file);
  const hdf5::Properties access = hdf5::access_by(descriptor, file);
  hdf5::File opened(H5Fopen(file.c_str(), H5F_ACC_RDWR, access.get()));
  hdf5::check(static_cast<bool>(opened), file, "cannot be opened to add marks");
  const hid_t root = opened.get();
  hdf5::Claims claims(file);
  const Source times = open_source(root, kColumnInfo[column_index(Column::time)].path, 1, file);
  claims.stored(times.dataset);
  const std::vector<Mark> all = merged(order, read_marks(root, times.rows, file, claims));
  for (const Mark& mark : all) {
    if (mark.tick >= times.rows) {
      refuse(file,
             fmt::format("has {} rows now, so row {} cannot be marked", times.rows, mark.tick));
    }
  }
  if (all.size() > kMostMarks) {
    refuse(file, fmt::format("{} marks; allowed: at most {}", all.size(), kMostMarks));
  }
  if (H5Lexists(root, "marks", H5P_DEFAULT) > 0) {
    hdf5::check(H5Ldelete(root, "marks", H5P_DEFAULT) >= 0, file, "cannot write its marks");
  }
  MarkTable table;
  table.create(root, file);
  for (const Mark& mark : all) table.append(mark);
  table.flush(file);
  hdf5::check(H5Fflush(root, H5F_SCOPE_GLOBAL) >= 0, file, "cannot write its marks");
  hdf5::check(table.close() && opened.close(), file, "cannot write its marks");
}

void write_marks(const fs::path& session, std::span<const Mark> marks,
                 std::span<const Mark> known) {
  for (const Mark& mark : marks) check_mark(mark, session);
  hdf5::check_regular_file(session);
  const NoFileSizeSignal no_signal;
  const fs::path file = past_links(session);
  while (true) {
    const WriteLock lock(file, WriteLock::Make::no, kPatience);
    struct stat locked {};
    ::fstat(lock.descriptor(), &locked);
    // The program that had the lock may have put another file in its place.
    if (!(Version::of(locked) == Version::of(about(file)))) continue;
    Draft copy(file);
    copy_whole(session, lock.descriptor(), copy.descriptor(), locked);
    write_marks_into(session, copy.descriptor(),
                     {{marks.begin(), marks.end()}, {known.begin(), known.end()}});
    if (!(Version::of(locked) == Version::of(about(file)))) {
      throw FileError(
          fmt::format("{}: another program changed the file in the meantime", session.string()));
    }
    return copy.keep();
  }
}

}  // namespace limpid
