// Faults of a run that must not pass without a word: energy that the coupling or contacts gave,
// speeds of no hand, rows that no arm could follow.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/run/energy_shares.h"
#include "app/run/motor_limits.h"
#include "app/run/summary.h"
#include "core/dynamics/arm_description.h"
#include "core/tick/parameters.h"
#include "devices/files/session/derived_columns.h"
#include "devices/files/session/session.h"

namespace limpid {

// Watches the rows of one lane in turn.
class RunWatch {
 public:
  // Fastest tip that a hand leads [m/s]: a thrown ball leaves most hands at 10 to 25.
  static constexpr double kFastestTip = 10;
  // Most that contacts may give by themselves [J].
  static constexpr double kFromContacts = 5e-3;

  // `p` are the parameters at the first row.
  RunWatch(const ArmDescription& arm, const RowLayout& layout, const Parameters& p);

  // Sets the parameters from row `row` on. Comes in the order of rows, before that row is added.
  void change(std::uint64_t row, const Parameters& p);
  void add(std::span<const double> row);

  // Returns the time in which a motor was at its limit [s].
  double at_limit() const { return at_limit_; }
  // Returns warnings, a sentence each; none of a run that is as it should be.
  std::vector<std::string> warnings() const;
  // Returns the warnings without instability, which RunEnd tells.
  std::vector<std::string> cautions() const;

 private:
  struct Change {
    std::uint64_t row;
    Parameters parameters;
  };
  // First time that something was beyond what is allowed, and its largest value.
  struct Excess {
    double since = -1, most = 0;  // [s]; -1: it never was
    std::string with;             // the settings at `since`, in words
    void take(double time, double value, double allowed, const std::string& settings);
  };

  void hold(const Parameters& p);  // from the next row on
  // Returns a bound of the speed of the device's tip [m/s], far cheaper than the speed.
  double tip_speed_bound(std::span<const double> row) const;

  ArmDescription arm_;
  RowLayout layout_;
  DerivedColumns tips_;
  double reach_;  // bound of a lever of the tip [m]
  DivergenceWatch diverged_;
  EnergyShares shares_;
  WithheldEnergy withheld_;
  std::optional<double> begun_at_;  // E_c at the first row [J]
  double contacts_begun_at_ = 0;    // what contacts had given until then [J]
  std::deque<Change> changes_;
  std::uint64_t rows_ = 0;
  std::vector<MotorLimit> limits_;  // of the motors
  double tick_ = 0, at_limit_ = 0;  // time with a motor at its limit [s]
  double promised_ = 0;             // largest E_c that the law allows [J]
  double whole_ = 0;                // largest E_c [J]
  bool at_fault_ = false;           // the law is known not to be passive
  bool by_port_ = false;            // the law promises what the hand is given, not E_c
  double before_ = 0, aside_ = 0;   // last E_c, and what it grew by under such laws [J]
  std::string settings_;            // in words
  Excess energy_, given_, contacts_, speed_;
};

// Returns a line for each lane whose motors were at their limit for so long [s].
std::string at_limit_text(std::span<const double> lanes);

// Appends a lane's warnings; a further lane's begin with "the second run: " or the like.
void add_warnings(const std::vector<std::string>& of_lane, std::size_t lane,
                  std::vector<std::string>& into);

// Watches the rows of all lanes of a recording, which need not fit into memory.
class SessionWatch {
 public:
  // `about` is the recording with its changes, whether it has its rows or not. Errors: FileError
  // and ParameterError where its settings cannot be read.
  SessionWatch(const Session& about, const std::string& file);
  // Takes whole rows of all lanes in turn.
  void take(LaneRows rows);
  std::vector<std::string> warnings() const;
  // Returns the time in which a motor of each lane was at its limit [s]; empty if the arm cannot be
  // read.
  std::vector<double> at_limit() const;

 private:
  std::size_t stride_;
  std::vector<RunWatch> lanes_;  // empty: the recording's arm cannot be read
};

// Returns the warnings of all lanes of a recording; none if its arm cannot be read. Errors:
// FileError and ParameterError where its settings cannot be read.
std::vector<std::string> warnings_of(const Session& session, const std::string& file);
// Joins warnings one a line, as recordings keep them.
std::string warnings_text(const std::vector<std::string>& warnings);

}  // namespace limpid
