// Player of a recording: its time, speed and loop.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "devices/files/session/session.h"

namespace limpid {

class Player {
 public:
  explicit Player(std::shared_ptr<const Session> session) : session_(std::move(session)) {}

  const Session& session() const { return *session_; }
  // Session for work beside the window that may outlive the player.
  const std::shared_ptr<const Session>& shared() const { return session_; }
  double duration() const { return static_cast<double>(session_->size()) * session_->info.tick; }
  double time() const { return time_; }  // [s]
  std::size_t index() const {
    const auto k = static_cast<std::size_t>(std::max(0.0, time_ / session_->info.tick + 1e-6));
    return std::min(k, session_->size() - 1);
  }
  std::span<const double> row() const { return session_->row(index()); }
  double row_time() const { return static_cast<double>(index()) * session_->info.tick; }  // [s]

  bool playing() const { return playing_; }
  void play() {
    if (time_ >= duration() - session_->info.tick) time_ = 0;
    playing_ = true;
  }
  void pause() { playing_ = false; }
  // Plays from one moment to another, repeatedly while looping, until another call seeks or plays.
  void play_between(double start, double stop) {
    seek(start);
    stretch_ = {time_, std::clamp(stop, time_, duration())};
    playing_ = true;
  }
  void seek(double time) {
    stretch_.reset();
    time_ = std::clamp(time, 0.0, duration() - session_->info.tick);
  }
  void step(int ticks) {
    pause();
    seek(time_ + ticks * session_->info.tick);
  }
  void advance(double dt) {
    if (!playing_) return;
    time_ += dt * speed;
    if (stretch_ && time_ >= stretch_->second) {
      const auto [start, stop] = *stretch_;
      const double over = std::fmod(time_ - start, std::max(stop - start, session_->info.tick));
      time_ = loop ? start + over : stop;
      playing_ = loop;
      if (!loop) stretch_.reset();
    }
    if (time_ < duration()) return;
    if (loop) {
      time_ = std::fmod(time_, duration());
    } else {
      seek(duration());
      playing_ = false;
    }
  }

  double speed = 1;  // 0.1 to 10
  bool loop = false;

 private:
  std::shared_ptr<const Session> session_;
  double time_ = 0;
  bool playing_ = false;
  std::optional<std::pair<double, double>> stretch_;  // part that is played [s]
};

}  // namespace limpid
