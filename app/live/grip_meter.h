// Measurement of the grip in a running session: it asks the loop for the excitation, keeps the rows
// meanwhile, and finds the grip beside loop and window.
#pragma once

#include <future>
#include <optional>
#include <string>

#include "app/base/tasks.h"
#include "app/live/live_session.h"
#include "app/run/measured_hand.h"

namespace limpid {

class GripMeter {
 public:
  explicit GripMeter(LiveSession& session) : session_(session) {}

  // Says why it cannot begin now, for people; empty: it can.
  std::string why_not() const;
  // Begins for the session's arm in this scene; does nothing where it cannot.
  void begin(const ArmDescription& arm, const Scene& scene);
  // Ends it without a result.
  void stop();
  // Forgets all, as another arm or device comes.
  void forget();

  // Takes the first lane's row of each tick.
  void take(std::span<const double> row);
  // Follows loop and work; to be called once a turn, after take().
  void update();

  bool busy() const { return asked_ || working_.valid(); }
  // Part of the excitation that is over, 0 to 1; and its time [s].
  double part() const;
  double time() const { return record_ ? record_->duration() : 0; }
  const MeasuredHand* found() const { return found_ ? &*found_ : nullptr; }

 private:
  void conclude();

  LiveSession& session_;
  std::uint32_t number_ = 0;  // of the newest measurement, as Controls has it
  bool asked_ = false;        // its rows are not all here
  ArmDescription arm_;
  Scene scene_;
  Parameters parameters_;
  std::optional<GripRecord> record_;
  std::optional<MeasuredHand> found_;
  std::future<MeasuredHand> working_;
  TaskQueue tasks_;  // last, to be destroyed first
};

}  // namespace limpid
