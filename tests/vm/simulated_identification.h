// Identification of a stick behind its protocol, in simulated time.
#pragma once

#include <vector>

#include "devices/identify/excitation.h"
#include "tests/support/built_in.h"
#include "tests/vm/simulated_desk.h"
#include "tests/vm/unlike_stick.h"

namespace limpid::test {

class SimulatedIdentification {
 public:
  explicit SimulatedIdentification(const UnlikeStick& stick) : model(stick.made()) {}

  void run() {
    while (motion.end() == ExcitationEnd::running) tick();
  }
  MotionRecord record() const {
    MotionRecord out;
    out.x.resize(static_cast<Eigen::Index>(x_.size()), 2);
    out.torque.resizeLike(out.x);
    for (std::size_t i = 0; i < x_.size(); ++i) {
      out.x.row(static_cast<Eigen::Index>(i)) = x_[i];
      out.torque.row(static_cast<Eigen::Index>(i)) = torque_[i];
    }
    return out;
  }

  const ArmDescription arm = read_urdf(assets_dir() / "devices/joystick.urdf");
  std::unique_ptr<RawDeviceModel> model;

 private:
  // Readings come at each whole millisecond, the tick runs in the middle, its torque leaves with
  // the next.
  void tick() {
    using namespace std::chrono_literals;
    link_.transport.arrive(model->input(now_));
    now_ += 50us;
    link_.exchange.step();
    now_ += 450us;
    DeviceReading reading;
    const bool here = link_.read(reading);
    const auto x = std::span(reading.x).first(2);
    const auto torque = motion.step({x, 1e-3, {.guarded = true, .lost = !here}});
    link_.write(torque);
    x_.emplace_back(x[0], x[1]);
    torque_.emplace_back(torque[0], torque[1]);
    now_ += 500us;
  }

  Time now_ = std::chrono::hours(1);
  const bool powered_ = (model->power(true, now_), true);
  SimulatedLink link_{*model, std::make_unique<RawProtocol>(), now_};

 public:
  Excitation motion{arm, link_.traits(), {}};

 private:
  std::vector<Eigen::Vector2d> x_, torque_;
};

}  // namespace limpid::test
