#include "devices/hid/hid_exchange.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/realtime/clock.h"

namespace limpid {
namespace {

// Reports taken in a turn, as many as the kernel keeps: a device that floods must not keep the
// torque from being sent.
constexpr int kMostReports = 64;

}  // namespace

HidExchange::HidExchange(HidTransport& transport, HidProtocol& protocol, ReadClock clock)
    : transport_(transport),
      protocol_(protocol),
      clock_(std::move(clock)),
      dof_(static_cast<std::size_t>(protocol.traits().dof)),
      deliver_([this](std::span<const std::uint8_t> report) { deliver(report); }),
      deliver_if_due_([this](std::span<const std::uint8_t> report) { deliver_if_due(report); }) {}

bool HidExchange::read(DeviceReading& newest) noexcept {
  arrivals_.update();
  const Arrival& arrival = arrivals_.front();
  newest = arrival.reading;
  known_lapses_ = newest.lapses;
  newest.age = newest.count > 0 ? in_seconds(clock_() - arrival.moment)
                                : std::numeric_limits<double>::infinity();
  return !lost();
}

void HidExchange::write(std::span<const double> torque) noexcept {
  Command& command = commands_.back();
  command.torque.fill(0);
  std::copy_n(torque.begin(), std::min(torque.size(), dof_), command.torque.begin());
  command.moment = clock_();
  command.lapses = known_lapses_;
  command.any = true;
  commands_.publish();
}

void HidExchange::stop() noexcept { write({}); }

bool HidExchange::step() noexcept {
  receive(1);
  ask_if_silent();
  send();
  return !lost();
}

bool HidExchange::finish() noexcept {
  bool all = true;
  for (const Report& report : protocol_.stop_reports()) all &= deliver(report);
  return all;
}

void HidExchange::receive(int timeout_ms) noexcept {
  for (int i = 0; i < kMostReports; ++i) {
    const int size = transport_.read(buffer_, i == 0 ? timeout_ms : 0);
    if (size < 0) return lose();
    if (size == 0) return;
    const auto bytes = std::min(static_cast<std::size_t>(size), buffer_.size());
    switch (protocol_.decode(std::span(buffer_).first(bytes), arrival_.reading)) {
      case Decoded::unusable: unusable_.fetch_add(1, std::memory_order_relaxed); break;
      case Decoded::status: arrivals_.write(arrival_); break;
      case Decoded::reading: take_reading(arrival_.reading); break;
    }
  }
}

void HidExchange::take_reading(const DeviceReading& reading) noexcept {
  arrival_.reading = reading;
  ++arrival_.reading.count;
  arrival_.moment = clock_();
  arrivals_.write(arrival_);
}

// Asks for a reading: many devices are silent while nothing moves, which must not pass for a hang.
void HidExchange::ask_if_silent() noexcept {
  const std::span<const std::uint8_t> question = protocol_.silent_report();
  const nanoseconds now = clock_();
  if (question.empty() || lost() || now - std::max(arrival_.moment, asked_) < kAskAfter) return;
  asked_ = now;
  transport_.ask(question);
}

void HidExchange::send() noexcept {
  if (!protocol_.traits().pushes) return;
  news_ = commands_.update() || news_;
  const nanoseconds now = clock_();
  if (!news_ && sent_any_ && now - sent_ < kSendPeriod) return;
  news_ = overtaken_ = false;
  const Torque torque = torque_now(now);
  const bool any = std::ranges::any_of(torque, [](double each) { return each != 0; });
  went_on_ = now;
  protocol_.encode(std::span(torque).first(dof_), now, any ? deliver_if_due_ : deliver_);
  if (overtaken_) {
    protocol_.undelivered();
    const nanoseconds later = clock_();
    if (wants_torque()) withheld();
    const Torque none{};
    protocol_.encode(std::span(none).first(dof_), later, deliver_);
  }
  if (failures_ == 0) heard_ = went_on_;
  sent_ = now;
  sent_any_ = true;
}

// Delivers a report of a torque that is not zero, if the torque may still be sent.
void HidExchange::deliver_if_due(std::span<const std::uint8_t> report) noexcept {
  if (overtaken_) return;
  news_ = commands_.update() || news_;
  overtaken_ = !may_push(clock_()) || !wants_torque();
  if (!overtaken_) deliver(report);
}

// Returns whether the newest command pushes, and the loop knew of all lapses.
bool HidExchange::wants_torque() const noexcept {
  const Command& command = commands_.front();
  return command.any && command.lapses == arrival_.reading.lapses &&
         std::ranges::any_of(command.torque, [](double each) { return each != 0; });
}

bool HidExchange::may_push(nanoseconds now) const noexcept {
  const Command& command = commands_.front();
  const DeviceReading& reading = arrival_.reading;
  return !lost() && command.any && now - command.moment <= kTorqueLife && reading.count > 0 &&
         now - arrival_.moment <= protocol_.stale_after() && reading.hand && !reading.fault;
}

HidExchange::Torque HidExchange::torque_now(nanoseconds now) noexcept {
  const Command& command = commands_.front();
  if (!command.any || command.lapses != arrival_.reading.lapses) return {};
  Torque torque{};
  bool any = false;
  const std::vector<double>& effort = protocol_.traits().effort;
  for (std::size_t i = 0; i < dof_; ++i) {
    const double asked = command.torque[i];
    if (!std::isfinite(asked)) return withheld();
    any = any || asked != 0;
    torque[i] = std::clamp(asked, -effort[i], effort[i]);
  }
  const bool heard = !sent_any_ || now - heard_ <= kSendGap;
  return any && !(may_push(now) && heard) ? withheld() : torque;
}

HidExchange::Torque HidExchange::withheld() noexcept {
  ++arrival_.reading.lapses;
  arrivals_.write(arrival_);
  return {};
}

// Sends a report, and takes those that came meanwhile: some endpoints take milliseconds for one.
bool HidExchange::deliver(std::span<const std::uint8_t> report) noexcept {
  const bool delivered = transport_.write(report);
  failures_ = delivered ? 0 : failures_ + 1;
  if (!delivered) protocol_.undelivered();
  if (failures_ >= kMostFailures) lose();
  receive(0);
  ask_if_silent();
  // A slow endpoint is no stall; a longer pause is, and withholds the next torque.
  if (const nanoseconds now = clock_(); now - went_on_ <= kSendGap) went_on_ = now;
  return delivered;
}

}  // namespace limpid
