// The names a session file goes through, and who may write there.
#pragma once

#include <filesystem>

#include "devices/files/session/session.h"

namespace limpid {

// OUT.h5 -> OUT.h5.part and back. Errors: FileError if the name does not end in .part.
std::filesystem::path part_of(const std::filesystem::path& out);
std::filesystem::path recovered_name(const std::filesystem::path& part);

// Whether `out` may be written, before anything is. Errors: FileError.
void check_place(const std::filesystem::path& out, bool force);

// Tick and number of joints. Errors: FileError naming `file`.
void check_session_info(const SessionInfo& info, const std::filesystem::path& file);

// Brings a finished file to the disk and gives it its name. Errors: FileError.
void publish(const std::filesystem::path& finished, const std::filesystem::path& out, bool force);

// Tells a recording that is running from one that was killed: held while writing, gone with the
// process. Errors: FileError if the file cannot be opened, or somebody else holds it.
class WriteLock {
 public:
  enum class Make { no, yes };  // the file, if it is not there
  WriteLock(const std::filesystem::path& file, Make make);
  ~WriteLock();
  WriteLock(const WriteLock&) = delete;
  WriteLock& operator=(const WriteLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace limpid
