// A HID device inside the test: two queues of reports, sent and received.
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "devices/hid/hid_protocol.h"

namespace limpid::test {

// Shared by the transport and the test (or a thread that plays the device).
class FakeHid {
 public:
  // The device's side.
  void send(const Report& report) {
    const std::lock_guard lock(mutex_);
    input_.push_back(report);
    changed_.notify_all();
  }
  void unplug() {
    const std::lock_guard lock(mutex_);
    gone_ = true;
    changed_.notify_all();
  }
  void refuse_writes(bool refuse) {
    const std::lock_guard lock(mutex_);
    refuse_writes_ = refuse;
  }
  std::vector<Report> received() const {
    const std::lock_guard lock(mutex_);
    return output_;
  }
  void forget_received() {
    const std::lock_guard lock(mutex_);
    output_.clear();
  }
  // Returns the first report, received before or to come, for which `wanted` is true.
  Report wait_for(const std::function<bool(const Report&)>& wanted) {
    std::unique_lock lock(mutex_);
    for (std::size_t i = 0;; ++i) {
      changed_.wait(lock, [&] { return output_.size() > i; });
      if (wanted(output_[i])) return output_[i];
    }
  }

  // Answers to get_feature and ask by id, and reports given to set_feature; not for threads.
  std::map<std::uint8_t, Report> features, inputs;
  int questions = 0;  // calls of ask
  std::vector<Report> features_set;
  std::vector<std::uint8_t> descriptor;  // empty unless the test sets it
  std::string id;                        // likewise
  std::function<void()> while_writing = [] {};

 private:
  friend class FakeTransport;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Report> input_;
  std::vector<Report> output_;
  bool gone_ = false;
  bool refuse_writes_ = false;
};

// Waits for reports if `waits`; otherwise an empty queue is read as empty.
class FakeTransport final : public HidTransport {
 public:
  explicit FakeTransport(std::shared_ptr<FakeHid> device, bool waits = false)
      : device_(std::move(device)), waits_(waits) {}

  int read(std::span<std::uint8_t> report, int timeout_ms) noexcept override {
    std::unique_lock lock(device_->mutex_);
    if (waits_) {
      device_->changed_.wait_for(lock, std::chrono::milliseconds(timeout_ms),
                                 [&] { return device_->gone_ || !device_->input_.empty(); });
    }
    if (device_->gone_) return -1;
    if (device_->input_.empty()) return 0;
    const Report next = std::move(device_->input_.front());
    device_->input_.pop_front();
    return copy(next, report);
  }

  std::string id() const override { return device_->id; }

  bool write(std::span<const std::uint8_t> report) noexcept override {
    device_->while_writing();
    const std::lock_guard lock(device_->mutex_);
    if (device_->gone_ || device_->refuse_writes_) return false;
    device_->output_.emplace_back(report.begin(), report.end());
    device_->changed_.notify_all();
    return true;
  }

  int get_feature(std::span<std::uint8_t> report) noexcept override {
    const auto found = report.empty() ? device_->features.end() : device_->features.find(report[0]);
    return found == device_->features.end() ? -1 : copy(found->second, report);
  }

  void ask(std::span<const std::uint8_t> question) noexcept override {
    ++device_->questions;
    const auto found = device_->inputs.find(question[0]);
    if (found != device_->inputs.end()) device_->send(found->second);
  }

  bool set_feature(std::span<const std::uint8_t> report) noexcept override {
    device_->features_set.emplace_back(report.begin(), report.end());
    return true;
  }

  const std::vector<std::uint8_t>& report_descriptor() const override {
    return device_->descriptor;
  }

 private:
  static int copy(const Report& from, std::span<std::uint8_t> to) {
    const std::size_t size = std::min(from.size(), to.size());
    std::copy_n(from.begin(), size, to.begin());
    return static_cast<int>(size);
  }

  std::shared_ptr<FakeHid> device_;
  bool waits_;
};

}  // namespace limpid::test
