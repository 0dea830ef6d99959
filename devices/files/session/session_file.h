// One HDF5 session file being written, wherever it lies. SessionWriter adds where it may lie and
// what it is called when done.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "devices/files/session/hdf5_handles.h"
#include "devices/files/session/session.h"

namespace limpid {

// Names and sizes that writer and reader agree on.
inline constexpr const char* kSessionFormat = "limpid-session";
inline constexpr int kSessionVersion = 1;
inline constexpr std::size_t kSettingLength = 120;
inline constexpr const char* kEventRowPath = "/events/row";
inline constexpr const char* kEventSettingPath = "/events/setting";

// What a row reads as that was announced but never written, in recordings of the first edition: a
// not-a-number that no arithmetic makes.
inline constexpr std::uint64_t kNeverWritten = 0x7ff8'6c69'6d70'6964;

inline std::size_t column_index(Column c) { return static_cast<std::size_t>(c); }

// A file that survives being killed, by HDF5's rules (single writer, multiple readers: everything
// is created before writing starts) and two of its own. HDF5 rewrites some things in place: how
// long a column is, where its chunks lie. The kernel may cut such a write short where one page of
// memory ends and the next begins; so each of them must lie within a page. And rows go straight
// behind those that are there, without a filter, so that nothing that was written is ever written
// again.
//
// The list of where a column's chunks lie grows in blocks, which outgrow a page from chunk 8176 on.
// A chunk therefore holds eight seconds of ticks, sixteen times what is written at once: a
// recording may last 18 hours.
//
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
  void create_check();
  void create_column(const ColumnInfo& column);
  void create_events();
  void flush();
  void write_column(const ColumnInfo& column, std::uint64_t count);
  void write_changes();
  void write_check();
  void abandon();
  template <class Work>
  void guarded(Work work);

  std::filesystem::path path_;
  RowLayout layout_;
  std::uint64_t block_rows_;  // that are written at once
  std::uint64_t flushed_rows_ = 0;
  std::uint64_t flushed_changes_ = 0;
  std::uint64_t flushed_sums_ = 0;
  std::vector<double> pending_;         // rows of the block that is not full yet
  std::vector<SettingChange> changes_;  // not written yet
  std::vector<double> numbers_;         // one column of that block
  std::vector<std::uint8_t> bytes_;
  hdf5::File file_;
  std::array<hdf5::Dataset, kColumns> columns_;
  hdf5::Dataset event_row_;
  hdf5::Dataset event_setting_;
  hdf5::Dataset sums_;
};

}  // namespace limpid
