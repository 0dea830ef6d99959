// Measures that a sweep can take of a run.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "app/run/hardness_meter.h"
#include "app/run/summary.h"
#include "app/run/wall_tap.h"
#include "core/dynamics/arm.h"
#include "core/math/high_pass.h"

namespace limpid {

class RunMeter;

struct MeasureInfo {
  const char* name;   // in plans and tables
  const char* words;  // in the window
  const char* unit;   // of arms that turn; "-" for none; "yes/no" is 1 or 0
  const char* what;
  double (*value)(const RunMeter&);
  bool felt = false;  // needs the arm's inertia and tip

  bool yes_no() const { return std::string_view(unit) == "yes/no"; }
  // Returns the unit of its values for an arm whose norms have these units.
  std::string unit_in(const NormUnits& units) const;
};

std::span<const MeasureInfo> measure_table();
const MeasureInfo* find_measure(std::string_view name);
// Returns a column's name in plain words: a measure's, or what a boundary finds.
std::string words_of_measure(std::string_view name);

// Energies up to this one count as zero [J].
inline constexpr double kNoEnergy = 1e-6;

// Takes a run's rows in turn. At any moment every measure has its value for the run so far, NaN
// where there is nothing to measure.
class RunMeter {
 public:
  // Measures a run of `rows` ticks of T [s] with `bodies` bodies; `wall`: the plane, if any.
  // `felt`: also those that need the arm's inertia and tip, which costs as much as a tick.
  RunMeter(const ArmDescription& arm, double T, std::uint64_t rows, bool felt,
           const Object* wall = nullptr, int bodies = 0);

  void add(std::span<const double> row);
  const Summary& summary() const { return summary_; }
  // Returns the units of angles and torques in its values: metres and newtons of arms that slide.
  const NormUnits& units() const { return summary_.units(); }

  double seconds() const { return static_cast<double>(row_) * T_; }
  // |x_E| over |f2|, least squares through the origin [rad/(N m) or m/N].
  double error_slope() const;
  double highest_port() const { return highest_port_; }            // [J]
  double highest_commanded() const { return highest_commanded_; }  // [J]
  // Most energy that the human was given beyond what bodies gave [J]; most that bodies had beyond
  // their initial energy and what they were given [J]; furthest that a body moved from its start
  // [m]. Without bodies the last two are NaN.
  double highest_beyond() const { return highest_beyond_; }
  double bodies_gain() const { return bodies_gain_; }
  double bodies_moved() const { return bodies_moved_; }
  // Stiffness of the wall [N/m]; felt stiffness over it [-]; rms of the wall's force above 20 Hz in
  // the second half [N].
  double wall() const { return wall_stiffness_; }
  double wall_felt() const;
  double wall_rattle() const;
  // See HardnessMeter [N/m, N].
  double rate_hardness() const;
  double ripple() const;
  double chatter() const;  // of the tip above 20 Hz in the second half, rms [m/s]
  // Slope of the hand's force over the tip's motion, along the mean force in contact [N/m].
  double felt_stiffness() const;
  // f1 = m M a + b v out of contact, least squares in the metric of M^-1: m [-], b [N m s/rad or N
  // s/m].
  std::array<double, 2> felt_inertia_damping() const;
  bool dies_away() const;  // the device's speed, over twentieths of the run

 private:
  // State of the measures that need `felt`.
  struct Felt {
    Arm<kAnyDof> arm;
    std::array<HighPass, 3> fast;
    Arm<kAnyDof>::Frames frames = {};
    Jacobian<kAnyDof> J = {};
    // Values of the previous row.
    bool began = false, free = false;
    Vec3 tip = Vec3::Zero();                // [m]
    Mat<kAnyDof> M = {};                    // [kg m^2]
    Vec<kAnyDof> Cv = {}, v = {}, f1 = {};  // [N m, rad/s, N m]
    // Sums over the second half, over rows in contact, and over free rows.
    double fast2 = 0, settled = 0;
    double touching = 0;
    Vec3 mean_x = Vec3::Zero(), mean_f = Vec3::Zero();
    Mat3 xx = Mat3::Zero(), xf = Mat3::Zero();
    double aa = 0, av = 0, vv = 0, af = 0, vf = 0;  // of M a + C v, v and f1, in M^-1
  };

  void add_bodies(std::span<const double> row);
  void add_felt(std::span<const double> row);
  void add_contact(Felt& f, const Vec<kAnyDof>& f1) const;
  void add_free(Felt& f, const Vec<kAnyDof>& v) const;

  RowLayout layout_;
  Summary summary_;
  double T_;
  std::uint64_t rows_, row_ = 0;
  double highest_port_ = 0, highest_commanded_ = 0, highest_beyond_ = 0, bodies_gain_,
         bodies_moved_;
  std::vector<double> first_pose_;  // of all bodies
  double error_contact_ = 0, contact2_ = 0;
  static constexpr std::size_t kSpans = 20;
  std::array<double, kSpans> speed2_{};  // sums over each span

  std::optional<Felt> felt_;
  double wall_stiffness_;
  std::optional<WallMeter> wall_;          // only with `felt`
  std::optional<HardnessMeter> hardness_;  // likewise
};

}  // namespace limpid
