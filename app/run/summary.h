// Summary of a run or recording in a few lines: its figures, its time without force, its
// divergence.
#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/dynamics/arm_description.h"
#include "core/tick/row.h"
#include "devices/files/session/session.h"
#include "devices/files/session/session_units.h"

namespace limpid {

// Finds when a loop does what no arm can do. Watches rows in turn. A row is wild when a joint turns
// faster than 1e3 rad/s, is asked for more than 1e4 N m, or device and proxy are 10 rad apart. A
// loop that got there may come back, and has after ten rows that are not wild. At a thousand times
// those limits, or at a value that is no number, the loop is lost: unstable since the first wild
// row from which it did not come back.
class DivergenceWatch {
 public:
  explicit DivergenceWatch(const RowLayout& layout) : layout_(layout) {}

  void add(std::span<const double> row);

  bool wild() const { return !why_.empty(); }  // a row was, and the loop has not come back
  bool lost() const { return lost_; }
  // Returns the first wild row of those that wild() is about; only while wild().
  std::uint64_t since_row() const { return since_row_; }
  double since() const { return since_; }          // [s]
  const std::string& why() const { return why_; }  // fault of that row, in words

 private:
  RowLayout layout_;
  std::uint64_t rows_ = 0, since_row_ = 0, wild_row_ = 0;  // wild_row_: the last one
  double since_ = 0;
  bool lost_ = false;
  std::string why_;
};

// Counts how much of a recording was without force, and why.
class ForceTally {
 public:
  explicit ForceTally(const RowLayout& layout) : layout_(layout) {}

  void add(std::span<const double> row);
  // Returns lines for people, one for each reason; `tick` [s].
  std::string text(double tick) const;

 private:
  RowLayout layout_;
  std::uint64_t rows_ = 0, without_ = 0;
  std::map<int, std::uint64_t> ticks_;  // without full force, of each state
};

// Figures of a run. For a loop that became unstable: those up to then, and since when it was
// unstable.
class Summary {
 public:
  // `slides`: whether each joint slides; empty: none.
  explicit Summary(const RowLayout& layout, const std::vector<bool>& slides = {})
      : layout_(layout), units_(norm_units(slides)), watch_(layout) {}
  // Summarizes a run of this arm, also the warmth of those motors whose file says what they bear.
  Summary(const RowLayout& layout, const ArmDescription& arm);

  // Returns the units of norms over all joints, as its numbers have them.
  const NormUnits& units() const { return units_; }
  // Adds a row; returns whether it is the memorable one, for now.
  bool add(std::span<const double> row);
  double time() const { return time_; }  // of the last row [s]
  const DivergenceWatch& watch() const { return watch_; }
  // Returns the row of the strongest contact; the last row of a run without any.
  std::span<const double> memorable() const { return totals().memorable; }
  std::string text() const;
  // Compares lanes: their numbers side by side, and those of each further lane over the first's.
  static std::string beside(std::span<const Summary* const> lanes,
                            std::span<const std::string> names);

  struct Totals {
    std::uint64_t rows = 0;
    double largest_error = 0;                                          // |x_E| [rad]
    double largest_contact = 0;                                        // |f2| [N m]
    double human_square_sum = 0;                                       // of |f1| [N^2 m^2]
    double energy_total = 0, energy_commanded = 0, highest_total = 0;  // [J]
    std::uint64_t in_contact = 0;
    double to_objects = 0, objects_gain = 0;  // given to bodies, and the most they gained [J]
    double most_awake = 0;                    // bodies
    double left_out = 0;                      // most points at which bodies meet without pushing
    double stood_still = 0;                   // ticks in which forces of bodies were not found
    double turned_less = 0;                   // ticks in which mechanisms turned as far as they may
    // Ticks in which the account of energy held back the walls' force, and torque.
    std::uint64_t walls_held = 0, torque_held = 0;
    double warmest = 0;  // of the arm's motors [-]
    std::size_t warmest_joint = 0;
    double held_by_warmth = 0;  // time in which warmth left a motor less than its peak [s]
    std::vector<double> memorable;

    double share_in_contact() const { return static_cast<double>(in_contact) / counted(); }
    double human_rms() const { return std::sqrt(human_square_sum / counted()); }  // [N m]

   private:
    double counted() const { return rows > 0 ? static_cast<double>(rows) : 1; }
  };
  // Returns the totals; up to its instability for a loop that became unstable.
  const Totals& totals() const { return watch_.lost() ? stable_ : all_; }

 private:
  struct Number {
    const char* what;
    const char* unit;
    double value;
  };
  std::vector<Number> numbers() const;
  void add_warmth(std::span<const double> row, double passed);

  RowLayout layout_;
  NormUnits units_;
  std::vector<std::string> warming_;  // names of joints; empty: one whose motor has no model
  DivergenceWatch watch_;
  double time_ = 0;
  Totals all_;
  Totals stable_;  // totals before the present wild rows began
};

}  // namespace limpid
