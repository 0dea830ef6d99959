// The way to one HID device: reports in and out.
//
// A report always begins with the byte of its id, which is 0 where the device numbers none; sizes
// count that byte.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace limpid {

class HidTransport {
 public:
  // No report of the kernel's is longer.
  static constexpr std::size_t kMaxReport = 4096 + 1;

  virtual ~HidTransport() = default;

  // The next input report, waiting for it at most so long: its size; 0 if none came; -1 if the
  // device is lost.
  virtual int read(std::span<std::uint8_t> report, int timeout_ms) noexcept = 0;
  // Sends an output report; false if it did not get through.
  virtual bool write(std::span<const std::uint8_t> report) noexcept = 0;

  // Asks for the feature or input report whose id is report[0]: its size, or -1.
  virtual int get_feature(std::span<std::uint8_t> report) noexcept = 0;
  virtual int get_input(std::span<std::uint8_t> report) noexcept = 0;
  virtual bool set_feature(std::span<const std::uint8_t> report) noexcept = 0;

  virtual const std::vector<std::uint8_t>& report_descriptor() const = 0;
};

}  // namespace limpid
