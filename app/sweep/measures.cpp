#include "app/sweep/measures.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace limpid {
namespace {

constexpr double kNoMeasure = std::numeric_limits<double>::quiet_NaN();
constexpr double kFast = 20;  // lowest frequency that counts as chatter [Hz]

double yes(bool is) { return is ? 1 : 0; }
const Summary::Totals& of(const RunMeter& m) { return m.summary().totals(); }
bool lost(const RunMeter& m) { return m.summary().watch().lost(); }

Vec<kAnyDof> vector(std::span<const double> values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

constexpr MeasureInfo kTable[] = {
    {"stable", "comes to rest", "yes/no",
     "the device's motion becomes small; only for hands that jump and then hold still",
     [](const RunMeter& m) { return yes(!lost(m) && m.dies_away()); }},
    {"passive", "passive", "yes/no", "E_c never rises above a microjoule",
     [](const RunMeter& m) { return yes(!lost(m) && of(m).highest_total <= kNoEnergy); }},
    {"diverged", "diverged", "yes/no", "device or proxy moved as no arm can move",
     [](const RunMeter& m) { return yes(lost(m)); }},
    {"diverged_at", "diverged at", "s",
     "time at which the run diverged; not a number if it did not",
     [](const RunMeter& m) { return lost(m) ? m.summary().watch().since() : kNoMeasure; }},
    {"seconds", "length of the run", "s",
     "length of the run; shorter than planned if the run diverged or was stopped",
     [](const RunMeter& m) { return m.seconds(); }},
    {"energy", "energy that the coupling gave, at the end", "J", "E_c at the end",
     [](const RunMeter& m) { return of(m).energy_total; }},
    {"energy_highest", "highest energy that the coupling gave", "J", "highest E_c",
     [](const RunMeter& m) { return of(m).highest_total; }},
    {"energy_commanded", "energy given, without the device damping", "J",
     "E_c at the end without the device's own damping",
     [](const RunMeter& m) { return of(m).energy_commanded; }},
    {"commanded_highest", "highest energy given, without the device damping", "J",
     "highest E_c without the device's own damping, as in the paper's Fig. 6",
     [](const RunMeter& m) { return m.highest_commanded(); }},
    {"energy_port", "highest energy given to the hand", "J",
     "largest energy that was given to the human",
     [](const RunMeter& m) { return m.highest_port(); }},
    {"energy_beyond", "highest energy given to the hand minus the energy that bodies gave", "J",
     "largest energy given to the human minus the energy that bodies gave",
     [](const RunMeter& m) { return m.highest_beyond(); }},
    {"bodies_passive", "hand gets no more energy than bodies give", "yes/no",
     "the hand never gets more energy than the bodies gave, plus one microjoule",
     [](const RunMeter& m) { return yes(!lost(m) && m.highest_beyond() <= kNoEnergy); }},
    {"bodies_gain", "energy that bodies gain", "J",
     "largest energy of the bodies minus the energy at the start and the energy given to the "
     "bodies",
     [](const RunMeter& m) { return m.bodies_gain(); }},
    {"bodies_moved", "longest distance that a body moves", "m",
     "largest distance of a body's centre of mass from its start",
     [](const RunMeter& m) { return m.bodies_moved(); }},
    {"error_largest", "largest coordination error", "rad", "largest |x_E|",
     [](const RunMeter& m) { return m.units().angles * of(m).largest_error; }},
    {"error_slope", "coordination error divided by contact torque", "rad/(N m)",
     "slope of |x_E| against |f2|, least squares through the origin",
     [](const RunMeter& m) { return m.error_slope(); }},
    {"contact_largest", "largest contact torque", "N m", "largest |f2|",
     [](const RunMeter& m) { return m.units().torques * of(m).largest_contact; }},
    {"contact_share", "share of time in contact", "-", "share of the time that is spent in contact",
     [](const RunMeter& m) { return of(m).share_in_contact(); }},
    {"human_rms", "rms hand torque", "N m", "rms of the human's torque |f1|",
     [](const RunMeter& m) { return m.units().torques * of(m).human_rms(); }},
    {"chatter", "chatter of the tip", "m/s",
     "rms speed of the tip above 20 Hz in the second half of the run",
     [](const RunMeter& m) { return m.chatter(); }, true},
    {"felt_stiffness", "stiffness felt", "N/m",
     "slope of hand force against tip displacement in contact, in the direction of the mean force",
     [](const RunMeter& m) { return m.felt_stiffness(); }, true},
    {"wall", "stiffness of the wall", "N/m",
     "stiffness of the scene's wall, in scenes with one plane",
     [](const RunMeter& m) { return m.wall(); }},
    {"wall_felt", "stiffness felt at the wall, divided by the wall's stiffness", "-",
     "wall's force divided by the device's depth in the wall and by the wall's stiffness, in the "
     "second half of the run",
     [](const RunMeter& m) { return m.wall_felt(); }, true},
    {"wall_rattle", "vibration of the wall's force", "N",
     "rms of the wall's force above 20 Hz in the second half of the run",
     [](const RunMeter& m) { return m.wall_rattle(); }, true},
    {"rate_hardness", "rate-hardness of the wall", "N/m",
     "rise of the motors' force on the tip in the first 5 ms in the wall, divided by 5 ms and by "
     "the tip's speed in the 5 ms before (Lawrence et al. 2000)",
     [](const RunMeter& m) { return m.rate_hardness(); }, true},
    {"ripple", "ripple of the force at rest", "N",
     "rms deviation of the motors' force from its mean while the tip is in the wall, in the second "
     "half of the run; only for hands that rest there",
     [](const RunMeter& m) { return m.ripple(); }, true},
    {"felt_inertia", "inertia felt, divided by the arm's own inertia", "-",
     "inertia felt out of contact, divided by the arm's own inertia",
     [](const RunMeter& m) { return m.felt_inertia_damping()[0]; }, true},
    {"felt_damping", "damping felt", "N m s/rad", "damping felt out of contact, per joint",
     [](const RunMeter& m) { return m.felt_inertia_damping()[1]; }, true},
};

}  // namespace

std::span<const MeasureInfo> measure_table() { return kTable; }

std::string MeasureInfo::unit_in(const NormUnits& units) const {
  if (units.angles == 1 && units.torques == 1) return unit;
  const std::string_view mine = unit;
  if (mine == "rad") return units.angle;
  if (mine == "N m") return units.torque;
  if (mine == "rad/(N m)") return fmt::format("{}/{}", units.angle, units.torque);
  if (mine == "N m s/rad") return fmt::format("{} s/{}", units.torque, units.angle);
  return unit;
}

const MeasureInfo* find_measure(std::string_view name) {
  const auto* found = std::ranges::find(kTable, name, &MeasureInfo::name);
  return found == std::end(kTable) ? nullptr : found;
}

std::string words_of_measure(std::string_view name) {
  if (const MeasureInfo* measure = find_measure(name)) return measure->words;
  std::string words(name);
  std::ranges::replace(words, '_', ' ');
  return words;
}

RunMeter::RunMeter(const ArmDescription& arm, double T, std::uint64_t rows, bool felt,
                   const Object* wall, int bodies)
    : layout_(arm.dof(), bodies),
      summary_(layout_, arm),
      T_(T),
      rows_(rows),
      bodies_gain_(bodies > 0 ? 0 : kNoMeasure),
      bodies_moved_(bodies_gain_),
      wall_stiffness_(wall != nullptr ? wall->material.stiffness : kNoMeasure) {
  const HighPass fast(kFast, 1 / T);
  if (!felt) return;
  felt_.emplace(Felt{Arm<kAnyDof>(arm), {fast, fast, fast}});
  if (wall == nullptr) return;
  wall_.emplace(arm, *wall, T, rows / 2);
  hardness_.emplace(arm, *wall, T, rows / 2);
}

void RunMeter::add(std::span<const double> row) {
  summary_.add(row);
  const auto at = [&](Column c) { return layout_.in(row, c); };
  const std::uint64_t span = rows_ / kSpans;
  if (span > 0 && row_ / span < kSpans) {
    speed2_[row_ / span] += vector(at(Column::device_velocity)).squaredNorm();
  }
  if (!summary_.watch().wild()) {
    const double error =
        (vector(at(Column::device_position)) - vector(at(Column::proxy_position))).norm();
    const double contact = vector(at(Column::contact_torque)).norm();
    error_contact_ += error * contact;
    contact2_ += contact * contact;
    highest_port_ = std::max(highest_port_, at(Column::energy_port)[0]);
    highest_commanded_ = std::max(highest_commanded_, at(Column::energy_commanded)[0]);
    if (layout_.bodies() > 0) {
      add_bodies(row);
    } else {
      highest_beyond_ = highest_port_;
    }
    if (felt_) add_felt(row);
    if (wall_) wall_->add(layout_, row);
    if (hardness_) hardness_->add(layout_, row);
  }
  ++row_;
}

void RunMeter::add_bodies(std::span<const double> row) {
  const auto at = [&](Column c) { return layout_.in(row, c); };
  highest_beyond_ =
      std::max(highest_beyond_, at(Column::energy_port)[0] + at(Column::energy_to_objects)[0]);
  bodies_gain_ = std::max(bodies_gain_, at(Column::objects_gain)[0]);
  const auto pose = at(Column::body_pose);
  if (first_pose_.empty()) first_pose_.assign(pose.begin(), pose.end());
  for (std::size_t i = 0; i < pose.size(); i += kPoseNumbers) {
    const Vec3 now(pose[i], pose[i + 1], pose[i + 2]);
    const Vec3 first(first_pose_[i], first_pose_[i + 1], first_pose_[i + 2]);
    bodies_moved_ = std::max(bodies_moved_, (now - first).norm());
  }
}

void RunMeter::add_felt(std::span<const double> row) {
  const auto at = [&](Column c) { return vector(layout_.in(row, c)); };
  Felt& f = *felt_;
  const Vec<kAnyDof> v = at(Column::device_velocity);
  if (f.began && f.free) add_free(f, v);
  f.arm.frames(at(Column::device_position), f.frames);
  f.arm.inertia_bias(f.frames, v, f.M, f.Cv);
  const Vec3 tip = f.arm.tip(f.frames);
  if (f.began) {
    Vec3 fast = (tip - f.tip) / T_;
    for (std::size_t i = 0; i < 3; ++i) {
      auto& x = fast[static_cast<Eigen::Index>(i)];
      x = f.fast[i](x);
    }
    if (2 * row_ >= rows_) {
      f.fast2 += fast.squaredNorm();
      ++f.settled;
    }
  }
  f.began = true;
  f.tip = tip;
  f.v = v;
  f.f1 = vector(layout_.human_torque(row));
  f.free = at(Column::contact_torque).isZero(0);
  if (!f.free) add_contact(f, f.f1);
}

// Adds to Welford's sums of the hand's force at the tip, J^T F = f1.
void RunMeter::add_contact(Felt& f, const Vec<kAnyDof>& f1) const {
  f.arm.point_jacobian(f.frames, f.arm.dof() - 1, f.tip, f.J);
  const Mat3 JJ = f.J * f.J.transpose();
  const Vec3 force = JJ.ldlt().solve(f.J * f1);
  ++f.touching;
  const Vec3 dx = f.tip - f.mean_x, df = force - f.mean_f;
  f.mean_x += dx / f.touching;
  f.mean_f += df / f.touching;
  f.xx += dx * (f.tip - f.mean_x).transpose();
  f.xf += dx * (force - f.mean_f).transpose();
}

// Adds the tick that ends with velocity v.
void RunMeter::add_free(Felt& f, const Vec<kAnyDof>& v) const {
  const Vec<kAnyDof> inertial = f.M * ((v - f.v) / T_) + f.Cv, speed = (v + f.v) / 2;
  const Eigen::LDLT<Mat<kAnyDof>> M(f.M);
  const Vec<kAnyDof> Wi = M.solve(inertial), Wv = M.solve(speed);
  f.aa += inertial.dot(Wi);
  f.av += inertial.dot(Wv);
  f.vv += speed.dot(Wv);
  f.af += f.f1.dot(Wi);
  f.vf += f.f1.dot(Wv);
}

double RunMeter::error_slope() const {
  if (!(contact2_ > 0)) return kNoMeasure;
  return units().angles / units().torques * error_contact_ / contact2_;
}

double RunMeter::chatter() const {
  return felt_ && felt_->settled > 0 ? std::sqrt(felt_->fast2 / felt_->settled) : kNoMeasure;
}

double RunMeter::wall_felt() const { return wall_ ? wall_->felt() : kNoMeasure; }
double RunMeter::wall_rattle() const { return wall_ ? wall_->rattle() : kNoMeasure; }
double RunMeter::rate_hardness() const {
  return hardness_ ? hardness_->rate_hardness() : kNoMeasure;
}
double RunMeter::ripple() const { return hardness_ ? hardness_->ripple() : kNoMeasure; }

double RunMeter::felt_stiffness() const {
  if (!felt_) return kNoMeasure;
  const Vec3 n = felt_->mean_f.normalized();
  const double xx = n.dot(felt_->xx * n);
  return xx > 0 ? n.dot(felt_->xf * n) / xx : kNoMeasure;
}

std::array<double, 2> RunMeter::felt_inertia_damping() const {
  if (!felt_) return {kNoMeasure, kNoMeasure};
  const Felt& f = *felt_;
  const double determinant = f.aa * f.vv - f.av * f.av;
  if (!(determinant > 0)) return {kNoMeasure, kNoMeasure};
  return {(f.af * f.vv - f.vf * f.av) / determinant,
          units().torques / units().angles * (f.vf * f.aa - f.af * f.av) / determinant};
}

// A motion that grows, or does not die away, is unstable.
bool RunMeter::dies_away() const {
  const std::uint64_t span = rows_ / kSpans;
  if (span == 0 || row_ < kSpans * span) return false;
  const double last = speed2_.back();
  if (last < 1e-12 * speed2_.front()) return true;
  return last < speed2_.front() && last < speed2_[kSpans / 2];
}

}  // namespace limpid
