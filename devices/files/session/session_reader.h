// Reading of session files, of this version and older ones.
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

// Reads a session in this process, as only limpid-session does: a broken or hostile file may make
// HDF5's library end that program. Other programs use read_session(), write_marks() and
// read_table(), which call it.
Session read_session_here(const std::filesystem::path& file);
// Reads it in pieces, so that it need not fit into memory. `begins` gets its contents, changes and
// claimed number of rows, `take` its rows in turn. Returns all but rows. A leftover may have fewer
// rows.
Session read_session_here(
    const std::filesystem::path& file,
    const std::function<void(const Session& about, std::uint64_t rows)>& begins,
    const TakeRows& take);
// Reads a table of a sweep: texts and whole numbers at the root, and the columns /done and
// /measure/..., all of one length. Errors: FileError for files that have none.
wire::Table read_table_here(const std::filesystem::path& file);

// Checks rows in turn for times that do not increase, and for unknown laws.
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
