// Proof that the virtual machine and the reference devices do what tests rely on: each device is
// found through hidapi, read and written for a second at 1 kHz, pulled out, and found again. Prints
// the measurements; exit status 1 if a promise is broken.
#include <hidapi/hidapi.h>
#include <sys/prctl.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <memory>

#include "tests/support/hid/pid_joystick_model.h"
#include "tests/support/hid/raw_device_model.h"
#include "tests/support/hid/space_mouse_model.h"
#include "tests/support/hid/uhid_device.h"

namespace {

using namespace limpid::test;
using namespace std::chrono_literals;

bool all_kept = true;

void promise(bool kept, const char* what) {
  std::printf("  %s %s\n", kept ? "ok    " : "BROKEN", what);
  all_kept = all_kept && kept;
}

double milliseconds(Time time) { return std::chrono::duration<double, std::milli>(time).count(); }

using Handle = std::unique_ptr<hid_device, decltype(&hid_close)>;

// Opens the device as a program does: by enumeration.
Handle open_device(const HidIdentity& identity) {
  hid_device_info* const list = hid_enumerate(identity.vendor, identity.product);
  std::string path;
  if (list) {
    std::printf("  %s: %ls, serial %ls, usage %04x:%04x\n", list->path, list->product_string,
                list->serial_number, list->usage_page, list->usage);
    path = list->path;
  }
  hid_free_enumeration(list);
  return {path.empty() ? nullptr : hid_open_path(path.c_str()), &hid_close};
}

struct Traffic {
  int read = 0, written = 0, write_failures = 0;
  Time longest_gap{};
};

// Discards waiting reports, then reads for a second and sends the result of `answer` for each
// report, if any.
Traffic talk(hid_device* device, const std::function<Report(ReportView)>& answer) {
  std::array<std::uint8_t, 128> old{};
  while (hid_read_timeout(device, old.data(), old.size(), 0) > 0) {
  }
  Traffic traffic;
  const Time end = steady_now() + 1s;
  for (Time before = steady_now(); before < end;) {
    std::array<std::uint8_t, 128> buffer{};
    const int size = hid_read_timeout(device, buffer.data(), buffer.size(), 100);
    if (size <= 0) return traffic;
    ++traffic.read;
    const Time now = steady_now();
    traffic.longest_gap = std::max(traffic.longest_gap, now - before);
    before = now;
    const Report out = answer(std::span(buffer).first(static_cast<std::size_t>(size)));
    if (out.empty()) continue;
    const bool sent = hid_write(device, out.data(), out.size()) >= 0;
    ++(sent ? traffic.written : traffic.write_failures);
  }
  return traffic;
}

void print(const Traffic& traffic, UhidDevice& device) {
  const UhidCounts counts = device.counts();
  std::printf("  %d reports read in 1 s, longest gap %.3f ms; %d written, %d failed\n",
              traffic.read, milliseconds(traffic.longest_gap), traffic.written,
              traffic.write_failures);
  std::printf("  the device: %d sent, %d periods missed, at most %.3f ms late\n", counts.sent,
              counts.missed, milliseconds(counts.latest));
  promise(counts.missed <= 2, "hardly a period missed");
}

void pull_out_and_in(UhidDevice& device, Handle& handle, const HidIdentity& identity) {
  device.unplug();
  std::array<std::uint8_t, 128> buffer{};
  int left = 0;
  while (left < 1000 && hid_read_timeout(handle.get(), buffer.data(), buffer.size(), 100) > 0) {
    ++left;
  }
  promise(hid_read_timeout(handle.get(), buffer.data(), buffer.size(), 100) < 0,
          "reading fails when it is pulled out");
  promise(hid_write(handle.get(), buffer.data(), 64) < 0, "so does writing");
  device.replug();
  handle = open_device(identity);
  promise(handle && hid_read_timeout(handle.get(), buffer.data(), buffer.size(), 100) > 0,
          "reading goes on when it is plugged in again");
}

void probe_space_mouse() {
  std::puts("SpaceMouse");
  SpaceMouseModel model;
  model.move([](double t) { return SpaceMouseModel::Cap{std::sin(6 * t), 0, 0, 0, 0, 0.5}; });
  UhidDevice device(model);
  Handle handle = open_device(model.identity());
  if (!handle) return promise(false, "found");
  int largest = 0;
  const Traffic traffic = talk(handle.get(), [&](ReportView report) {
    if (report[0] == 1) largest = std::max<int>(largest, read_at<std::int16_t>(report, 1));
    return Report{};
  });
  print(traffic, device);
  promise(std::abs(traffic.read - 2000) <= 4, "two reports every millisecond");
  promise(largest == SpaceMouseModel::kFullScale, "the cap's whole way");
  pull_out_and_in(device, handle, model.identity());
}

// Pushes with a constant force from the west, for 20 ms at a time; most firmwares push towards
// positive X then.
class PidHost {
 public:
  PidHost(hid_device* device, const PidLayout& layout)
      : device_(device), reports_(pid_reports(layout)) {
    constexpr std::uint8_t kConstantForce = 0x26;
    const auto& types = layout.effect_types;
    type_ = std::ranges::find(types, kConstantForce) - types.begin() + 1;
  }

  bool begin() {
    Report create = blank(Kind::feature, reports_.create_type->id);
    put(create, *reports_.create_type, type_);
    if (hid_send_feature_report(device_, create.data(), create.size()) < 0) return false;
    Report load = blank(Kind::feature, reports_.load_index.id);
    if (hid_get_feature_report(device_, load.data(), load.size()) < 0) return false;
    index_ = get(load, reports_.load_index);
    Report control = blank(Kind::output, reports_.control.id);
    put(control, reports_.control, 1);
    Report effect = blank(Kind::output, reports_.effect_index.id);
    put(effect, reports_.effect_index, index_);
    put(effect, reports_.effect_type, type_);
    put(effect, reports_.duration, 20);
    put(effect, reports_.gain, reports_.gain.max);
    put(effect, reports_.direction_enable, 1);
    put(effect, reports_.direction, std::lround(0.75 * reports_.direction.max));
    return get(load, reports_.load_status) == 1 && send(effect) && send(control);
  }
  Report half_force() const {
    Report report = blank(Kind::output, reports_.constant_index.id);
    put(report, reports_.constant_index, index_);
    put(report, reports_.magnitude, std::lround(0.5 * reports_.magnitude.max));
    return report;
  }
  bool start() {
    Report report = blank(Kind::output, reports_.operation.id);
    put(report, reports_.operation_index, index_);
    put(report, reports_.operation, 1);
    put(report, reports_.loops, 1);
    return send(report);
  }
  double stick(ReportView report) const {
    return static_cast<double>(get(report, reports_.x)) / reports_.x.max;
  }
  bool is_stick(ReportView report) const { return report[0] == reports_.x.id; }

 private:
  using Kind = DescriptorWriter::Kind;
  Report blank(Kind kind, std::uint8_t id) const { return reports_.writer.blank(kind, id); }
  bool send(const Report& report) { return hid_write(device_, report.data(), report.size()) >= 0; }

  hid_device* device_;
  PidReports reports_;
  std::int64_t index_ = 0, type_ = 0;
};

void probe_pid_joystick(const char* title, const PidJoystickOptions& options) {
  std::puts(title);
  const PidLayout& layout = options.layout;
  PidJoystickModel model(options);
  UhidDevice device(model);
  Handle handle = open_device(model.identity());
  if (!handle) return promise(false, "found");
  PidHost host(handle.get(), layout);
  promise(host.begin(), "features and outputs are taken");
  double x = 0;
  int count = 0;
  const Traffic traffic = talk(handle.get(), [&](ReportView report) {
    if (!host.is_stick(report)) return Report{};
    x = host.stick(report);
    if (++count % 10 == 1) host.start();
    return host.half_force();
  });
  const Time silent = steady_now();
  print(traffic, device);
  promise(std::abs(traffic.written - 1000) <= 2, "a force every millisecond");
  std::this_thread::sleep_for(50ms);
  const auto [zero, largest, problems] = device.with([&](Time) {
    return std::tuple(model.forces().zero_after(silent), model.forces().largest(),
                      model.violations().size());
  });
  // The hand yields by torque over stiffness.
  const bool reversed = options.firmware == PidFirmware::arduino;
  const double sign = reversed ? -1 : 1;
  const double expected = sign * options.torque_limit / 2 / options.physics.stiffness;
  std::printf("  stick at %.4f rad, expected %.4f; force at most %.3f N m; zero %.1f ms after\n",
              x * options.physics.upper, expected, largest, zero ? milliseconds(*zero) : NAN);
  promise(std::abs(x * options.physics.upper - expected) < 2e-3, "the stick gives way");
  promise(zero && *zero <= 21ms, "the force ends by itself");
  promise(problems == 0, "nothing against the protocol");
  pull_out_and_in(device, handle, model.identity());
}

Report raw_command(std::uint32_t sequence, ReportView reading, float torque) {
  Report report(64);
  report[0] = 0x4C;
  report[1] = 1;
  report[2] = reading[2];
  report[3] = 1;
  write_at(report, 4, sequence);
  write_at(report, 8, read_at<std::uint64_t>(reading, 8));
  write_at(report, 16, torque);
  write_at(report, 40, read_at<std::uint32_t>(reading, 4));
  write_at(report, 60, crc32_of(std::span(report).first(60)));
  report.insert(report.begin(), 0);
  return report;
}

void probe_raw_device() {
  std::puts("Raw device");
  const RawDeviceLayout layout;
  RawDeviceModel model(layout);
  UhidDevice device(model);
  Handle handle = open_device(model.identity());
  if (!handle) return promise(false, "found");
  Report about(65);
  const int size = hid_get_feature_report(handle.get(), about.data(), about.size());
  std::printf("  feature of %d bytes: %d joints, %d Hz, %.12s\n", size, about[3],
              read_at<std::uint16_t>(about, 5), reinterpret_cast<const char*>(&about[49]));
  const std::uint32_t crc = crc32_of(std::span(about).subspan(1, 60));
  promise(size == 65 && read_at<std::uint32_t>(about, 61) == crc, "the feature is whole");
  std::uint32_t sequence = 0, before = 0;
  int lost = -1;  // the first report follows none
  float x = 0;
  const Traffic traffic = talk(handle.get(), [&](ReportView reading) {
    lost += read_at<std::uint32_t>(reading, 4) == before + 1 ? 0 : 1;
    before = read_at<std::uint32_t>(reading, 4);
    x = read_at<float>(reading, 16);
    return raw_command(++sequence, reading, 0.2F);
  });
  const Time silent = steady_now();
  print(traffic, device);
  promise(std::abs(traffic.written - 1000) <= 2 && lost <= 0, "every reading read and answered");
  std::this_thread::sleep_for(30ms);
  const auto [zero, commands, rejected, problems] = device.with([&](Time) {
    return std::tuple(model.forces().zero_after(silent), model.commands(), model.rejected(),
                      model.violations().size());
  });
  std::printf("  joint at %.4f rad, expected %.4f; %d commands, %d rejected; zero %.1f ms after\n",
              x, 0.2 / layout.physics.stiffness, commands, rejected,
              zero ? milliseconds(*zero) : NAN);
  promise(std::abs(x - 0.2 / layout.physics.stiffness) < 1e-3, "the joint gives way");
  promise(commands == traffic.written && rejected == 0, "every command arrived whole");
  promise(zero && *zero <= layout.watchdog + 1ms, "its watchdog cuts the torque");
  promise(problems == 0, "nothing against the protocol");
  pull_out_and_in(device, handle, model.identity());
}

}  // namespace

int main() {
  prctl(PR_SET_TIMERSLACK, 1);
  hid_init();
  probe_space_mouse();
  probe_pid_joystick("PID joystick", {});
  probe_pid_joystick("PID joystick of another make", {.layout = PidLayout::unusual()});
  for (const PidFirmware firmware :
       {PidFirmware::arduino, PidFirmware::fino, PidFirmware::open_ffboard, PidFirmware::adapt}) {
    probe_pid_joystick(("PID joystick, " + name(firmware)).c_str(),
                       PidJoystickOptions::of(firmware));
  }
  probe_raw_device();
  hid_exit();
  return all_kept ? 0 : 1;
}
