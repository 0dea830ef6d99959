// The quantities the plots show, worked out from a row of the trace.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/plot/history.h"
#include "app/plot/plot_spec.h"
#include "core/dynamics/arm_description.h"
#include "core/tick/parameters.h"
#include "core/tick/row.h"

namespace limpid {

// Channels of one run, in this order; the joints' follow one by one.
enum class Channel : std::uint8_t {
  kind,          // 0 standard, 1 proposed
  error,         // |x_E| [rad]
  energy_total,  // [J]
  energy_commanded,
  human,           // |f1| [N m]
  human_estimate,  // |f1_hat|
  contact,         // |f2|
  limited,         // 1 while a motor gives all it can, else 0
  joints,          // x_E of each joint [rad]
};

// Largest torque of each motor: the parameters', or the arm's own where they leave it to the arm
// [N m].
std::vector<double> motor_limits(const ArmDescription& arm, const Parameters& p);

// What the curves of two runs are called, in front of what they show.
struct RunNames {
  std::string first, second;  // of one run both are empty
  bool twin = false;          // the second is another one now, not one of before

  friend bool operator==(const RunNames&, const RunNames&) = default;
};

class TraceChannels {
 public:
  explicit TraceChannels(const RowLayout& layout);

  // From now on these are the motors' largest torques [N m]; before, no motor is ever limited.
  void set_limits(std::vector<double> limits) { limits_ = std::move(limits); }
  // Whether the motor of a joint gives all it can in this row.
  bool limited(std::span<const double> row, int joint) const;

  int count() const { return static_cast<int>(Channel::joints) + layout_.dof(); }
  // Fills count() values.
  void values(std::span<const double> row, std::span<double> into) const;
  // Adds a row; in a history with room for two runs, the same row of the second one too.
  void append(History& history, std::span<const double> row,
              std::span<const double> again = {}) const;
  const RowLayout& layout() const { return layout_; }

  // The three plots: coordination error, controller energy, torques. A second run's channels follow
  // the first one's and are drawn beside them, if it has a name.
  std::vector<PlotSpec> plots(const RunNames& names) const;

 private:
  RowLayout layout_;
  std::vector<double> limits_;
};

}  // namespace limpid
