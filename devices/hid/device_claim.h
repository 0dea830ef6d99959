// Claim of a device: one owner a device, on the whole computer.
//
// A program takes a device's claim before it opens or sends anything. A claim is a lock on a file
// that the programs of all users find in the same place. The kernel releases it once the last
// process that has it open ends: the program itself, or the guardian that still has to send its
// stop. The file stays, and says who took the lock last.
//
// A container may have a place of its own for these files and share the devices. Therefore a
// device's node is locked, too.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "devices/hid/hid_transport.h"

namespace limpid {

// Thrown if another program has a claim; what() says which.
struct ClaimTaken : HidError {
  using HidError::HidError;
};

// Returns the first of some folders in which every user may make files. Throws HidError if there is
// none.
std::filesystem::path claim_folder();
std::filesystem::path claim_folder(std::span<const std::filesystem::path> among);

class DeviceClaim {
 public:
  DeviceClaim() = default;  // of no device
  // `key` names the physical device, not its entry in a list. Throws ClaimTaken if another program
  // has the device, or HidError that says why nobody can tell.
  explicit DeviceClaim(const std::string& key,
                       const std::filesystem::path& folder = claim_folder());
  // Claims the device's node itself, by whatever name it is known. Throws ClaimTaken if another
  // program has it, or HidError if it cannot be opened or locked.
  static DeviceClaim on_node(const std::filesystem::path& node);
  DeviceClaim(DeviceClaim&& other) noexcept;
  DeviceClaim& operator=(DeviceClaim&& other) noexcept;
  ~DeviceClaim();

  bool held() const { return file_ >= 0; }
  // Descriptor for a process that shall keep the claim as long as it lives; -1: of no device.
  int descriptor() const { return file_; }

 private:
  void release() noexcept;

  int file_ = -1;
};

// Key of a device of a maker's library, for Limpid and for the program that drives it.
inline std::string vendor_claim_key(const std::string& back_end, const std::string& name) {
  return "vendor:" + back_end + ":" + name;
}

// The process that has a device, for people, as "process 1234 (limpid run --live), since 2026-11-23
// 16:05"; empty if none has, or this one.
std::string claimed_by(const std::string& key,
                       const std::filesystem::path& folder = claim_folder());

}  // namespace limpid
