#include "devices/simulated/rig.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "core/dynamics/inverse_kinematics.h"
#include "core/tick/tick.h"
#include "devices/device.h"
#include "devices/reading_watch.h"
#include "devices/simulated/virtual_device.h"

namespace limpid {

namespace {

std::span<const double> all_of(const Eigen::VectorXd& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}

// Stands in for a device that was never there.
class NoDevice final : public Device {
 public:
  const DeviceTraits& traits() const override { return traits_; }
  bool read(DeviceReading&) noexcept override { return false; }
  void write(std::span<const double>) noexcept override {}
  void stop() noexcept override {}

 private:
  DeviceTraits traits_;
};

}  // namespace

template <int N>
struct Rig::Of {
  Of(const ArmDescription& arm, const Scene& scene, std::unique_ptr<Device> unplugged)
      : tick(arm, scene),
        own(std::move(unplugged)),
        device(own.get()),
        x_before(Vec<N>::Zero(arm.dof())),
        v(x_before) {}
  Reading<N> read(const Parameters& p, const RigInput& now) noexcept;
  void write_row(const HandInput& hand, std::span<double> row) const noexcept;
  void begin_at(const RigStart& start, const Vec3& target) noexcept;
  Vec3 tip() const;
  Vec<N> of_joints(std::span<const double> values) const;

  Tick<N> tick;
  std::unique_ptr<Device> own;  // used while nothing is plugged in
  Device* device;
  bool here = false;  // the device answered at the last step
  DeviceReading reading;
  ReadingWatch watch;
  bool believed = true;  // false if the newest reading was not believed
  Vec<N> x_before, v;    // measured at the last step [rad, rad/s]
  // Number of the device's lapses that are known; nothing: one just plugged in may have had any.
  std::optional<std::uint32_t> lapses = 0;
  RigInput input;
};

Rig::Rig(const ArmDescription& arm, const Scene& scene) {
  with_dof(arm.dof(), [&](auto n) {
    of_ = std::make_unique<Of<n>>(arm, scene, std::make_unique<VirtualDevice<n>>(arm));
  });
}

Rig::Rig(const ArmDescription& arm, const Scene& scene, Device* device) {
  with_dof(arm.dof(), [&](auto n) {
    of_ = std::make_unique<Of<n>>(arm, scene, std::make_unique<NoDevice>());
  });
  plug(device);
}

Rig::~Rig() = default;
Rig::Rig(Rig&&) noexcept = default;
Rig& Rig::operator=(Rig&&) noexcept = default;

void Rig::plug(Device* device) noexcept {
  std::visit(
      [&](auto& of) {
        of->device = device != nullptr ? device : of->own.get();
        of->lapses.reset();
        of->watch.start();
        of->believed = true;
      },
      of_);
}

bool Rig::device_reading(DeviceReading& newest) const {
  return std::visit(
      [&](const auto& of) {
        newest = of->reading;
        return of->here;
      },
      of_);
}

const ForceGate& Rig::force() const {
  return std::visit([](const auto& of) -> const ForceGate& { return of->tick.force(); }, of_);
}

void Rig::limit(const SafetyLimits& limits) {
  std::visit([&](auto& of) { of->tick.limit(limits); }, of_);
}

// Gives the reading that the loop sees. A device that is silent, or reads what cannot be, stays
// where it last was. A virtual arm's reading is taken as it is: the tick finds that it diverged.
template <int N>
Reading<N> Rig::Of<N>::read(const Parameters& p, const RigInput& now) noexcept {
  device->expect(p, now.hand);
  here = device->read(reading);
  const bool guarded = device->traits().guarded;
  watch.wait(now.dt > 0 ? now.dt : now.periods * p.tick);
  const bool heard = here && reading.count > 0, before = believed;
  if (heard) believed = !guarded || watch.believes(reading, device->traits());
  Vec<N> x = x_before;
  if (heard && believed) x = of_joints(reading.x);
  DeviceHealth health = health_of(reading, here, guarded, now.dt, now.silence, lapses);
  health.wrong = !believed;
  health.gap = health.gap || (believed && !before);  // nobody knows where it went meanwhile
  v = health.gap ? Vec<N>::Zero(x.size()) : Vec<N>((x - x_before) / (now.periods * p.tick));
  x_before = x;
  Reading<N> out{x, x, v, health, now.periods, now.dt, {}, now.hand.magnet, now.hand.pull};
  if (heard) out.warmth = static_cast<double>(reading.warmth);
  out.excitation = now.excitation;
  if (const auto truth = device->truth()) {
    out.x = of_joints(truth->x);
    out.v = of_joints(truth->v);
    out.acted = of_joints(truth->motor_torque);
  }
  return out;
}

// Writes what only the device knows.
template <int N>
void Rig::Of<N>::write_row(const HandInput& hand, std::span<double> row) const noexcept {
  const RowLayout& layout = tick.layout();
  const std::span<double> f1 = layout.in(row, Column::hand_torque);
  const std::span<double> target = layout.in(row, Column::hand_target);
  if (const auto truth = device->truth()) {
    std::ranges::copy(truth->hand_torque, f1.begin());
    std::ranges::copy(truth->motor_torque, layout.in(row, Column::motor_torque).begin());
    std::copy_n(hand.target.data(), 3, target.begin());
  } else {  // nobody measures the hand
    std::ranges::fill(f1, std::numeric_limits<double>::quiet_NaN());
    const Vec3 tip = tick.tip();
    std::copy_n(tip.data(), 3, target.begin());
  }
  layout.in(row, Column::hand_grip)[0] = hand.grip;
  const std::span<double> orientation = layout.in(row, Column::tool_orientation);
  if (here && believed && reading.oriented()) {
    std::ranges::copy(reading.orientation, orientation.begin());
  } else {
    std::ranges::fill(orientation, std::numeric_limits<double>::quiet_NaN());
  }
}

template <int N>
Vec<N> Rig::Of<N>::of_joints(std::span<const double> values) const {
  return Eigen::Map<const Vec<N>>(values.data(), x_before.size());
}

template <int N>
void Rig::Of<N>::begin_at(const RigStart& start, const Vec3& target) noexcept {
  const auto n = static_cast<std::size_t>(start.x1.size());
  device->place({start.x1.data(), n}, {start.v1.data(), n}, target);
  x_before = start.x1;
  v = start.v1;
  input = {{target, 1}};
}

template <int N>
Vec3 Rig::Of<N>::tip() const {
  const auto truth = device->truth();
  return truth ? tick.tip_at(of_joints(truth->x)) : tick.tip();
}

TouchWorld::TouchWorld(const ArmDescription& arm, const Scene& scene) {
  with_dof(arm.dof(), [&](auto n) { contacts_ = std::make_unique<Contacts<n>>(arm, scene); });
}

TouchWorld::~TouchWorld() = default;
TouchWorld::TouchWorld(TouchWorld&&) noexcept = default;
TouchWorld& TouchWorld::operator=(TouchWorld&&) noexcept = default;

void Rig::exchange(TouchWorld& world) noexcept {
  std::visit(
      [](auto& of, auto& contacts) {
        if constexpr (requires { of->tick.exchange(contacts); }) of->tick.exchange(contacts);
      },
      of_, world.contacts_);
}

const RowLayout& Rig::layout() const {
  return std::visit([](const auto& of) -> const RowLayout& { return of->tick.layout(); }, of_);
}

void Rig::start(const Parameters& p, const RigStart& start) {
  std::visit(
      [&](auto& of) {
        const bool armed = start.armed && !of->device->traits().guarded;
        of->tick.start(p, {start.x1, start.v1, start.x2, start.v2, start.f1_hat, armed,
                           start.reserve, start.world, start.owed, all_of(start.warmth)});
        of->begin_at(start, start.target);
      },
      of_);
}

void Rig::restart_here(const Parameters& p, RigStart& scratch, const Vec3& target) {
  present(scratch);
  std::visit(
      [&](auto& of) {
        of->tick.restart_here(p,
                              {scratch.x1, scratch.v1, scratch.x2, scratch.v2, scratch.f1_hat, true,
                               scratch.reserve, scratch.world, false, all_of(scratch.warmth)});
        of->begin_at(scratch, target);
      },
      of_);
}

void Rig::present(RigStart& into) const {
  std::visit(
      [&](const auto& of) {
        const auto truth = of->device->truth();
        into.owed = false;
        into.x1 = truth ? of->of_joints(truth->x) : of->x_before;
        into.v1 = truth ? of->of_joints(truth->v) : of->v;
        into.x2 = of->tick.proxy().x();
        into.v2 = of->tick.proxy().v();
        into.f1_hat = of->tick.estimate();
        into.target = of->input.hand.target;
        into.armed = of->tick.force().armed();
        into.reserve = of->tick.reserve();
        into.warmth = of->tick.warmth();
        into.world.clear();
        if (const BodyWorld* world = of->tick.proxy().contacts().world()) {
          into.world.reserve(BodyWorld::kMostNumbers);  // allocates once, outside of a tick
          world->write(into.world);
        }
      },
      of_);
}

void Rig::step(const Parameters& p, const RigInput& input, std::span<double> row) noexcept {
  std::visit(
      [&](auto& of) {
        const auto reading = of->read(p, input);
        const auto& torque = of->tick.run(p, reading, input.force, row);
        of->device->write({torque.data(), static_cast<std::size_t>(torque.size())});
        of->input = input;
        of->write_row(input.hand, row);
      },
      of_);
}

Vec3 Rig::tip() const {
  return std::visit([](const auto& of) { return of->tip(); }, of_);
}

bool Rig::steady() const {
  return std::visit([](const auto& of) { return of->tick.steady(); }, of_);
}

bool Rig::diverged() const {
  return std::visit([](const auto& of) { return of->tick.diverged(); }, of_);
}

RigStart rest_at(const ArmDescription& arm, const Vec3& target) {
  const auto x = inverse_kinematics(arm, target, rest_pose(arm));
  if (!x) throw std::invalid_argument("out of reach");
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(arm.dof());
  RigStart start{*x, zero, *x, zero, zero, target};
  start.owed = true;
  return start;
}

RigStart start_of(const RowLayout& layout, std::span<const double> row) {
  const auto vector = [&](Column c) {
    const auto values = layout.in(row, c);
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(values.data(), layout.width(c)));
  };
  const auto target = layout.in(row, Column::hand_target);
  // 0 if no law kept account until then.
  const double reserve = layout.in(row, Column::energy_ledger)[0];
  RigStart start{vector(Column::device_position),
                 vector(Column::device_velocity),
                 vector(Column::proxy_position),
                 vector(Column::proxy_velocity),
                 vector(Column::hand_torque_estimate),
                 Vec3(target[0], target[1], target[2]),
                 layout.in(row, Column::force_wanted)[0] != 0,
                 reserve != 0 ? reserve : RigStart{}.reserve};
  start.warmth = vector(Column::motor_warmth);
  return start;
}

}  // namespace limpid
