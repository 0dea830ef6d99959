// A further lane beside the loop's first: another simulated device in the same world, on the same
// hand, with settings of its own.
#pragma once

#include <memory>
#include <span>

#include "devices/simulated/rig.h"

namespace limpid {

class FurtherLane {
 public:
  // For threads other than the loop's: they allocate. `rig`: a simulated device with the loop's arm
  // and scene.
  void open(std::unique_ptr<Rig> rig);
  // Makes room for all that `first`, the loop's own rig, may ever begin this lane with.
  void room_for(const Rig& first) { first.present(start_); }
  void close() {
    rig_.reset();
    running_ = changed_ = false;
  }

  // For the loop, like all below. Runs a tick into `row`; begins at the state of `first` when
  // switched on. `row` must be the same at every call; it is NaN once switched off.
  void step(bool on, const Parameters& p, const Rig& first, const RigInput& input,
            std::span<double> row) noexcept;
  void begin_anew() noexcept { anew_ = true; }  // at the next step
  // Restarts between two ticks, as Rig::restart_here().
  void restart_here(const Vec3& target) noexcept;
  const RigStart& start() const { return start_; }  // of the last restart_here()
  void exchange(TouchWorld& world) noexcept { rig_->exchange(world); }
  bool runs() const { return running_; }  // since an earlier step
  const Parameters& parameters() const { return parameters_; }
  // Whether the parameters changed at the last step.
  bool changed() const { return changed_; }

 private:
  std::unique_ptr<Rig> rig_;
  Parameters parameters_;
  RigStart start_;
  bool running_ = false, anew_ = false, changed_ = false;
};

}  // namespace limpid
