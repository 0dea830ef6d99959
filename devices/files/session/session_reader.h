// Reads session files, of this version and older ones.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <span>

#include "devices/files/session/hdf5_reading.h"
#include "devices/files/session/session.h"
#include "devices/files/session/session_program.h"
#include "devices/files/session/session_stream.h"

namespace limpid {

// Reads HDF5 files in this process, as only limpid-session does: what a broken or hostile file does
// to HDF5's library ends that program. The others have read_session(), write_marks() and
// read_table(), which call it.
Session read_session_here(const std::filesystem::path& file);
// The same in pieces, for a session that need not fit into memory: what it is of, what changes and
// how many rows it claims; its rows in turn. Returns all but rows. A leftover may have fewer rows.
Session read_session_here(
    const std::filesystem::path& file,
    const std::function<void(const Session& about, std::uint64_t rows)>& begins,
    const TakeRows& take);
// All texts and whole numbers at the root, and the columns /done and /measure/... Errors: FileError
// for files that have none.
wire::Table read_table_here(const std::filesystem::path& file);

// Looks at rows in turn for times that do not increase, and laws that there are not.
class RowCheck {
 public:
  RowCheck(const RowLayout& layout, std::filesystem::path file)
      : layout_(layout), file_(std::move(file)) {}
  void take(std::span<const double> rows);  // errors: FileError

 private:
  RowLayout layout_;
  std::filesystem::path file_;
  double before_ = -std::numeric_limits<double>::infinity();
  std::size_t row_ = 0;
};
// Checks the rows of a whole session. Errors: FileError.
void check_rows(const Session& session, const std::filesystem::path& file);

}  // namespace limpid
