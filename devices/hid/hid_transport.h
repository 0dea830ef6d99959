// What is wrong with a HID device, in one line for people.
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace limpid {

struct HidError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The way to one device that speaks in HID reports: they come in and go out.
//
// A report always begins with the byte of its id, which is 0 where the device numbers none; sizes
// count that byte.
using Report = std::vector<std::uint8_t>;

// How a process that has nothing else can still say something: the descriptor, its own, and what it
// writes there. None: -1.
struct LastWords {
  int descriptor = -1;
  std::vector<Report> bytes;
};

class HidTransport {
 public:
  // No report of the kernel's is longer,
  static constexpr std::size_t kMaxReport = 4096 + 1;
  // and no message that takes the place of one.
  static constexpr std::size_t kMaxMessage = 32 * 1024;

  virtual ~HidTransport() = default;

  // The next input report, waiting for it at most so long: its size; 0 if none came; -1 if the
  // device is lost.
  virtual int read(std::span<std::uint8_t> report, int timeout_ms) noexcept = 0;
  // Sends an output report; false if it did not get through.
  virtual bool write(std::span<const std::uint8_t> report) noexcept = 0;

  // Asks for the feature report whose id is report[0]: its size, or -1. May take seconds.
  virtual int get_feature(std::span<std::uint8_t> report) noexcept = 0;
  virtual bool set_feature(std::span<const std::uint8_t> report) noexcept = 0;

  // Asks for an input report, given empty but for its id. Does not wait: the answer, if there ever
  // is one, comes as one of read()'s. Asking again meanwhile changes nothing.
  virtual void ask(std::span<const std::uint8_t> question) noexcept = 0;

  // For a guardian, where the end of this process does not itself take the force away: these
  // reports over the same connection.
  virtual LastWords last_words(std::span<const Report>) { return {}; }

  virtual const std::vector<std::uint8_t>& report_descriptor() const = 0;
  // USB's number for the maker; 0 where there is none.
  virtual std::uint16_t vendor() const { return 0; }
  // "vendor:product[:serial]", as the list of devices has it; empty: not known.
  virtual std::string id() const { return {}; }
};

}  // namespace limpid
