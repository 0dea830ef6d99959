#include "app/live/live_run.h"

#include <chrono>
#include <stdexcept>

namespace limpid {
namespace {

using namespace std::chrono_literals;

constexpr auto kBetween = 10ms;  // between controls; well within SafetyLimits::kSilence
constexpr auto kGone = 1s;
constexpr std::size_t kDrained = 256;  // rows at a time

}  // namespace

LiveRun::LiveRun(const RunPlan& plan, const SafetyLimits& limits, std::unique_ptr<Device> device,
                 AskForPriority ask)
    : arm_(plan.arm), loop_(std::move(ask)) {
  controls_.parameters = plan.parameters;
  controls_.limits = limits;
  loop_.open(plan.arm, plan.document.scene, plan.parameters, std::move(device));
  loop_.set(controls_);
  rows_.resize(kDrained * 2 * static_cast<std::size_t>(loop_.layout().stride()));
  seen_ = MonotonicTime{}.now();
}

void LiveRun::touch(const Scene& scene) {
  loop_.exchange(std::make_unique<TouchWorlds>(arm_, scene));
}

void LiveRun::check() {
  const LoopStatus status = loop_.status();
  if (!status.running) throw std::runtime_error("the loop has ended: " + status.failure);
  const nanoseconds now = MonotonicTime{}.now();
  if (loop_.snapshot().connected) seen_ = now;
  if (now - seen_ > kGone) throw std::runtime_error("the device is gone");
}

void LiveRun::drain(const Row& row) {
  const auto stride = static_cast<std::size_t>(loop_.layout().stride());
  for (std::size_t count = loop_.drain(rows_); count > 0; count = loop_.drain(rows_)) {
    for (std::size_t i = 0; row && i < count; ++i) {
      row(std::span(rows_).subspan(2 * i * stride, stride));
    }
  }
}

bool LiveRun::pass(double seconds, const std::atomic<bool>& stop, const Row& row) {
  const MonotonicTime time;
  drain({});  // drops older rows
  const nanoseconds end = time.now() + nanoseconds(std::llround(1e9 * seconds));
  while (time.now() < end) {
    if (stop) return false;
    loop_.set(controls_);
    time.sleep_until(std::min(end, time.now() + kBetween));
    loop_.update();
    check();
    drain(row);
  }
  return true;
}

std::uint64_t LiveRun::finish_recording() {
  const std::uint64_t dropped = loop_.recorder() != nullptr ? loop_.recorder()->dropped() : 0;
  loop_.finish_recording();
  return dropped;
}

}  // namespace limpid
