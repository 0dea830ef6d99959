#include "app/live/live_run.h"

#include <chrono>
#include <stdexcept>

namespace limpid {
namespace {

using namespace std::chrono_literals;

constexpr auto kBetween = 10ms;  // between controls; well within SafetyLimits::kSilence
constexpr auto kGone = 1s;

}  // namespace

LiveRun::LiveRun(const RunPlan& plan, const SafetyLimits& limits, std::unique_ptr<Device> device,
                 AskForPriority ask)
    : arm_(plan.arm), session_(std::move(ask)) {
  session_.controls().limits = limits;
  session_.open(plan.arm, plan.document.scene, plan.parameters, std::move(device));
  seen_ = MonotonicTime{}.now();
}

void LiveRun::touch(const Scene& scene) { session_.touch(arm_, scene); }

void LiveRun::check() {
  const LoopStatus status = session_.loop().status();
  if (!status.running) throw std::runtime_error("the loop has ended: " + status.failure);
  const nanoseconds now = MonotonicTime{}.now();
  if (session_.loop().snapshot().connected) seen_ = now;
  if (now - seen_ > kGone) throw std::runtime_error("the device is disconnected");
  if (const std::string& why = session_.last_recording().trouble; !why.empty()) {
    throw FileError(why);
  }
}

bool LiveRun::pass(double seconds, const std::atomic<bool>& stop, const Row& row) {
  const MonotonicTime time;
  session_.turn({});  // drops older rows
  const nanoseconds end = time.now() + nanoseconds(std::llround(1e9 * seconds));
  while (time.now() < end) {
    if (stop) return false;
    session_.loop().set(session_.controls());
    time.sleep_until(std::min(end, time.now() + kBetween));
    session_.turn([&](LaneRows rows, std::uint64_t) {
      if (row) row(rows[kMainLane]);
    });
    check();
  }
  return true;
}

std::uint64_t LiveRun::finish_recording() {
  const Recorder* recorder = session_.loop().recorder();
  const std::uint64_t dropped =
      recorder != nullptr ? recorder->dropped() : session_.last_recording().dropped;
  session_.complete_recording();
  // A recording that ended by itself was finished beside the loop.
  if (const std::string why = session_.take_failure(); !why.empty()) throw FileError(why);
  return dropped;
}

}  // namespace limpid
