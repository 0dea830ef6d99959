// Way to one device that speaks in HID reports: they come in and go out.
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace limpid {

// Error of a HID device, in one line for people.
struct HidError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A report, which begins with the byte of its id: 0 if the device numbers none. Sizes count that
// byte.
using Report = std::vector<std::uint8_t>;

// A descriptor, and bytes that a process with nothing else can write there to stop a device. The
// receiver owns the descriptor; -1: none.
struct LastWords {
  int descriptor = -1;
  std::vector<Report> bytes;
};

class HidTransport {
 public:
  // Longest report of the kernel.
  static constexpr std::size_t kMaxReport = 4096 + 1;
  // Longest message in place of a report.
  static constexpr std::size_t kMaxMessage = 32 * 1024;

  virtual ~HidTransport() = default;

  // Reads the next input report, waiting for it at most `timeout_ms`. Returns its size; 0 if none
  // came; -1 if the device is lost.
  virtual int read(std::span<std::uint8_t> report, int timeout_ms) noexcept = 0;
  // Sends an output report; false if it did not get through.
  virtual bool write(std::span<const std::uint8_t> report) noexcept = 0;

  // Asks for the feature report whose id is report[0]. Returns its size, or -1. May take seconds.
  virtual int get_feature(std::span<std::uint8_t> report) noexcept = 0;
  virtual bool set_feature(std::span<const std::uint8_t> report) noexcept = 0;

  // Asks for an input report, given with its id alone. Does not wait: the answer, if there is one,
  // comes from read(). Asking again meanwhile changes nothing.
  virtual void ask(std::span<const std::uint8_t> question) noexcept = 0;

  // Gives a guardian these reports over the same connection, if the end of this process does not
  // itself take the force away.
  virtual LastWords last_words(std::span<const Report>) { return {}; }

  virtual const std::vector<std::uint8_t>& report_descriptor() const = 0;
  // USB's number for the maker; 0 if there is none.
  virtual std::uint16_t vendor() const { return 0; }
  // "vendor:product[:serial]", as in the list of devices; empty: not known.
  virtual std::string id() const { return {}; }
};

}  // namespace limpid
