#include "tests/vendor/stand_in.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <thread>

namespace limpid::stand_in {

std::int64_t now() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * std::int64_t{1'000'000'000} + t.tv_nsec;
}

Faults::Faults() {
  const char* const ordered = std::getenv("LIMPID_STAND_IN");
  std::istringstream words(ordered != nullptr ? ordered : "");
  for (std::string word; std::getline(words, word, ',');) {
    Fault fault;
    if (const auto at = word.find('@'); at != std::string::npos) {
      fault.after = std::stol(word.substr(at + 1)) * 1'000'000;
      word.resize(at);
    }
    if (const auto at = word.find(':'); at != std::string::npos) {
      fault.value = std::stod(word.substr(at + 1));
      word.resize(at);
    }
    faults_[word] = fault;
  }
}

bool Faults::due(const char* name) const {
  const auto found = faults_.find(name);
  return found != faults_.end() && now() - start_ >= found->second.after;
}

bool Faults::due_once(const char* name) {
  if (!due(name) || faults_[name].done) return false;
  return faults_[name].done = true;
}

double Faults::value(const char* name, double otherwise) const {
  const auto found = faults_.find(name);
  return found == faults_.end() || found->second.value < 0 ? otherwise : found->second.value;
}

Arm::Arm() : sway_(Faults().value("sway", 0)), moved_(now()) {
  const char* const file = std::getenv("LIMPID_STAND_IN_RECORD");
  if (file == nullptr) return;
  const int descriptor = open(file, O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (descriptor < 0 || ftruncate(descriptor, sizeof(Record)) != 0) return;
  void* const at = mmap(nullptr, sizeof(Record), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  if (at != MAP_FAILED) record_ = static_cast<Record*>(at);
  close(descriptor);
}

void Arm::move() {
  constexpr double kMass = 0.1, kSpring = 40, kDamper = 3;  // [kg, N/m, N s/m]
  constexpr double kStep = 1e-4, kSway = 12;                // [s, rad/s]
  double left = std::min(1e-9 * static_cast<double>(now() - moved_), 0.1);
  moved_ = now();
  for (; left > 0; left -= kStep) {
    const double dt = std::min(left, kStep);
    time_ += dt;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const double motor = (on_ ? force_[i] : 0) + sway_ * std::sin(kSway * time_);
      v_[i] += dt * (motor - kSpring * x_[i] - kDamper * v_[i]) / kMass;
      x_[i] += dt * v_[i];
    }
  }
}

Three Arm::place() {
  const std::lock_guard lock(mutex_);
  move();
  return x_;
}

void Arm::hold(const Three& force, bool on) {
  const std::lock_guard lock(mutex_);
  move();
  const Three held = on ? force : Three{};
  if (!any_ || held != force_ || on != on_) record(held, on);
  force_ = held;
  on_ = on;
  any_ = true;
}

void Arm::record(const Three& force, bool on) {
  if (record_ == nullptr || record_->count >= static_cast<std::int64_t>(kMost)) return;
  record_->entries[static_cast<std::size_t>(record_->count)] = {now(), force, on ? 1 : 0};
  ++record_->count;
}

void wait_for_ever() {
  for (;;) pause();
}

void sleep_ms(double ms) {
  std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(ms));
}

}  // namespace limpid::stand_in
