// Recordings that were cut off, and who may write one.
#pragma once

#include <chrono>
#include <filesystem>

#include "devices/files/session/session.h"

namespace limpid {

// OUT.h5.part -> OUT.h5. Errors: FileError if the name does not end in .part.
std::filesystem::path recovered_name(const std::filesystem::path& part);

// Tick and number of joints. Errors: FileError naming `file`.
void check_session_info(const SessionInfo& info, const std::filesystem::path& file);

// Tells a recording that is running from one that was killed, and keeps programs that change one
// recording apart: held while writing, gone with the process. Errors: FileError if the file cannot
// be opened, is a link, or somebody else still holds it after so long. Where the file system has no
// locks nobody is kept out.
class WriteLock {
 public:
  enum class Make { no, yes };  // the file, if it is not there
  WriteLock(const std::filesystem::path& file, Make make, std::chrono::milliseconds patience = {});
  ~WriteLock();
  WriteLock(const WriteLock&) = delete;
  WriteLock& operator=(const WriteLock&) = delete;

  int descriptor() const { return descriptor_; }  // for reading and writing
  bool held() const { return held_; }             // false: there are no locks

 private:
  int descriptor_;
  bool held_ = false;
};

}  // namespace limpid
