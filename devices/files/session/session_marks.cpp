#include "devices/files/session/session_marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "devices/files/atomic_file.h"
#include "devices/files/session/session_file.h"
#include "devices/files/session/session_lane.h"
#include "devices/files/session/session_source.h"
#include "devices/files/text_file.h"

namespace limpid {

namespace fs = std::filesystem;

namespace {

constexpr hsize_t kMarkChunk = 16;  // of texts less than a page of memory, 4096 bytes
constexpr hdf5::RowShape kSingle;
constexpr std::uint64_t kMostMarks = 100'000;

hdf5::Datatype mark_type() {
  hdf5::Datatype type(H5Tcopy(H5T_C_S1));
  H5Tset_size(type.get(), kMarkLength);
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  return type;
}

}  // namespace

void check_mark(const Mark& mark, const fs::path& file) {
  if (mark.text.size() <= kMarkLength) return;
  throw FileError(fmt::format("{}: a mark's text of {} bytes, at most {} are kept", file.string(),
                              mark.text.size(), kMarkLength));
}

void MarkTable::create(hid_t root, const fs::path& file) {
  const hdf5::Datatype text = mark_type();
  tick_ =
      hdf5::create_growing(root, within_group(kMarkTickPath), H5T_STD_U64LE, kSingle, kMarkChunk);
  text_ = hdf5::create_growing(root, within_group(kMarkTextPath), text.get(), kSingle, kMarkChunk);
  hdf5::check(tick_ && text_, file, "cannot write");
  hdf5::write_text(tick_.get(), "what", "row that was marked", file);
  hdf5::write_text(text_.get(), "what", "what was noted there", file);
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

void read_marks(hid_t root, Session& session, const fs::path& file, hdf5::Claims& claims) {
  if (!hdf5::has(root, kMarkTickPath, file) || !hdf5::has(root, kMarkTextPath, file)) return;
  const Source ticks_at = open_source(root, kMarkTickPath, 1, file);
  const Source texts_at = open_source(root, kMarkTextPath, 1, file);
  for (const Source* source : {&ticks_at, &texts_at}) {
    if (source->rows > kMostMarks) {
      refuse(file,
             fmt::format("{}: {} marks; allowed: {}", source->path, source->rows, kMostMarks));
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
  for (std::size_t i = 0; i < std::min(ticks.size(), texts.size()); ++i) {
    if (ticks[i] < session.size()) {
      session.marks.push_back({ticks[i], texts[i]});
    } else if (!leftover) {
      refuse(file, fmt::format("/marks/tick: entry {}: row {}; allowed: 0 to {}", i, ticks[i],
                               static_cast<std::int64_t>(session.size()) - 1));
    }
  }
  std::ranges::stable_sort(session.marks, {}, &Mark::tick);
}

namespace {

void replace_marks(const fs::path& file, std::span<const Mark> marks) {
  const hdf5::Quiet quiet;
  hdf5::File opened(H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
  hdf5::check(static_cast<bool>(opened), file, "cannot be opened for its marks");
  const hid_t root = opened.get();
  if (H5Lexists(root, "marks", H5P_DEFAULT) > 0) {
    hdf5::check(H5Ldelete(root, "marks", H5P_DEFAULT) >= 0, file, "cannot write its marks");
  }
  MarkTable table;
  try {
    table.create(root, file);
    for (const Mark& mark : marks) table.append(mark);
    table.flush(file);
    hdf5::check(H5Fflush(root, H5F_SCOPE_GLOBAL) >= 0, file, "cannot write its marks");
  } catch (...) {
    write_nowhere(opened);
    throw;
  }
  hdf5::check(table.close() && opened.close(), file, "cannot write its marks");
}

}  // namespace

void write_marks(const fs::path& session, std::span<const Mark> marks) {
  for (const Mark& mark : marks) check_mark(mark, session);
  const NoFileSizeSignal no_signal;
  fs::path copy = session;
  copy += ".marks";
  try {
    std::error_code error;
    if (!fs::copy_file(session, copy, fs::copy_options::overwrite_existing, error)) {
      throw FileError(
          fmt::format("{}: cannot be copied for its marks: {}", session.string(), error.message()));
    }
    replace_marks(copy, marks);
    publish(copy, session, true);
  } catch (const FileError&) {
    std::error_code ignored;
    fs::remove(copy, ignored);
    throw;
  }
}

}  // namespace limpid
