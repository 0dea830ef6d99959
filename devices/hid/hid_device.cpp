#include "devices/hid/hid_device.h"

#include <fmt/format.h>
#include <sched.h>

#include <optional>

#include "core/realtime/clock.h"
#include "devices/hid/guardian.h"
#include "devices/hid/hid_transport.h"

namespace limpid {

HidDevice::HidDevice(std::unique_ptr<HidTransport> transport, std::unique_ptr<HidProtocol> protocol,
                     const HidPlace& place, const AskForPriority& ask, DeviceClaim claim)
    : claim_(std::move(claim)),
      transport_(std::move(transport)),
      protocol_(std::move(protocol)),
      path_(place.path) {
  protocol_->open(*transport_);
  traits_ = protocol_->traits();
  if (traits_.name.empty()) traits_.name = place.name;
  traits_.id = place.id;
  if (!place.library.empty()) traits_.made_by += fmt::format(" ({})", place.library);
  exchange_ =
      std::make_unique<HidExchange>(*transport_, *protocol_, [] { return MonotonicTime{}.now(); });
  std::promise<void> guarded;
  std::future<void> is_guarded = guarded.get_future();
  try {
    thread_ = std::thread([this, ask, &guarded] { run(ask, std::move(guarded)); });
    is_guarded.get();
  } catch (...) {
    if (thread_.joinable()) thread_.join();
    exchange_->finish();  // its motors may be on already
    throw;
  }
}

HidDevice::~HidDevice() {
  quit_.store(true, std::memory_order_relaxed);
  thread_.join();
}

// Runs the exchange. The guardian watches over this thread, and also stops the device if the stop
// at the end does not get through.
void HidDevice::run(const AskForPriority& ask, std::promise<void> guarded) noexcept {
  std::optional<Guardian> guardian;
  try {
    become_realtime(ask);
    if (sched_getscheduler(0) == SCHED_IDLE) {
      throw HidError(
          "the device's thread would have a lower priority than all other threads, because the "
          "thread that opened the device had lowered its own priority");
    }
    const std::vector<Report>& stop = protocol_->stop_reports();
    if (traits_.pushes && !path_.empty()) {
      guardian.emplace(path_, stop, claim_.descriptor());
    } else if (traits_.pushes) {
      const LastWords words = transport_->last_words(stop);
      if (words.descriptor >= 0)
        guardian.emplace(words.descriptor, words.bytes, claim_.descriptor());
    }
    guarded.set_value();
  } catch (...) {
    guarded.set_exception(std::current_exception());
    return;
  }
  while (!quit_.load(std::memory_order_relaxed) && exchange_->step()) {
  }
  if (exchange_->finish() && guardian) guardian->dismiss();
}

}  // namespace limpid
