// Where a story's hand goes, step by step.
#pragma once

#include <vector>

#include "core/dynamics/arm_description.h"
#include "devices/files/hand/hand_file.h"
#include "devices/files/toml_reader.h"

namespace limpid {

class StoryHand {
 public:
  StoryHand(const ArmDescription& arm, std::string where, std::filesystem::path folder)
      : arm_(arm), where_(std::move(where)), folder_(std::move(folder)) {}

  // Takes in the `hand` of a step from `begins` to `ends` [s]: a file, or points with their times
  // after the step's beginning. Without one the hand stays. Errors: FileError, also for points that
  // the arm does not reach.
  void read(const TomlTable& step, double begins, double ends);

  HandPath path() const;

 private:
  void read_points(const TomlTable& step, double begins, double ends);
  void read_file(const TomlTable& step, const std::string& file, double begins, double ends);
  void add(double time, const Vec3& point, std::uint32_t line);

  const ArmDescription& arm_;
  std::string where_;
  std::filesystem::path folder_;
  std::vector<double> time_;
  std::vector<Vec3> position_;
  Eigen::VectorXd near_;  // a configuration with the tip on the last point [rad]
};

}  // namespace limpid
