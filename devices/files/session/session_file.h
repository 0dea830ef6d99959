// HDF5 session file that is being written, wherever it lies. SessionWriter adds where it may lie,
// and its name when it is complete.
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

// Writes the attributes of the `root` group: what the file says of itself and of its input. Errors:
// FileError naming `file`.
void write_attributes(hid_t root, const SessionInfo& info, const std::filesystem::path& file);

// Writes a scene's models before the first row: /models/0, /models/1, ... as bytes. Each has its
// name in the scene's text as the attribute "name". Errors: FileError.
void write_models(hid_t root, const SceneFiles& models, const std::filesystem::path& file);

// Reads the models, if a session has some. Errors: FileError for what is no such dataset or claims
// more than a file of this size can hold.
SceneFiles read_models(hid_t root, const std::filesystem::path& file, hdf5::Claims& claims);

// A file that survives being killed, by HDF5's rules (single writer, multiple readers: everything
// is created before writing starts) and one of its own. HDF5 rewrites some things in place: lengths
// of columns, places of their chunks. The kernel may cut such a write short at the end of a page of
// memory; therefore each lies within a page.
//
// A packed file does not survive that until it is closed.
//
// Errors: FileError naming `path`. After one, the file stays as the last flush left it, and takes
// nothing more.
class SessionFile {
 public:
  // `descriptor` is of an empty file, open for reading and writing as long as this lives.
  SessionFile(std::filesystem::path path, int descriptor, const SessionInfo& info, Storage storage);
  ~SessionFile();  // without close(): the file stays as the last flush left it
  SessionFile(const SessionFile&) = delete;
  SessionFile& operator=(const SessionFile&) = delete;

  void append(std::span<const double> rows, std::size_t lane = kMainLane);
  void append(const SettingChange& change, std::size_t lane = kMainLane);
  void append(const Mark& mark);
  void append_world(std::span<const double> world, std::size_t lane);
  // Writes everything pending and closes for good. `warnings` are as for SessionWriter.
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
