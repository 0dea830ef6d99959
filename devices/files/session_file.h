// One HDF5 session file being written, wherever it lies. SessionWriter adds where it may lie and
// what it is called when done.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "devices/files/hdf5_handles.h"
#include "devices/files/session.h"

namespace limpid {

// Names and sizes that writer and reader agree on.
inline constexpr const char* kSessionFormat = "limpid-session";
inline constexpr int kSessionVersion = 1;
inline constexpr std::size_t kSettingLength = 120;
inline constexpr const char* kEventRowPath = "/events/row";
inline constexpr const char* kEventSettingPath = "/events/setting";

// What a row reads as that was announced but never written: a not-a-number that no arithmetic
// makes. Only a killed recording can hold it.
inline constexpr std::uint64_t kNeverWritten = 0x7ff8'6c69'6d70'6964;

inline std::size_t column_index(Column c) { return static_cast<std::size_t>(c); }

// HDF5's rules for a file that survives being killed (single writer, multiple readers): everything
// is created before writing starts, a chunk is written once and whole, then flushed.
// Errors: FileError. After one, the file stays as the last flush left it and takes nothing more.
class SessionFile {
 public:
  SessionFile(std::filesystem::path path, const SessionInfo& info);
  ~SessionFile();  // without close(): the file stays as the last flush left it
  SessionFile(const SessionFile&) = delete;
  SessionFile& operator=(const SessionFile&) = delete;

  void append(std::span<const double> rows);
  void append(const SettingChange& change);
  void close();  // writes what is pending and closes for good
  std::uint64_t rows() const { return flushed_rows_ + pending_rows(); }

 private:
  std::uint64_t pending_rows() const;
  void create(const SessionInfo& info);
  void create_column(const ColumnInfo& column);
  void create_events();
  void write_attributes(const SessionInfo& info);
  void flush();
  void write_column(const ColumnInfo& column, std::uint64_t count);
  void write_changes();
  void abandon();
  template <class Work>
  void guarded(Work work);

  std::filesystem::path path_;
  RowLayout layout_;
  std::uint64_t chunk_rows_;
  std::uint64_t flushed_rows_ = 0;
  std::uint64_t flushed_changes_ = 0;
  std::vector<double> pending_;         // rows of the chunk that is not full yet
  std::vector<SettingChange> changes_;  // not written yet
  std::vector<double> numbers_;         // one column of that chunk
  std::vector<std::uint8_t> bytes_;
  hdf5::File file_;
  std::array<hdf5::Dataset, kColumns> columns_;
  hdf5::Dataset event_row_;
  hdf5::Dataset event_setting_;
};

}  // namespace limpid
