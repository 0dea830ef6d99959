// Marks of a session: notes of people at moments of it, beside the recording.
//
// They are two lists below the group /marks, one for their ticks and one for their texts. The lists
// have no unit, so that programs which take every list with a unit for a channel pass them by.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "devices/files/session/hdf5_reading.h"
#include "devices/files/session/session.h"

namespace limpid {

// The lists of marks in a file that is being written. Errors of all: FileError naming `file`.
class MarkTable {
 public:
  void create(hid_t root, const std::filesystem::path& file);
  void append(const Mark& mark) { waiting_.push_back(mark); }
  void flush(const std::filesystem::path& file);
  bool close();  // false if it failed; drops what was not flushed
  std::uint64_t count() const { return written_ + waiting_.size(); }

 private:
  hdf5::Dataset tick_, text_;
  std::uint64_t written_ = 0;
  std::vector<Mark> waiting_;
};

// Reads the marks of a file with so many rows. A leftover's marks at missing rows are left out.
// Errors: FileError.
std::vector<Mark> read_marks(hid_t root, std::uint64_t rows, const std::filesystem::path& file,
                             hdf5::Claims& claims);

// Order of write_marks(): the marks to hold, and those that the writer knew of.
struct MarkOrder {
  std::vector<Mark> marks, known;
};
// Writes marks in this process, as only limpid-session does: into the file of `descriptor`, a copy
// of `file`. Errors: FileError; the copy is then worthless.
void write_marks_here(const std::filesystem::path& file, int descriptor, const MarkOrder& order);

}  // namespace limpid
