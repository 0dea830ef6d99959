// Frames of a maker's device: in each one a reading is taken and a force given, which is zero
// unless Limpid has asked for it within the last 5 ms.
#pragma once

#include <atomic>
#include <chrono>
#include <string>

#include "core/realtime/triple_buffer.h"
#include "devices/vendor/back_end.h"

namespace limpid {

using std::chrono::nanoseconds;

nanoseconds monotonic_now() noexcept;  // CLOCK_MONOTONIC

class Servo {
 public:
  // Longest life of a command's force; the watchdog that the device declares.
  static constexpr nanoseconds kForceLife = std::chrono::milliseconds(5);
  // Time without a frame after which the library is taken to hang.
  static constexpr nanoseconds kHang = std::chrono::milliseconds(50);

  struct Frame {
    VendorReading reading;
    nanoseconds moment{};
    bool cut = false;  // there is no force, as no command came in time
  };

  // `most`: force along each axis [N]. `news`: an eventfd that is told of each frame.
  Servo(double most, int news) : most_(most), news_(news) {}

  // Does a frame, in the thread that the back end has for them; false once they have to end. Any
  // error of the back end ends them without force.
  bool frame(VendorBackEnd& device) noexcept;
  // Ends the frames with an error, in their thread; the force is zero already.
  void fail(const std::string& error) noexcept;

  // The server's thread. A command of no force also ends the state in which there is none because
  // nothing was heard.
  void command(const TipVector& force, bool pushes) noexcept;
  // Takes the force away for good: it stays away until a command of no force has come.
  void cut() noexcept { cut_.store(true); }
  // Asks for the end of the frames, the last of which has no force.
  void end() noexcept { ending_.store(true); }

  bool take(Frame& newest) noexcept;
  nanoseconds last_frame() const noexcept { return nanoseconds(last_frame_.load()); }
  bool ended() const noexcept { return ended_.load(); }
  const std::string& error() const { return error_; }  // once ended() is true; empty: none

 private:
  struct Command {
    TipVector force{};
    bool pushes = false;
    nanoseconds moment{};
  };
  void tell() const noexcept;
  VendorForce force_now(const VendorReading& reading, nanoseconds now) noexcept;

  double most_;
  int news_;
  TripleBuffer<Command> commands_;
  TripleBuffer<Frame> frames_;
  std::atomic<bool> cut_{true}, ending_{false}, ended_{false};
  std::atomic<nanoseconds::rep> last_frame_{0};
  std::string error_;     // written before ended_
  bool enabled_ = false;  // a force was asked for since the last cut
  VendorReading last_;    // the newest one that was finite
};

}  // namespace limpid
