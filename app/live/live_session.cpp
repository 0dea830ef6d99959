#include "app/live/live_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <utility>

#include "app/run/lane_settings.h"

namespace limpid {
namespace {

constexpr std::size_t kDrained = 512;  // ticks at a time

}  // namespace

LiveSession::LiveSession(AskForPriority ask, Dispose dispose)
    : loop_(std::move(ask), std::move(dispose)) {}

LiveSession::~LiveSession() {
  loop_.close();
  try {
    complete_recording();
  } catch (const std::exception& e) {
    std::fputs(fmt::format("limpid: {}\n", e.what()).c_str(), stderr);  // the terminal may be gone
  }
}

void LiveSession::open(const ArmDescription& arm, const Scene& scene, const Parameters& p,
                       const Vec3& home) {
  loop_.open(arm, scene, p, home);
  begin(p, home);
}

void LiveSession::open(const ArmDescription& arm, const Scene& scene, const Parameters& p,
                       std::unique_ptr<Device> device) {
  loop_.open(arm, scene, p, std::move(device));
  begin(p, rest_tip(arm));
}

void LiveSession::begin(const Parameters& p, const Vec3& home) {
  controls_.grab = controls_.magnet = controls_.paused = false;
  controls_.pull = {};
  controls_.probe = 0;
  controls_.slow = 1;
  controls_.goal = home;
  set(kMainLane, p);
  loop_.set(controls_);
  const auto stride = static_cast<std::size_t>(loop_.layout().stride());
  rows_.assign(kDrained * kMostLanes * stride, 0.0);
  newest_.assign(kMostLanes * stride, std::numeric_limits<double>::quiet_NaN());
  std::ranges::fill(std::span(newest_).first(stride), 0.0);
  tick_ = 0;
  ticked_ = false;
}

void LiveSession::touch(const ArmDescription& arm, const Scene& scene) {
  controls_.pull = {};  // bodies may have other numbers
  loop_.exchange(std::make_unique<TouchWorlds>(arm, scene));
}

void LiveSession::set(std::size_t lane, const Parameters& p) {
  controls_.lanes[lane] = p;
  share_world(controls_.lanes);
}

std::vector<std::span<const double>> LiveSession::rows() const {
  std::vector<std::span<const double>> rows;
  const std::size_t stride = newest_.size() / kMostLanes;
  for (std::size_t i = 0; i < controls_.lane_count && stride > 0; ++i) {
    const auto row = std::span(newest_).subspan(i * stride, stride);
    if (std::isnan(row[0])) break;
    rows.push_back(row);
  }
  return rows;
}

RecordingNews LiveSession::turn(const TakeTick& take) {
  loop_.set(controls_);
  loop_.update();
  RecordingNews news = follow_recording();
  pass_on(take);
  return news;
}

void LiveSession::pass_on(const TakeTick& take) {
  const auto stride = static_cast<std::size_t>(loop_.layout().stride());
  while (const std::size_t count = loop_.drain(rows_)) {
    for (std::size_t i = 0; i < count; ++i) {
      std::array<std::span<const double>, kMostLanes> lanes;
      for (std::size_t lane = 0; lane < kMostLanes; ++lane) {
        lanes[lane] = std::span(rows_).subspan((i * kMostLanes + lane) * stride, stride);
      }
      tick_ = loop_.drained_from() + i;
      if (take) take(lanes, tick_);
    }
    const auto last = std::span(rows_).subspan((count - 1) * newest_.size(), newest_.size());
    std::ranges::copy(last, newest_.begin());
    ticked_ = true;
  }
}

void LiveSession::record(SessionInfo about, std::vector<Parameters> lanes,
                         const std::filesystem::path& file, bool replaces) {
  last_ = {.file = file};
  opening_ = files_.run([file, replaces, about = std::move(about), lanes = std::move(lanes)] {
    return std::make_unique<Recorder>(file, about, lanes, replaces);
  });
}

void LiveSession::record(std::unique_ptr<Recorder> recorder) {
  last_ = {.file = recorder->out()};
  loop_.record(std::move(recorder));
}

RecordingNews LiveSession::follow_recording() {
  RecordingNews news;
  try {
    if (auto recorder = take_ready(opening_)) {
      news.note = lock_note(**recorder);
      loop_.record(std::move(*recorder));
      news.began = true;
    }
    if (loop_.recording() && loop_.recorder()->failed()) {
      last_.trouble = why_it_ended(*loop_.recorder());
      loop_.stop_recording();
    }
    if (std::shared_ptr<Recorder> done = loop_.take_recorded()) {
      last_.file = done->out();
      last_.rows = done->rows();
      last_.dropped = done->dropped();
      closing_ = files_.run([done] { done->finish(); });
      news.ended = true;
    }
    if (closing_.valid() &&
        closing_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
      closing_.get();
      last_.complete = news.complete = true;
    }
  } catch (const std::exception& e) {
    last_.failure = news.failure = e.what();
  }
  return news;
}

void LiveSession::complete_recording() {
  if (opening_.valid()) {  // no row was recorded
    const std::unique_ptr<Recorder> empty = opening_.get();
    empty->finish();
    std::filesystem::remove(empty->out());
  }
  loop_.finish_recording();
  if (closing_.valid()) closing_.get();
}

}  // namespace limpid
