// Any bytes at all from a device: readings that are finite and within the device's range, or none.
//
// The input is a row of reports, each after a byte that says its length. One in two goes to the raw
// protocol with its CRC put right, or nothing would get past that: once as reports of version 1,
// once as those of version 2, the first of which describes the device.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "devices/hid/hid_exchange.h"
#include "devices/hid/hid_transport.h"
#include "devices/hid/pid_joystick.h"
#include "devices/hid/raw_protocol.h"
#include "devices/hid/space_mouse.h"
#include "tests/support/fake_hid.h"
#include "tests/support/hid_descriptors.h"
#include "tests/support/raw_reports.h"

namespace {

using namespace limpid;
using Reports = std::vector<Report>;

void demand(bool holds) {
  if (!holds) std::abort();
}

Reports cut(std::span<const std::uint8_t> bytes) {
  Reports reports;
  while (!bytes.empty()) {
    const std::size_t size = std::min<std::size_t>(bytes[0], bytes.size() - 1);
    const auto report = bytes.subspan(1, size);
    reports.emplace_back(report.begin(), report.end());
    bytes = bytes.subspan(1 + size);
  }
  return reports;
}

// `first`, `size`: of the first report, of the others.
void seal_every_other(Reports& reports, std::size_t first, std::size_t size) {
  for (std::size_t i = 0; i < reports.size(); i += 2) {
    reports[i].resize(i == 0 ? first : size);
    seal_raw_report(reports[i]);
  }
}

// A device whose features come from the first report.
std::shared_ptr<test::FakeHid> device_with(const Reports& reports) {
  auto device = std::make_shared<test::FakeHid>();
  device->features[6] = {6, 1, 1, 0, 0};
  if (!reports.empty()) device->features[0] = reports[0];
  for (const Report& report : reports) device->send(report);
  return device;
}

void live(HidProtocol& protocol, const Reports& reports, double most) {
  const auto device = device_with(reports);
  test::FakeTransport transport(device);
  protocol.open(transport);
  nanoseconds now{};
  HidExchange exchange(transport, protocol, [&] { return now; });
  const auto& traits = protocol.traits();
  const std::vector<double> torque(static_cast<std::size_t>(traits.dof), 1e6);
  for (std::size_t i = 0; i < 1 + reports.size() / 64; ++i) {
    exchange.write(torque);
    exchange.step();
    DeviceReading reading;
    exchange.read(reading);
    for (const double x : reading.x) demand(std::isfinite(x) && std::abs(x) <= most);
    now += std::chrono::milliseconds(1);
  }
  demand(traits.pushes == !traits.effort.empty());
  exchange.finish();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  static const ReportDescriptor mouse = parse_report_descriptor(test::space_navigator());
  static const ReportDescriptor stick = parse_report_descriptor(test::pid_joystick::whole());
  Reports reports = cut({data, size});
  SpaceMouse space_mouse(mouse);
  live(space_mouse, reports, 1);
  PidJoystick joystick(stick);
  live(joystick, reports, PidSettings{}.range);
  Reports of_2 = reports;
  seal_every_other(reports, RawProtocol::kReportSize, RawProtocol::kReportSize);
  try {
    RawProtocol raw;
    live(raw, reports, 3.5e38);
  } catch (const HidError&) {
  }
  seal_every_other(of_2, RawProtocol::kFeature2Size, RawProtocol::kReading2Size);
  try {
    RawProtocol raw;
    live(raw, of_2, 1.2 * 2 * 100);  // the widest range, and a tenth of it
  } catch (const HidError&) {
  }
  return 0;
}
