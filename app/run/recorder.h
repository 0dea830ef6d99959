// Writes every tick to a session file, from a thread of its own.
#pragma once

#include <atomic>
#include <deque>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "app/run/run_watch.h"
#include "core/realtime/trace_ring.h"
#include "core/tick/parameters.h"
#include "devices/files/session/session.h"

namespace limpid {

// Writes rows that the loop hands over without waiting; the ring counts those that find no room.
// Changed parameters travel beside the rows.
class Recorder {
 public:
  // Room for rows that wait to be written. Live: half a minute at 1 kHz where a clock sets the
  // pace, or 64 MiB. Waiting: little, which stays in the processor's cache, for push_waiting().
  static constexpr std::size_t kLiveRoom = 1 << 15;
  static constexpr std::size_t kWaitingRoom = 1 << 13;

  // Opens the file at once, so that errors of writing are known before the first tick. `initial`:
  // the parameters of each lane that `info` has. Errors: FileError.
  Recorder(const std::filesystem::path& out, const SessionInfo& info,
           std::span<const Parameters> initial, bool force, std::size_t room = kLiveRoom);
  Recorder(const std::filesystem::path& out, const SessionInfo& info, const Parameters& initial,
           bool force, std::size_t room = kLiveRoom)
      : Recorder(out, info, std::span(&initial, 1), force, room) {}
  ~Recorder();  // without finish(): leaves what was written as OUT.h5.part

  // Hands over a row, for the loop: allocates nothing and waits for nothing. Returns false if there
  // was no room. The rows of all lanes stand one behind the other.
  bool push(std::span<const double> row) noexcept;
  // Waits for room instead of losing the row, for loops without a clock to obey. Returns false once
  // the recording has failed.
  bool push_waiting(std::span<const double> row);
  bool changed(const Parameters& now,
               std::size_t lane = kMainLane) noexcept;  // from the next row on
  // Takes what the loop keeps of bodies at the first row: RigStart's `world`. Comes before that
  // row.
  void begins(std::span<const double> world, std::size_t lane = kMainLane) noexcept;

  // Notes something at a row that was pushed; for the owner, as the calls below. Errors: FileError
  // for a text that is too long, or where kMostMarks are kept already.
  void mark(Mark mark);
  std::uint64_t newest() const noexcept { return rows() > 0 ? rows() - 1 : 0; }  // the newest row
  std::size_t stride() const noexcept { return ring_.stride(); }                 // doubles a push
  std::size_t lanes() const noexcept { return lanes_; }
  std::uint64_t rows() const noexcept { return pushed_.load(std::memory_order_relaxed); }
  std::uint64_t dropped() const noexcept { return ring_.dropped() + lost_changes_.load(); }
  std::uint64_t dropped_rows() const noexcept { return ring_.dropped(); }
  bool failed() const noexcept { return failed_.load(std::memory_order_acquire); }
  std::string error() const;                              // once failed
  bool is_locked() const { return writer_.is_locked(); }  // against other programs
  const std::filesystem::path& out() const { return out_; }
  // Writes the rest of the rows, and the warnings; closes and renames. Errors: FileError, also for
  // earlier failures.
  void finish();

 private:
  struct Change {
    std::uint64_t row = 0;
    Parameters parameters;
    std::size_t lane = kMainLane;
  };

  void live();
  void write_rows();
  void write_changes();
  void write_marks();

  std::filesystem::path out_;
  SessionWriter writer_;
  TraceRing ring_;
  SpscQueue<Change> changes_{256};
  std::size_t lanes_;
  std::vector<Parameters> known_;            // the writing thread's, for each lane
  std::deque<RunWatch> watches_;             // the writing thread's, for each lane
  std::vector<std::vector<double>> worlds_;  // for each lane, with room for the largest
  bool begun_ = false;                       // the writing thread's: worlds_ are written
  std::vector<double> block_, of_lane_;      // the writing thread's
  std::atomic<std::uint64_t> pushed_{0};
  std::atomic<std::uint64_t> lost_changes_{0};
  std::atomic<bool> stop_{false};
  std::atomic<bool> failed_{false};
  mutable std::mutex error_mutex_;
  std::string error_;
  std::mutex marks_mutex_;
  std::vector<Mark> marks_;  // not handed on yet
  std::size_t marked_ = 0;
  std::thread thread_;
};

// Returns a sentence for people about a recording whose file system has no locks; else empty.
std::string lock_note(const Recorder& recorder);

// Returns a sentence about a recording that has failed: that it ended by itself, and how to save
// it.
std::string why_it_ended(const Recorder& recorder);

}  // namespace limpid
