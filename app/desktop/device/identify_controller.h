// Controller of an identification: the device is moved by itself, step by step as the window leads
// through it. Without a device, a simulated one that differs from its file is moved for practice.
#pragma once

#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "app/desktop/device/device_controller.h"
#include "app/experiments/identification.h"

namespace limpid {

class IdentifyController {
 public:
  enum class Phase { asking, moving, load, working, found };
  struct Done {
    Identification identification;
    std::vector<Drift> drift;      // since the last identification
    std::filesystem::path report;  // folder of the report
    std::string no_pictures;       // why there are no pictures
  };

  IdentifyController(LiveStage& live, DeviceController& devices, Notices& notices)
      : live_(live), devices_(devices), notices_(notices) {}
  ~IdentifyController() { stop(); }

  // Does the work of a frame; to be called once a frame.
  void update();

  Phase phase() const { return phase_; }
  bool busy() const { return phase_ != Phase::asking && phase_ != Phase::found; }
  // Returns whether the device is moved by itself now, or will be.
  bool moving() const { return phase_ == Phase::moving || phase_ == Phase::load; }
  bool simulated() const { return devices_.hub().in_use().empty(); }
  // Returns why an identification cannot begin; empty: it can.
  std::string why_not() const;
  // Returns the duration of the motion [s].
  double duration(const ExcitationPlan& plan) const;
  // Moves the device, which leaves the loop without force. The device's arm and limits replace
  // those of the order.
  void begin(IdentifyRequest order);
  void go_on();  // once the load is fixed to the tip
  // Stops the motion, forgets the result, and gives the device back to the loop.
  void stop();
  // Notes that the dialog was closed: stops a motion, but keeps work and results. Gives the device
  // back to the loop.
  void leave();
  // Remembers the result as the device's.
  void keep();

  const IdentifyProgress& progress() const { return *progress_; }  // of the motion
  const Done* done() const { return done_ ? &*done_ : nullptr; }
  const std::string& wrong() const { return wrong_; }  // why the last identification failed

 private:
  void move();
  void follow_motion();
  void follow_work();
  void fail(const std::string& why);

  LiveStage& live_;
  DeviceController& devices_;
  Notices& notices_;
  Phase phase_ = Phase::asking;
  IdentifyRequest request_;
  SimulatedBench bench_;  // simulates the device if there is none
  bool left_ = false;     // leave() was called while results were made
  std::string name_, id_, wrong_;
  std::shared_ptr<IdentifyProgress> progress_ = std::make_shared<IdentifyProgress>();
  std::future<IdentifyRun> moving_;
  std::optional<IdentifyRun> bare_;
  std::future<Done> working_;
  std::optional<Done> done_;
};

}  // namespace limpid
