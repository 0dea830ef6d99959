#include "app/run/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/tick/arming.h"
#include "core/tick/motor_warmth.h"

namespace limpid {

namespace {

constexpr double kWildSpeed = 1e3;   // [rad/s]
constexpr double kWildTorque = 1e4;  // [N m]
constexpr double kWildError = 10;    // [rad]
constexpr double kLost = 1e3;        // times those
constexpr std::uint64_t kCalm = 10;  // rows; what swings ever higher passes through small values
constexpr double kWhole = 0.995;     // share of a force that counts as all of it

struct Excess {
  double times = 0;  // over its limit; not a number where the value is none
  int joint = 0;     // from 0
  Column column = Column::device_velocity;
};

bool beyond(const Excess& e, double times) { return !(e.times <= times); }

// Finds the value furthest beyond its limit.
Excess largest(const RowLayout& layout, std::span<const double> row) {
  Excess most;
  const auto look = [&](Column column, int joint, double value, double limit) {
    if (std::abs(value) <= limit) return;  // as in nearly every row: nothing to divide
    const double times = std::abs(value) / limit;
    if (std::isnan(most.times) || times <= most.times) return;
    most = {times, joint, column};
  };
  for (int i = 0; i < layout.dof(); ++i) {
    const auto at = [&](Column c) { return layout.in(row, c)[static_cast<std::size_t>(i)]; };
    look(Column::commanded_torque, i, at(Column::commanded_torque), kWildTorque);
    look(Column::device_velocity, i, at(Column::device_velocity), kWildSpeed);
    look(Column::proxy_velocity, i, at(Column::proxy_velocity), kWildSpeed);
    look(Column::proxy_position, i, at(Column::device_position) - at(Column::proxy_position),
         kWildError);
  }
  return most;
}

std::string in_words(const Excess& e) {
  struct Words {
    const char* what;
    double limit;
    const char* unit;
  };
  const auto words = [&]() -> Words {
    switch (e.column) {
      case Column::commanded_torque: return {"the torque commanded to joint", kWildTorque, "N m"};
      case Column::proxy_velocity: return {"the speed of the proxy's joint", kWildSpeed, "rad/s"};
      case Column::proxy_position:
        return {"the distance between device and proxy in joint", kWildError, "rad"};
      default: return {"the speed of the device's joint", kWildSpeed, "rad/s"};
    }
  }();
  if (!std::isfinite(e.times)) return fmt::format("{} {} is not finite", words.what, e.joint + 1);
  return fmt::format("{} {} became larger than {:.0f} {}", words.what, e.joint + 1, words.limit,
                     words.unit);
}

auto vector(std::span<const double> values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace

void DivergenceWatch::add(std::span<const double> row) {
  const std::uint64_t k = rows_++;
  if (lost_) return;
  const Excess excess = largest(layout_, row);
  if (!beyond(excess, 1)) {
    if (k >= wild_row_ + kCalm) why_.clear();
    return;
  }
  wild_row_ = k;
  if (why_.empty()) {
    since_row_ = k;
    since_ = layout_.in(row, Column::time)[0];
    why_ = in_words(excess);
  }
  lost_ = lost_ || beyond(excess, kLost);
}

void ForceTally::add(std::span<const double> row) {
  ++rows_;
  const auto state = static_cast<int>(layout_.in(row, Column::force_state)[0]);
  if (state == static_cast<int>(ForceState::on)) return;
  ++ticks_[state];
  ++without_;
}

std::string ForceTally::text(double tick) const {
  if (rows_ == 0) return "rows                     none: nothing was recorded\n";
  if (without_ == 0) return "force                    on all the time\n";
  const auto seconds = [&](std::uint64_t count) { return static_cast<double>(count) * tick; };
  std::string text =
      fmt::format("force off or reduced     {:.3f} s of {:.3f} s, without fade-ins\n",
                  seconds(without_), seconds(rows_));
  for (const auto& [state, count] : ticks_) {
    text += fmt::format("  for {:8.3f} s         {}\n", seconds(count),
                        force_text(static_cast<ForceState>(state)));
  }
  return text;
}

Summary::Summary(const RowLayout& layout, const ArmDescription& arm)
    : Summary(layout, slides_of(arm)) {
  for (const Joint& joint : arm.joints) {
    warming_.push_back(joint.continuous > 0 ? joint.name : std::string());
  }
}

// Adds the warmth of the arm's motors; `passed`: time since the row before [s].
void Summary::add_warmth(std::span<const double> row, double passed) {
  const auto warmth = layout_.in(row, Column::motor_warmth);
  bool held = false;
  for (std::size_t i = 0; i < warming_.size(); ++i) {
    if (warming_[i].empty()) continue;
    held = held || warmth[i] > kWarmFrom;
    if (warmth[i] <= all_.warmest) continue;
    all_.warmest = warmth[i];
    all_.warmest_joint = i;
  }
  all_.held_by_warmth += held ? passed : 0;
}

bool Summary::add(std::span<const double> row) {
  const auto at = [&](Column c) { return layout_.in(row, c); };
  const double before = std::exchange(time_, at(Column::time)[0]);
  add_warmth(row, all_.rows > 0 ? time_ - before : 0);
  const bool was_wild = watch_.wild();
  watch_.add(row);
  if (watch_.wild() && !was_wild) stable_ = all_;
  Totals& t = all_;
  ++t.rows;
  const double error =
      (vector(at(Column::device_position)) - vector(at(Column::proxy_position))).norm();
  const double contact = vector(at(Column::contact_torque)).norm();
  t.largest_error = std::max(t.largest_error, error);
  const bool memorable = contact >= t.largest_contact;
  if (memorable) t.memorable.assign(row.begin(), row.end());
  t.largest_contact = std::max(t.largest_contact, contact);
  t.in_contact += contact > 0 ? 1 : 0;
  t.human_square_sum += vector(layout_.human_torque(row)).squaredNorm();
  t.energy_total = at(Column::energy_total)[0];
  t.energy_commanded = at(Column::energy_commanded)[0];
  t.highest_total = std::max(t.highest_total, t.energy_total);
  const bool walls =
      static_cast<CouplingKind>(at(Column::kind)[0]) == CouplingKind::predictive && contact > 0;
  t.walls_held += walls && at(Column::governor)[0] < kWhole ? 1 : 0;
  t.torque_held += at(Column::torque_governor)[0] < kWhole ? 1 : 0;
  if (layout_.bodies() > 0) {
    t.to_objects = at(Column::energy_to_objects)[0];
    t.objects_gain = std::max(t.objects_gain, at(Column::objects_gain)[0]);
    t.most_awake = std::max(t.most_awake, at(Column::objects_awake)[0]);
    t.left_out = std::max(t.left_out, at(Column::objects_left_out)[0]);
    t.stood_still = at(Column::objects_stood_still)[0];
    t.turned_less = at(Column::objects_turned_less)[0];
  }
  return memorable;
}

std::string Summary::text() const {
  const Totals& t = totals();
  std::string text = fmt::format("ticks                    {}\n", all_.rows);
  if (watch_.lost()) {
    text += fmt::format("unstable                 since t = {:.3f} s: {}\nbefore this time\n",
                        watch_.since(), watch_.why());
  }
  text += fmt::format(
      "in contact               {:.0f} %\n"
      "largest |x_E|            {:.3f} {}\n"
      "largest |f2|             {:.4f} {}\n"
      "rms human torque         {:.4f} {}\n"
      "E_c total                {:.3f} mJ (highest {:.3f} mJ)\n"
      "E_c commanded            {:.3f} mJ\n",
      100 * t.share_in_contact(), 1e3 * units_.angles * t.largest_error, units_.milliangle,
      units_.torques * t.largest_contact, units_.torque, units_.torques * t.human_rms(),
      units_.torque, 1e3 * t.energy_total, 1e3 * t.highest_total, 1e3 * t.energy_commanded);
  const auto held = [&](const char* what, std::uint64_t ticks) {
    if (ticks == 0) return;
    text += fmt::format("{:<24} {} ticks: the hand may be given little more energy\n", what, ticks);
  };
  held("walls held back in", t.walls_held);
  held("torque held back in", t.torque_held);
  if (t.warmest > 0) {
    text += fmt::format(
        "warmth of the motors     at most {:.0f} % of the limit for hours of use ({}); the full "
        "torque was not available for {:.3f} s\n",
        100 * t.warmest, warming_[t.warmest_joint], t.held_by_warmth);
  }
  if (layout_.bodies() == 0) return text;
  text += fmt::format(
      "to objects               {:.3f} mJ\n"
      "objects gained           {:.6f} mJ at most\n"
      "objects that moved       {:.0f} of {} at the same time\n",
      1e3 * t.to_objects, 1e3 * t.objects_gain, t.most_awake, layout_.bodies());
  if (t.left_out > 0) {
    text +=
        fmt::format("contact points ignored   up to {:.0f} in a tick; these points give no force\n",
                    t.left_out);
  }
  if (t.stood_still > 0) {
    text += fmt::format(
        "objects stood still      {:.0f} ticks: the solver found no forces for the objects\n",
        t.stood_still);
  }
  if (t.turned_less > 0) {
    text += fmt::format(
        "objects turned less      {:.0f} ticks: a body of a mechanism turns by at most one radian "
        "per tick\n",
        t.turned_less);
  }
  return text;
}

std::vector<Summary::Number> Summary::numbers() const {
  const Totals& t = totals();
  std::vector<Number> numbers{
      {"in contact", "%", 100 * t.share_in_contact()},
      {"largest |x_E|", units_.milliangle, 1e3 * units_.angles * t.largest_error},
      {"largest |f2|", units_.torque, units_.torques * t.largest_contact},
      {"rms human torque", units_.torque, units_.torques * t.human_rms()},
      {"E_c total", "mJ", 1e3 * t.energy_total},
      {"E_c total, highest", "mJ", 1e3 * t.highest_total}};
  if (layout_.bodies() > 0) numbers.push_back({"to objects", "mJ", 1e3 * t.to_objects});
  return numbers;
}

std::string Summary::beside(std::span<const Summary* const> lanes,
                            std::span<const std::string> names) {
  std::string text = fmt::format("{:<24}", "");
  for (const std::string& name : names) text += fmt::format(" {:>16}", name);
  text += fmt::format(" {:<5}", "");
  for (std::size_t lane = 1; lane < lanes.size(); ++lane) text += fmt::format(" {:>10}", "ratio");
  text += '\n';
  std::vector<std::vector<Number>> numbers;
  for (const Summary* lane : lanes) numbers.push_back(lane->numbers());
  for (std::size_t i = 0; i < numbers[0].size(); ++i) {
    const double first = numbers[0][i].value;
    text += fmt::format("{:<24}", numbers[0][i].what);
    for (const auto& lane : numbers) text += fmt::format(" {:>16.4f}", lane[i].value);
    text += fmt::format(" {:<5}", numbers[0][i].unit);
    for (std::size_t lane = 1; lane < lanes.size(); ++lane) {
      const bool comparable = std::abs(first) > 1e-9;
      text += fmt::format(" {:>10}",
                          comparable ? fmt::format("{:.3g}", numbers[lane][i].value / first) : "-");
    }
    text += '\n';
  }
  for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
    const DivergenceWatch& watch = lanes[lane]->watch_;
    if (!watch.lost()) continue;
    text += fmt::format("{} is unstable since t = {:.3f} s: {}\n", names[lane], watch.since(),
                        watch.why());
  }
  return text;
}

}  // namespace limpid
