// A reference device and the loop that holds it, in one thread and simulated time: every number is
// the same each time. Effects of threads, the kernel and hidapi show only in the virtual machine.
#pragma once

#include <deque>
#include <memory>

#include "devices/hid/hid_exchange.h"
#include "devices/hid/pid_joystick.h"
#include "devices/hid/raw_protocol.h"
#include "devices/simulated/rig.h"
#include "tests/support/hid/pid_joystick_model.h"
#include "tests/support/hid/raw_device_model.h"
#include "tests/support/wisher.h"
#include "tests/vm/leaning_hand.h"

namespace limpid::test {

template <class Model>
constexpr int torque_levels() {
  if constexpr (std::is_base_of_v<PidJoystickModel, Model>) return Model::kTorqueLevels;
  return 10000;
}

// Hands reports to the model at once, without a kernel between.
class ModelTransport final : public HidTransport {
 public:
  ModelTransport(ReferenceDevice& model, const Time& now) : model_(model), now_(now) {}

  void arrive(const std::vector<Report>& reports) {
    waiting_.insert(waiting_.end(), reports.begin(), reports.end());
  }

  int read(std::span<std::uint8_t> report, int) noexcept override {
    if (!model_.powered()) return -1;
    if (waiting_.empty()) return 0;
    Report next = waiting_.front();
    waiting_.pop_front();
    if (!numbered_) next.insert(next.begin(), 0);
    return copy(next, report);
  }
  bool write(std::span<const std::uint8_t> report) noexcept override {
    if (!model_.powered()) return false;
    model_.output(report, now_);
    return true;
  }
  int get_feature(std::span<std::uint8_t> report) noexcept override {
    const auto answer = model_.feature(report[0], now_);
    return answer ? copy(*answer, report) : -1;
  }
  void ask(std::span<const std::uint8_t> question) noexcept override {
    if (const auto answer = model_.ask(question[0], now_)) arrive({*answer});
  }
  bool set_feature(std::span<const std::uint8_t> report) noexcept override {
    return model_.set_feature(report, now_);
  }
  const std::vector<std::uint8_t>& report_descriptor() const override {
    return model_.report_descriptor();
  }

 private:
  static int copy(const Report& from, std::span<std::uint8_t> to) {
    const std::size_t size = std::min(from.size(), to.size());
    std::copy_n(from.begin(), size, to.begin());
    return static_cast<int>(size);
  }

  ReferenceDevice& model_;
  const Time& now_;
  bool numbered_ = parse_report_descriptor(model_.report_descriptor()).numbered;
  std::deque<Report> waiting_;
};

// A device that exists until it is unplugged.
class SimulatedLink final : public Device {
 public:
  SimulatedLink(ReferenceDevice& model, std::unique_ptr<HidProtocol> protocol, const Time& now)
      : transport(model, now),
        protocol_(opened(std::move(protocol), transport)),
        exchange(transport, *protocol_, [&now] { return now; }) {}

  const DeviceTraits& traits() const override { return protocol_->traits(); }
  bool read(DeviceReading& newest) noexcept override { return exchange.read(newest); }
  void write(std::span<const double> torque) noexcept override { exchange.write(torque); }
  void stop() noexcept override { exchange.stop(); }

  ModelTransport transport;

 private:
  static std::unique_ptr<HidProtocol> opened(std::unique_ptr<HidProtocol> protocol,
                                             HidTransport& transport) {
    protocol->open(transport);
    return protocol;
  }
  std::unique_ptr<HidProtocol> protocol_;

 public:
  HidExchange exchange;
};

// The device with its loop. Readings come at each whole millisecond, the I/O thread wakes 0.05 ms
// later, the tick runs in the middle; its torque waits for the next reading.
template <class Model>
class SimulatedDesk {
 public:
  static constexpr bool kPid = std::is_base_of_v<PidJoystickModel, Model>;

  SimulatedDesk(const ArmDescription& arm, const Scene& scene)
      : SimulatedDesk(arm, scene, make_model(), {}) {
    model->hand().axis(0) = stick_axis(0);
    model->hand().axis(0).path = lean_right;
  }
  SimulatedDesk(const ArmDescription& arm, const Scene& scene, std::unique_ptr<Model> one,
                const Parameters& p)
      : parameters(p), model(std::move(one)), rig(arm, scene, nullptr), row(rig.layout()) {
    model->power(true, now);
    connect();
    rig.start(parameters, rest_at(arm, Vec3(0, 0, kStickLength)));
  }

  void connect() {
    std::unique_ptr<HidProtocol> protocol;
    if constexpr (kPid) {
      protocol = std::make_unique<PidJoystick>(
          parse_report_descriptor(model->report_descriptor()),
          PidSettings{.range = kRange, .effort = kEffort, .reverse = Model::kReversed});
    } else {
      protocol = std::make_unique<RawProtocol>();
    }
    link = std::make_unique<SimulatedLink>(*model, std::move(protocol), now);
    rig.plug(link.get());
  }
  void replug() {
    model->power(false, now);
    run(50);
    model->power(true, now);
    connect();
  }

  void run(int milliseconds) {
    using std::chrono::microseconds;
    for (int i = 0; i < milliseconds; ++i, now += microseconds(500)) {
      link->transport.arrive(model->input(now));
      now += microseconds(50);
      link->exchange.step();
      now += microseconds(450);
      if (ticking) rig.step(parameters, {{rig.tip(), 1}, wisher.at(armed)}, row.add());
    }
  }
  // Runs until the stick leans on the gate as far as it goes and has been pushed for a while.
  bool push() {
    armed = true;
    run(1500);
    return torque() < -0.1;
  }
  double torque() const { return model->forces().newest()[0]; }

  static std::unique_ptr<Model> make_model() {
    if constexpr (kPid) {
      PidJoystickOptions options = Model::usual_options();
      options.torque_limit = kEffort;
      options.physics = stick_axis(1);
      return std::make_unique<Model>(options);
    } else {
      return std::make_unique<Model>(
          RawDeviceLayout{.joints = 2, .torque_limit = kEffort, .physics = stick_axis(1)});
    }
  }

  Time now = std::chrono::hours(1);
  bool armed = false, ticking = true;
  Wisher wisher;
  Parameters parameters;
  std::unique_ptr<Model> model;
  Rig rig;
  Rows row;
  std::unique_ptr<SimulatedLink> link;
};

}  // namespace limpid::test
