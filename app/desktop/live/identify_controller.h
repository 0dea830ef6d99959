// A device that is moved by itself to be identified, step by step as the window leads through it.
// In place of the virtual arm one that is unlike its file is moved, to try it on.
#pragma once

#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "app/desktop/live/device_controller.h"
#include "app/study/identification.h"

namespace limpid {

class IdentifyController {
 public:
  enum class Phase { asking, moving, load, working, found };
  struct Done {
    Identification identification;
    std::vector<Drift> drift;      // since last time
    std::filesystem::path report;  // folder of it
    std::string no_pictures;       // why there are none
  };

  IdentifyController(LiveSession& live, DeviceController& devices, Notices& notices)
      : live_(live), devices_(devices), notices_(notices) {}
  ~IdentifyController() { stop(); }

  // Once a frame.
  void update();

  Phase phase() const { return phase_; }
  bool busy() const { return phase_ != Phase::asking && phase_ != Phase::found; }
  // The device is, or will be, moved by itself.
  bool moving() const { return phase_ == Phase::moving || phase_ == Phase::load; }
  bool simulated() const { return devices_.hub().in_use().empty(); }
  // Why it cannot begin; empty: it can.
  std::string why_not() const;
  // How long it will move [s].
  double duration(const ExcitationPlan& plan) const;
  // Moves the device, which leaves the loop for it, without its force; of the order the arm and the
  // limits are the device's.
  void begin(IdentifyRequest order);
  void go_on();  // the load is fixed to the tip
  // No motion; what was found is forgotten, and the device comes back into the loop.
  void stop();
  // Nobody looks at it any more: what moves stops, what was found stays to be looked at again, and
  // the device comes back into the loop.
  void leave();
  // What was found is the device's from now on.
  void keep();

  const IdentifyProgress& progress() const { return *progress_; }  // while it moves
  const Done* done() const { return done_ ? &*done_ : nullptr; }
  const std::string& wrong() const { return wrong_; }  // why the last one came to nothing

 private:
  void move();
  void follow_motion();
  void follow_work();
  void fail(const std::string& why);

  LiveSession& live_;
  DeviceController& devices_;
  Notices& notices_;
  Phase phase_ = Phase::asking;
  IdentifyRequest request_;
  SimulatedBench bench_;  // in place of the virtual arm
  bool left_ = false;     // before it was found
  std::string name_, id_, wrong_;
  std::shared_ptr<IdentifyProgress> progress_ = std::make_shared<IdentifyProgress>();
  std::future<IdentifyRun> moving_;
  std::optional<IdentifyRun> bare_;
  std::future<Done> working_;
  std::optional<Done> done_;
};

}  // namespace limpid
