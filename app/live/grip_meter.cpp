#include "app/live/grip_meter.h"

#include <algorithm>
#include <utility>

#include "devices/identify/grip_probe.h"

namespace limpid {

std::string GripMeter::why_not() const {
  const LiveLoop& loop = session_.loop();
  if (busy()) return "The grip is being measured now.";
  if (!loop.device_in_place() && session_.controls().paused) return "The simulation is paused.";
  if (loop.snapshot().arming != Arming::on) return "The force is off. Arm the force first.";
  return {};
}

void GripMeter::begin(const ArmDescription& arm, const Scene& scene) {
  if (!why_not().empty()) return;
  arm_ = arm;
  scene_ = scene;
  parameters_ = session_.loop().taken(session_.controls().parameters());
  found_.reset();
  record_.emplace(session_.loop().layout(), parameters_.tick);
  session_.controls().probe = ++number_;
  asked_ = true;
}

void GripMeter::stop() {
  session_.controls().probe = 0;
  asked_ = false;
  working_ = {};
}

void GripMeter::forget() {
  stop();
  record_.reset();
  found_.reset();
}

void GripMeter::take(std::span<const double> row) {
  if (asked_) record_->take(row);
}

double GripMeter::part() const { return std::min(1.0, time() / GripProbe::kDuration); }

// Finds the grip beside the window; `asked_` is over.
void GripMeter::conclude() {
  asked_ = false;
  working_ =
      tasks_.run([arm = arm_, scene = scene_, p = parameters_, record = std::move(*record_)] {
        return judged(arm, p, scene, find_grip(arm, p, record));
      });
  record_.reset();
}

void GripMeter::update() {
  // A loop that has seen the wish and does not push had no force: there will be no rows.
  const Snapshot& now = session_.loop().snapshot();
  const bool none = asked_ && !record_->begun() && now.probe == number_ && !now.probing;
  if (asked_ && (record_->ended() || none)) conclude();
  if (auto found = take_ready(working_)) found_ = std::move(found);
}

}  // namespace limpid
