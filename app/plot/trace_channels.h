// Channels: the quantities that plots can show, from a row of the trace or computed from it.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/plot/history.h"
#include "app/plot/plot_spec.h"
#include "app/run/energy_shares.h"
#include "app/run/motor_limits.h"
#include "core/dynamics/arm_description.h"
#include "core/tick/parameters.h"
#include "core/tick/row.h"
#include "devices/files/session/derived_columns.h"
#include "devices/files/session/session_units.h"

namespace limpid {

// The first channels of one run, in this order; the joints' follow one by one, and after these all
// columns of the row.
enum class Channel : std::uint8_t {
  kind,          // number of the law
  error,         // |x_E| [rad]; [m] of an arm that only slides
  energy_total,  // [J]
  energy_commanded,
  energy_compensation,
  human,           // |f1| [N m]; [N] of an arm that only slides
  human_estimate,  // |f1_hat|
  contact,         // |f2|
  limited,         // 1 while a motor gives all it can, else 0
  joints,          // x_E of each joint [rad]; [m] of one that slides
};

// A channel as people and files know it.
struct ChannelInfo {
  std::string key;    // name in files, the same for every arm that has it: "device/position.2"
  std::string group;  // heading in the list of channels: "Device"
  std::string name;   // name in that list: "position, joint 2"
  std::string label;  // name of its curve: "device position 2"
  std::string unit;   // SI; "-": none
  std::string help;
  Ink ink = Ink::neutral;
  float shade = 0;
  bool zero = true;     // a plot keeps its zero in view
  bool seldom = false;  // hidden at first where two runs share a plot
};

// Place of a lane in a history: its first channel there, and after how many further ones the
// channels of joint 1 come that tell what the motors were asked for, and gave.
struct LaneOfHistory {
  int first = 0;
  std::size_t lane = kMainLane;
  int dof = 0;
  int motor_torque = 0, commanded_torque = 0, compensation_torque = 0, device_position = 0;
};

class TraceChannels {
 public:
  // `slides`: whether each joint slides, with channels in metres and newtons; empty: none.
  // `bodies`: names of the moving objects; those without a name go by their number.
  explicit TraceChannels(const RowLayout& layout, const std::vector<bool>& slides = {},
                         const std::vector<std::string>& bodies = {});
  // Takes from the arm which joints slide, and where its tips are. Without an arm all that is
  // computed from the tips is not a number.
  TraceChannels(const ArmDescription& arm, const RowLayout& layout,
                const std::vector<std::string>& bodies);

  // Sets the largest torques of a lane's motors from now on [N m]; before, no motor is ever
  // limited. A lane whose limits were never set has those of the first.
  void set_limits(std::vector<MotorLimit> limits, std::size_t lane = kMainLane) {
    limits_[lane] = std::move(limits);
  }
  // Returns whether the motor of a joint gives all it can in this row of a lane.
  bool limited(std::span<const double> row, int joint, std::size_t lane = kMainLane) const;

  int count() const { return static_cast<int>(infos_.size()); }
  std::span<const ChannelInfo> infos() const { return infos_; }
  // Finds a channel by its key; nothing if this arm has no such channel.
  std::optional<int> find(const std::string& key) const;
  // Fills count() values of a lane's row.
  void values(std::span<const double> row, std::span<double> into,
              std::size_t lane = kMainLane) const;
  // Adds the same row of each lane that the history has room for; nothing is known of lanes whose
  // row is missing or begins with NaN.
  void append(History& history, LaneRows rows) const;
  void append(History& history, std::span<const double> row) const {
    append(history, LaneRows(&row, 1));
  }
  const RowLayout& layout() const { return layout_; }
  // Returns the place of a lane in a history with these channels for each lane.
  LaneOfHistory lane(std::size_t lane) const;
  // Returns the columns that are computed from rows, the tips among them; null without an arm.
  const DerivedColumns* tips() const { return tips_ ? &*tips_ : nullptr; }

 private:
  std::span<const MotorLimit> limits_of(std::size_t lane) const {
    return limits_[limits_[lane].empty() ? kMainLane : lane];
  }
  void add_bodies(const std::vector<std::string>& names);
  void add_tips();
  void put_tips(std::span<const double> row, std::span<double> into) const;

  RowLayout layout_;
  NormUnits norms_;
  std::vector<ChannelInfo> infos_;
  // Place of a number in the row, for channels behind the first ones; the bodies' follow.
  struct Place {
    std::size_t at;
    std::optional<SessionUnits::Scaled> scaled;  // if it is shown in another unit
  };

  std::vector<Place> columns_;
  std::vector<std::optional<SessionUnits::Scaled>> positions_;  // of each joint
  std::array<std::vector<MotorLimit>, kMostLanes> limits_;
  std::optional<DerivedColumns> tips_;
};

// Returns the beginning of the marks for settings of a further lane alone: "twin: ".
std::string lane_mark(std::size_t lane);

// Energy that the coupling gave, followed through a history.
class EnergyAccount {
 public:
  // Accounts for the samples up to `end` that were not looked at yet; from the beginning if `end`
  // lies before them. The history has the channels of TraceChannels; `of`: from its lane().
  void follow(const History& history, SampleIndex end, const LaneOfHistory& of);

  // Shares of E_c as EnergyShares has them [J].
  double total() const { return shares_.total(); }
  double by_changes() const { return shares_.by_changes(); }
  double forgiven() const { return shares_.forgiven(); }
  double by_limits() const { return shares_.by_limits(); }
  double stored() const { return shares_.stored(); }
  double own() const { return shares_.own(); }
  double without_limits() const { return shares_.without_limits(); }

 private:
  void start_over() { *this = EnergyAccount(); }

  SampleIndex next_ = 0;
  double looked_until_ = -1;  // time up to which marks were looked at [s]
  bool begun_ = false;        // the run has rows
  EnergyShares shares_;
  WithheldEnergy withheld_;
};

}  // namespace limpid
