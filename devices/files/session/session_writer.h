// Recovery of recordings that were cut off, and the lock of those being written.
#pragma once

#include <chrono>
#include <filesystem>

#include "devices/files/session/session.h"

namespace limpid {

// The path OUT.h5 for OUT.h5.part. Errors: FileError if the name does not end in .part.
std::filesystem::path recovered_name(const std::filesystem::path& part);

// Checks tick and number of joints. Errors: FileError naming `file`.
void check_session_info(const SessionInfo& info, const std::filesystem::path& file);

// Lock of a recording while it is written or changed; gone with the process. It tells a running
// recording from one that was killed, and keeps programs that change one apart. Errors: FileError
// if the file cannot be opened, is a link, or somebody else still holds the lock after `patience`.
// A file system without locks keeps nobody out.
class WriteLock {
 public:
  enum class Make { no, yes };  // make the file if it does not exist
  WriteLock(const std::filesystem::path& file, Make make, std::chrono::milliseconds patience = {});
  ~WriteLock();
  WriteLock(const WriteLock&) = delete;
  WriteLock& operator=(const WriteLock&) = delete;

  int descriptor() const { return descriptor_; }  // for reading and writing
  bool held() const { return held_; }             // false: the file system has no locks

 private:
  int descriptor_;
  bool held_ = false;
};

}  // namespace limpid
