#include "devices/hid/hid_device.h"

#include "core/loop/clock.h"

namespace limpid {

HidDevice::HidDevice(std::unique_ptr<HidTransport> transport, std::unique_ptr<HidProtocol> protocol,
                     const HidPlace& place, const AskForPriority& ask)
    : transport_(std::move(transport)), protocol_(std::move(protocol)) {
  protocol_->open(*transport_);
  traits_ = protocol_->traits();
  if (traits_.name.empty()) traits_.name = place.name;
  traits_.id = place.id;
  exchange_ =
      std::make_unique<HidExchange>(*transport_, *protocol_, [] { return MonotonicTime{}.now(); });
  try {
    if (traits_.pushes && !place.path.empty()) {
      guardian_ = std::make_unique<Guardian>(place.path, protocol_->stop_reports());
    }
    thread_ = std::thread([this, ask] { run(ask); });
  } catch (...) {
    exchange_->finish();  // its motors may be on already
    throw;
  }
}

// If the stop did not get through, the guardian tries as well.
HidDevice::~HidDevice() {
  quit_.store(true, std::memory_order_relaxed);
  thread_.join();
  if (guardian_ && stopped_) guardian_->dismiss();
}

void HidDevice::run(const AskForPriority& ask) noexcept {
  become_realtime(ask);
  while (!quit_.load(std::memory_order_relaxed) && exchange_->step()) {
  }
  stopped_ = exchange_->finish();
}

}  // namespace limpid
