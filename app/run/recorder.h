// Writes every tick to a session file, from a thread of its own.
#pragma once

#include <array>
#include <atomic>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

#include "app/run/run_watch.h"
#include "core/realtime/trace_ring.h"
#include "core/tick/parameters.h"
#include "devices/files/session/session.h"

namespace limpid {

// The loop hands rows over without waiting; what finds no room is counted by the ring. Parameters
// that change travel beside the rows.
class Recorder {
 public:
  // Room for rows that wait to be written: half a minute at 1 kHz where a clock sets the pace;
  // little, which stays in the processor's cache, where push_waiting() does.
  static constexpr std::size_t kLiveRoom = 1 << 15;
  static constexpr std::size_t kWaitingRoom = 1 << 13;

  // Opens the file at once, so that what cannot be written is known before the first tick.
  // Errors: FileError.
  // `twin`: of a second run on the same hand, whose rows then come with every push.
  Recorder(const std::filesystem::path& out, const SessionInfo& info, const Parameters& initial,
           bool force, std::size_t room = kLiveRoom, const Parameters* twin = nullptr);
  ~Recorder();  // without finish(): leaves what was written as OUT.h5.part

  // The loop's side: allocates and waits for nothing. False if there was no room. A twin's two rows
  // stand one behind the other.
  bool push(std::span<const double> row) noexcept;
  // For loops without a clock to obey: waits for room instead of losing the row. False once the
  // recording has failed.
  bool push_waiting(std::span<const double> row);
  bool changed(const Parameters& now,
               std::size_t lane = kMainLane) noexcept;  // from the next row on
  // What the loop keeps of bodies at the first row, before that is pushed: RigStart's `world`.
  void begins(std::span<const double> world, std::size_t lane = kMainLane) noexcept;

  // The owner's side.
  // Notes something at a row that was pushed. Errors: FileError for a text that is too long, or
  // where kMostMarks are kept already.
  void mark(Mark mark);
  std::uint64_t newest() const noexcept { return rows() > 0 ? rows() - 1 : 0; }  // row
  std::size_t stride() const noexcept { return ring_.stride(); }                 // doubles a push
  bool of_twin() const noexcept { return lanes_ > 1; }
  std::uint64_t rows() const noexcept { return pushed_.load(std::memory_order_relaxed); }
  std::uint64_t dropped() const noexcept { return ring_.dropped() + lost_changes_.load(); }
  bool failed() const noexcept { return failed_.load(std::memory_order_acquire); }
  std::string error() const;                              // once failed
  bool is_locked() const { return writer_.is_locked(); }  // against other programs
  const std::filesystem::path& out() const { return out_; }
  // Writes what is left, with what there is to warn of, closes and renames. Errors: FileError, also
  // for what failed before.
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
  std::size_t lanes_;                          // runs
  std::array<Parameters, 2> known_;            // the writing thread's, of each run
  std::deque<RunWatch> watches_;               // the writing thread's, of each run
  std::array<std::vector<double>, 2> worlds_;  // of each run, with room for the largest
  bool begun_ = false;                         // the writing thread's: these are written
  std::vector<double> block_, of_lane_;        // the writing thread's
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

// Sentence about a recording whose file system has no locks, for people; empty where it has.
std::string lock_note(const Recorder& recorder);

// Sentence about a recording that has failed: that it ended by itself, and how to save it.
std::string why_it_ended(const Recorder& recorder);

}  // namespace limpid
