// Fuzzes report descriptors: any bytes give fields that lie inside their reports, or an error of
// one line. The devices must also cope with the fields.
#include <array>
#include <cstdlib>
#include <memory>
#include <utility>

#include "devices/hid/hid_transport.h"
#include "devices/hid/pid_joystick.h"
#include "devices/hid/report_descriptor.h"
#include "devices/hid/space_mouse.h"

namespace {

using namespace limpid;

void demand(bool holds) {
  if (!holds) std::abort();
}

void check(const ReportDescriptor& descriptor) {
  for (const ReportField& field : descriptor.fields) {
    const std::size_t bytes = descriptor.report_bytes(field.kind, field.report_id);
    demand(field.bit_size >= 1 && field.bit_size <= 32 && field.count >= 1);
    demand(field.bit_offset >= 8 && bytes <= HidTransport::kMaxReport);
    demand(field.bit_offset + std::uint64_t{field.count} * field.bit_size <= 8 * bytes);
    demand((field.report_id != 0) == descriptor.numbered);
    Report report(bytes);
    const auto value = get_field(report, field, field.count - 1);
    demand(value == 0 && put_field(report, field, *value, field.count - 1));
  }
}

// Answers every question with the same bytes.
class AnyDevice final : public HidTransport {
 public:
  int read(std::span<std::uint8_t>, int) noexcept override { return 0; }
  bool write(std::span<const std::uint8_t> report) noexcept override {
    demand(!report.empty());
    return true;
  }
  int get_feature(std::span<std::uint8_t> report) noexcept override {
    for (std::size_t i = 1; i < report.size(); ++i) report[i] = 1;
    return static_cast<int>(report.size());
  }
  void ask(std::span<const std::uint8_t>) noexcept override {}
  bool set_feature(std::span<const std::uint8_t>) noexcept override { return true; }
  const std::vector<std::uint8_t>& report_descriptor() const override { return none_; }

 private:
  std::vector<std::uint8_t> none_;
};

template <class Protocol>
void live(const ReportDescriptor& descriptor) {
  try {
    Protocol protocol(descriptor);
    AnyDevice device;
    protocol.open(device);
    DeviceReading reading;
    for (const std::size_t size : {0u, 1u, 7u, 64u, 300u}) {
      for (int id = 0; id < 8; ++id) {
        Report report(size, 0xA5);
        if (size > 0) report[0] = static_cast<std::uint8_t>(id);
        protocol.decode(report, reading);
      }
    }
    const std::array<double, 6> torque{0.5, -0.25, 0, 0, 0, 0};
    const auto dof = static_cast<std::size_t>(protocol.traits().dof);
    protocol.encode(std::span(torque).first(dof), {}, [](auto report) { demand(!report.empty()); });
  } catch (const HidError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  try {
    const ReportDescriptor descriptor = parse_report_descriptor({data, size});
    check(descriptor);
    if (SpaceMouse::describes(descriptor)) live<SpaceMouse>(descriptor);
    if (PidJoystick::describes(descriptor)) live<PidJoystick>(descriptor);
  } catch (const HidError&) {
  }
  return 0;
}
