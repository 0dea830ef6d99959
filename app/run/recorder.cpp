#include "app/run/recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <exception>
#include <stdexcept>
#include <utility>

#include "app/run/lane_settings.h"
#include "devices/files/atomic_file.h"

namespace limpid {
namespace {

constexpr std::size_t kBlockRows = 4096;  // rows that SessionWriter writes at once
constexpr int kMostNaps = 10;             // of 2 ms, for a block to come together

// Returns the rows of the ring: `room`, but never more than 64 MiB.
std::size_t ring_rows(std::size_t room, std::size_t stride) {
  constexpr std::size_t kBytes = std::size_t{64} << 20;
  return std::min(room, std::bit_floor(kBytes / (stride * sizeof(double))));
}

// Returns `out`. Errors: std::invalid_argument where file and loop would have other lanes.
const std::filesystem::path& of_as_many_lanes(const std::filesystem::path& out,
                                              const SessionInfo& info, std::size_t lanes) {
  if (info.lanes() == lanes && lanes <= kMostLanes) return out;
  throw std::invalid_argument(
      fmt::format("{}: the file has {} runs, but there are settings of {} runs", out.string(),
                  info.lanes(), lanes));
}

std::size_t row_size(const SessionInfo& info) {
  return static_cast<std::size_t>(info.layout().stride());
}

// Returns memory that is there, so that taking in what a loop begins with does not ask for any.
std::vector<std::vector<double>> rooms(const SessionInfo& info, std::size_t lanes) {
  std::vector<std::vector<double>> worlds(lanes);
  if (info.bodies.empty()) return worlds;
  for (std::vector<double>& world : worlds) {
    world.assign(kMostWorld, 0.0);
    world.clear();
  }
  return worlds;
}

// Makes one watch for each lane; none if the recording does not say which arm its rows are of.
std::deque<RunWatch> watches_of(const SessionInfo& info, std::span<const Parameters> initial) {
  std::deque<RunWatch> watches;
  if (!info.arm) return watches;
  for (const Parameters& p : initial) watches.emplace_back(*info.arm, info.layout(), p);
  return watches;
}

}  // namespace

Recorder::Recorder(const std::filesystem::path& out, const SessionInfo& info,
                   std::span<const Parameters> initial, bool force, std::size_t room)
    : out_(of_as_many_lanes(out, info, initial.size())),
      // Packing costs nobody time where a clock sets the pace.
      writer_(out, info, force, room > kWaitingRoom ? Packing::yes : Packing::no),
      ring_(ring_rows(room, initial.size() * row_size(info)), initial.size() * row_size(info)),
      lanes_(initial.size()),
      known_(initial.begin(), initial.end()),
      watches_(watches_of(info, initial)),
      worlds_(rooms(info, lanes_)),
      block_(kBlockRows * ring_.stride()),
      thread_([this] { live(); }) {}

Recorder::~Recorder() {
  stop_.store(true);
  if (thread_.joinable()) thread_.join();
}

bool Recorder::push(std::span<const double> row) noexcept {
  if (!ring_.push(row)) return false;
  pushed_.fetch_add(1, std::memory_order_release);
  return true;
}

bool Recorder::push_waiting(std::span<const double> row) {
  while (ring_.size() == ring_.capacity() && !failed()) {
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  return !failed() && push(row);
}

bool Recorder::changed(const Parameters& now, std::size_t lane) noexcept {
  const bool kept = changes_.push({pushed_.load(std::memory_order_relaxed), now, lane});
  if (!kept) lost_changes_.fetch_add(1);
  return kept;
}

void Recorder::mark(Mark mark) {
  check_mark(mark, out_);
  const std::lock_guard lock(marks_mutex_);
  if (marked_ == kMostMarks) {
    throw FileError(fmt::format("{}: has {} marks already, the most that a recording can have",
                                out_.string(), marked_));
  }
  ++marked_;
  marks_.push_back(std::move(mark));
}

// Writes the marks; a recording without rows keeps none.
void Recorder::write_marks() {
  if (rows() == 0) return;
  const std::lock_guard lock(marks_mutex_);
  for (Mark& mark : marks_) {
    mark.tick = std::min(mark.tick, rows() - 1);
    writer_.append(mark);
  }
  marks_.clear();
}

void Recorder::begins(std::span<const double> world, std::size_t lane) noexcept {
  std::vector<double>& into = worlds_[lane];
  if (world.size() > into.capacity()) {
    lost_changes_.fetch_add(1);
    return;
  }
  into.assign(world.begin(), world.end());
}

std::string Recorder::error() const {
  const std::lock_guard lock(error_mutex_);
  return error_;
}

void Recorder::finish() {
  stop_.store(true);
  if (thread_.joinable()) thread_.join();
  if (failed()) throw FileError(error());
  std::vector<std::string> warnings;
  for (std::size_t lane = 0; lane < watches_.size(); ++lane) {
    add_warnings(watches_[lane].warnings(), lane, warnings);
  }
  writer_.close(warnings_text(warnings));
}

void Recorder::live() {
  try {
    while (true) {
      const bool last_round = stop_.load();
      write_changes();
      write_marks();
      write_rows();
      if (last_round && ring_.size() == 0) return;
      for (int i = 0; i < kMostNaps && ring_.size() < kBlockRows && !stop_.load(); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
      }
    }
  } catch (const std::exception& e) {
    const std::lock_guard lock(error_mutex_);
    error_ = e.what();
    failed_.store(true, std::memory_order_release);
  }
}

void Recorder::write_rows() {
  const std::size_t rows = ring_.pop(block_);
  const auto all = std::span<const double>(block_).first(rows * ring_.stride());
  if (rows > 0 && !std::exchange(begun_, true)) {
    for (std::size_t lane = 0; lane < lanes_; ++lane) writer_.append_world(worlds_[lane], lane);
  }
  const std::size_t stride = ring_.stride() / lanes_;
  for (std::size_t at = 0; at < all.size() && !watches_.empty(); at += stride) {
    watches_[at / stride % lanes_].add(all.subspan(at, stride));
  }
  if (lanes_ == 1) return writer_.append(all);
  for (std::size_t lane = 0; lane < lanes_; ++lane) {
    of_lane_.clear();
    for (std::size_t at = lane * stride; at < all.size(); at += ring_.stride()) {
      const auto row = all.subspan(at, stride);
      of_lane_.insert(of_lane_.end(), row.begin(), row.end());
    }
    writer_.append(of_lane_, lane);
  }
}

void Recorder::write_changes() {
  while (const auto change = changes_.pop()) {
    Parameters& known = known_[change->lane];
    for (const ParameterInfo* info : differing(change->parameters, known)) {
      // An empty text gives a value back to the arm.
      const std::string text = parameter_text(change->parameters, *info);
      writer_.append(SettingChange{change->row, std::string(info->key) + " = " + text},
                     change->lane);
    }
    known = change->parameters;
    if (!watches_.empty()) watches_[change->lane].change(change->row, known);
  }
}

std::string lock_note(const Recorder& recorder) {
  if (recorder.is_locked()) return {};
  return fmt::format("{}: the file system has no locks; no other program may record into this file",
                     recorder.out().string());
}

std::string why_it_ended(const Recorder& recorder) {
  return fmt::format(
      "the recording has ended by itself: {}; `limpid recover {}` saves the recorded part",
      recorder.error(), part_of(recorder.out()).string());
}

}  // namespace limpid
