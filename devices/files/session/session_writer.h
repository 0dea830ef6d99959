// Recordings that were cut off, and who may write one.
#pragma once

#include <filesystem>

#include "devices/files/session/session.h"

namespace limpid {

// OUT.h5.part -> OUT.h5. Errors: FileError if the name does not end in .part.
std::filesystem::path recovered_name(const std::filesystem::path& part);

// Tick and number of joints. Errors: FileError naming `file`.
void check_session_info(const SessionInfo& info, const std::filesystem::path& file);

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
