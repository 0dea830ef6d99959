#include "devices/hid/hidapi_transport.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <hidapi/hidapi.h>
#include <linux/hidraw.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "devices/hid/hid_error.h"
#include "devices/hid/report_descriptor.h"

namespace limpid {
namespace {

[[noreturn]] void refuse(const std::string& path) {
  throw HidError(fmt::format("{}: {}", path, std::strerror(errno)));
}

// hidapi 0.13 has no call for it.
std::vector<std::uint8_t> read_descriptor(const std::string& path) {
  const int file = open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (file < 0) refuse(path);
  int size = 0;
  hidraw_report_descriptor descriptor{};
  bool got = ioctl(file, HIDIOCGRDESCSIZE, &size) >= 0;
  if (got) {
    descriptor.size = static_cast<std::uint32_t>(std::clamp(size, 0, HID_MAX_DESCRIPTOR_SIZE));
    got = ioctl(file, HIDIOCGRDESC, &descriptor) >= 0;
  }
  const int error = errno;
  close(file);
  errno = error;
  if (!got) refuse(path);
  return {descriptor.value, descriptor.value + descriptor.size};
}

struct CloseHid {
  void operator()(hid_device* device) const { hid_close(device); }
};

class HidapiTransport final : public HidTransport {
 public:
  explicit HidapiTransport(const std::string& path)
      : descriptor_(read_descriptor(path)),
        numbered_(parse_report_descriptor(descriptor_).numbered),
        device_(hid_open_path(path.c_str())) {
    if (!device_) refuse(path);
  }

  int read(std::span<std::uint8_t> report, int timeout_ms) noexcept override {
    // The kernel gives no id where there are none.
    const std::size_t skipped = numbered_ ? 0 : 1;
    if (report.size() <= skipped) return 0;
    if (!numbered_) report[0] = 0;
    const int size = hid_read_timeout(device_.get(), report.data() + skipped,
                                      report.size() - skipped, timeout_ms);
    return size > 0 ? size + static_cast<int>(skipped) : size;
  }

  bool write(std::span<const std::uint8_t> report) noexcept override {
    return hid_write(device_.get(), report.data(), report.size()) >= 0;
  }

  int get_feature(std::span<std::uint8_t> report) noexcept override {
    return hid_get_feature_report(device_.get(), report.data(), report.size());
  }

  int get_input(std::span<std::uint8_t> report) noexcept override {
    return hid_get_input_report(device_.get(), report.data(), report.size());
  }

  bool set_feature(std::span<const std::uint8_t> report) noexcept override {
    return hid_send_feature_report(device_.get(), report.data(), report.size()) >= 0;
  }

  const std::vector<std::uint8_t>& report_descriptor() const override { return descriptor_; }

 private:
  std::vector<std::uint8_t> descriptor_;
  bool numbered_;
  std::unique_ptr<hid_device, CloseHid> device_;
};

}  // namespace

std::unique_ptr<HidTransport> open_hidraw(const std::string& path) {
  return std::make_unique<HidapiTransport>(path);
}

}  // namespace limpid
