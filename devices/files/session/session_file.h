// One HDF5 session file being written, wherever it lies. SessionWriter adds where it may lie and
// what it is called when done.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "devices/files/scene_files.h"
#include "devices/files/session/hdf5_reading.h"
#include "devices/files/session/session.h"
#include "devices/files/session/session_lane.h"
#include "devices/files/session/session_marks.h"

namespace limpid {

// What a session file says of itself and of its input, beside the rows.

// Writes the attributes of the `root` group. Errors: FileError naming `file`.
void write_attributes(hid_t root, const SessionInfo& info, const std::filesystem::path& file);

// The models of a scene inside a session file: /models/0, /models/1, ... as bytes, each with the
// name that the scene's text has for it as the attribute "name".

// Before the first row. Errors: FileError.
void write_models(hid_t root, const SceneFiles& models, const std::filesystem::path& file);

// None in a session that has none. Errors: FileError for what is no such dataset or claims more
// than a file of this size can hold.
SceneFiles read_models(hid_t root, const std::filesystem::path& file, hdf5::Claims& claims);

// A file that survives being killed, by HDF5's rules (single writer, multiple readers: everything
// is created before writing starts) and one of its own. HDF5 rewrites some things in place: how
// long a column is, where its chunks lie. The kernel may cut such a write short where one page of
// memory ends and the next begins; so each of them must lie within a page.
//
// A packed file has none of this until it is closed.
//
// Errors: FileError naming `path`. After one, the file stays as the last flush left it and takes
// nothing more.
class SessionFile {
 public:
  // `descriptor`: of an empty file, open for reading and writing for as long as this is.
  SessionFile(std::filesystem::path path, int descriptor, const SessionInfo& info, Storage storage);
  ~SessionFile();  // without close(): the file stays as the last flush left it
  SessionFile(const SessionFile&) = delete;
  SessionFile& operator=(const SessionFile&) = delete;

  void append(std::span<const double> rows, std::size_t lane = kMainLane);
  void append(const SettingChange& change, std::size_t lane = kMainLane);
  void append(const Mark& mark);
  void append_world(std::span<const double> world, std::size_t lane);
  // Writes what is pending and closes for good. `warnings`: as SessionWriter has them.
  void close(const std::string& warnings = {});
  std::uint64_t rows() const { return lanes_.front().rows(); }

 private:
  void create(const SessionInfo& info);
  void abandon();
  void write_warnings(const std::string& warnings);
  template <class Work>
  void guarded(Work work);

  std::filesystem::path path_;
  int descriptor_;
  Storage storage_;
  RowLayout layout_;
  std::vector<SessionLane> lanes_;
  MarkTable marks_;
  hdf5::File file_;
  bool starting_ = false;
};

}  // namespace limpid
