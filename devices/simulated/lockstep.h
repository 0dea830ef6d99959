// Several rigs on one hand, to compare what their differences change.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "devices/simulated/rig.h"

namespace limpid {

// Every lane has its own device, loop, parameters and row; the same hand leads all of them.
class Lockstep {
 public:
  struct Lane {
    Lane(const ArmDescription& arm, const Scene& scene, const Parameters& p)
        : rig(arm, scene), parameters(p), row(static_cast<std::size_t>(rig.layout().stride())) {}

    Rig rig;
    Parameters parameters;
    std::vector<double> row;  // of the last step
  };

  // Adds a lane with a simulated device; allocates.
  Lane& add(const ArmDescription& arm, const Scene& scene, const Parameters& p) {
    return *lanes_.emplace_back(std::make_unique<Lane>(arm, scene, p));
  }
  std::size_t size() const { return lanes_.size(); }
  Lane& operator[](std::size_t i) { return *lanes_[i]; }

  // Starts all lanes where the hand is. Precondition: arms of as many joints as `start`.
  void start(const RigStart& start) {
    for (const auto& lane : lanes_) lane->rig.start(lane->parameters, start);
  }
  // Runs the same tick in all lanes. Allocates nothing.
  void step(const RigInput& input) noexcept {
    for (const auto& lane : lanes_) lane->rig.step(lane->parameters, input, lane->row);
  }

 private:
  std::vector<std::unique_ptr<Lane>> lanes_;
};

}  // namespace limpid
