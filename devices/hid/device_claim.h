// One owner a device, on the whole computer.
//
// Whoever wants to use a device takes its claim before anything is opened or sent. A claim is a
// lock on a file that the programs of all users find in the same place. The kernel lets go of it
// once the last process that has it open ends: the program itself, or the guardian that still has
// to send its stop. The file stays; it says who took the lock last.
//
// A container may have such a place of its own and share the devices: the node of a device itself
// is locked besides.
#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace limpid {

// The first of these folders in which every user may make files. Throws HidError if none is one.
std::filesystem::path claim_folder();
std::filesystem::path claim_folder(std::span<const std::filesystem::path> among);

class DeviceClaim {
 public:
  DeviceClaim() = default;  // of nothing
  // `key` names the physical thing, not how it is remembered. Throws HidError that says who has it,
  // or why nobody can tell.
  explicit DeviceClaim(const std::string& key,
                       const std::filesystem::path& folder = claim_folder());
  // Claims the device's node itself, by whatever name it is known. Throws HidError: another program
  // has it, or it cannot be opened.
  static DeviceClaim on_node(const std::filesystem::path& node);
  DeviceClaim(DeviceClaim&& other) noexcept;
  DeviceClaim& operator=(DeviceClaim&& other) noexcept;
  ~DeviceClaim();

  bool held() const { return file_ >= 0; }
  // For a process that shall keep the claim as long as it lives; -1: of nothing.
  int descriptor() const { return file_; }

 private:
  void release() noexcept;

  int file_ = -1;
};

// Who has it, for people, as "process 1234 (limpid run --live), since 2026-11-23 16:05"; empty if
// nobody has, or this process itself.
std::string claimed_by(const std::string& key,
                       const std::filesystem::path& folder = claim_folder());

}  // namespace limpid
