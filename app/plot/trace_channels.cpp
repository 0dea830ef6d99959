#include "app/plot/trace_channels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "core/coupling/laws.h"

namespace limpid {

namespace {

// Returns whether the mark is of a setting of this lane. Settings of hand, device and loop are all
// lanes'.
bool changes(const PlotMark& mark, std::size_t lane) {
  std::string_view key = mark.key;
  std::size_t of = kMainLane;
  for (std::size_t i = 1; i < kMostLanes; ++i) {
    const std::string begins = lane_mark(i);
    if (!key.starts_with(begins)) continue;
    of = i;
    key.remove_prefix(begins.size());
  }
  if (key.find('.') == std::string_view::npos || (of != kMainLane && of != lane)) return false;
  const ParameterInfo* info = find_parameter(key);
  return of == lane || info == nullptr || !of_controller(*info);
}

double norm(std::span<const double> v) {
  double sum = 0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

constexpr int kJointInks = static_cast<int>(Ink::joint_7) - static_cast<int>(Ink::joint_1) + 1;

using enum Ink;

// Describes the channels computed from a row; the joints' are those of x_E.
std::vector<ChannelInfo> first_channels(int dof, const NormUnits& units,
                                        const std::vector<std::string>& joint_units) {
  std::vector<ChannelInfo> infos{
      {"coupling/kind", "Coupling", "law", "law", "-", kLawNumbers.data(), neutral},
      {"coordination/error", "Coordination error", "of all joints, |x_E|", "|x_E|", units.angle,
       "distance between device and proxy, norm of all joints", proxy},
      {"energy/controller_total", "Energy", "controller, E_c", "E_c", "J",
       "E_c with the device's own damping", energy},
      {"energy/controller_commanded", "Energy", "controller, commanded", "E_c commanded", "J",
       "work of motors and proxy only. E_c also subtracts the energy that the device's own damping "
       "took; E_c is the energy in the passivity condition",
       energy, 0.5f, true, true},
      {"energy/compensation", "Energy", "motors, against the device's own forces", "compensation",
       "J",
       "part of E_c that the motors gave to compensate for weight, springs and friction of the "
       "device",
       energy, 0.3f, true, true},
      {"hand/torque_norm", "Hand", "torque, |f1|", "|f1|", units.torque,
       "torque of the hand on the device; for a real device it is the observer's estimate", hand},
      {"hand/torque_estimate_norm", "Hand", "torque as observed, |f1_hat|", "|f1| estimate",
       units.torque,
       "the observer's estimate of the hand's torque, computed under every law; only proposed and "
       "predictive use it",
       hand, 0.55f, true, true},
      {"proxy/contact_torque_norm", "Proxy", "contact torque, |f2|", "|f2|", units.torque,
       "torque of the scene on the proxy", contact},
      {"device/limited", "Device", "a motor at its limit", "at limit", "-",
       "1 while a motor gives its largest torque", device},
  };
  for (int j = 0; j < dof; ++j) {
    const std::string joint = std::to_string(j + 1);
    infos.push_back({"coordination/error." + joint, "Coordination error", "joint " + joint,
                     "x_E " + joint,
                     joint_units[joint_units.size() == 1 ? 0 : static_cast<std::size_t>(j)],
                     "position of the device minus position of the proxy",
                     static_cast<Ink>(static_cast<int>(joint_1) + j % kJointInks)});
  }
  return infos;
}

struct Group {
  std::string_view path;
  const char* name;
  Ink ink;
};
constexpr std::array kGroups{
    Group{"device", "Device", device},  Group{"proxy", "Proxy", proxy},
    Group{"hand", "Hand", hand},        Group{"coupling", "Coupling", neutral},
    Group{"energy", "Energy", energy},  Group{"contact", "Contacts", contact},
    Group{"timing", "Timing", neutral}, Group{"objects", "Objects", neutral}};

static_assert(std::ranges::all_of(kColumnInfo, [](const ColumnInfo& column) {
  const std::string_view path(column.path + 1);
  const std::string_view folder = path.substr(0, path.find('/'));
  return column.column == Column::time ||
         std::ranges::any_of(kGroups, [&](const Group& group) { return group.path == folder; });
}));

// Channels of each body, in this order: its place, and how fast it goes and turns.
constexpr std::size_t kOfBody = 5;

// Words for the axes of the tips. The tips' channels come last in a row of values: where the tips
// are, and forces at them, as hands and eyes know them.
constexpr std::array<std::string_view, 3> kAxisWords{"forward", "to the left", "upward"};
constexpr std::size_t kOfTips = 2 * (3 + 1) + 2;

// Names the parts of a column; a single one has no name.
std::string part_name(ColumnWidth width, int part) {
  constexpr std::array kAxes{"x", "y", "z"};
  const char* axis = kAxes[static_cast<std::size_t>(part % 3)];
  switch (width) {
    case ColumnWidth::one:
    case ColumnWidth::if_bodies: return "";
    case ColumnWidth::poses:
    case ColumnWidth::velocities: break;  // bodies have channels of their own
    case ColumnWidth::three:
    case ColumnWidth::three_if_bodies: return axis;
    case ColumnWidth::four: return std::string(1, "wxyz"[part]);
    case ColumnWidth::dof: return "joint " + std::to_string(part + 1);
    case ColumnWidth::contacts: return "contact " + std::to_string(part / 3 + 1) + " " + axis;
  }
  return "";
}

// Returns whether a column has many numbers for each body, of which people want a few.
bool of_bodies(const ColumnInfo& column) {
  return column.width == ColumnWidth::poses || column.width == ColumnWidth::velocities;
}

ChannelInfo column_channel(const ColumnInfo& column, int part, const std::string& unit) {
  const std::string path = column.path + 1;  // without the slash
  const std::string start = path.substr(0, path.find('/'));
  const auto* group = std::ranges::find(kGroups, start, &Group::path);
  std::string what = path.substr(start.size() + 1);
  std::ranges::replace(what, '_', ' ');
  ChannelInfo info{.key = path,
                   .group = group->name,
                   .name = what,
                   .label = start + " " + what,
                   .unit = unit,
                   .help = column.what,
                   .ink = group->ink};
  if (const std::string name = part_name(column.width, part); !name.empty()) {
    info.key += "." + std::to_string(part + 1);
    info.name += ", " + name;
    info.label += " " + (name.starts_with("joint ") ? name.substr(6) : name);
    if (column.width == ColumnWidth::dof) {
      info.ink = static_cast<Ink>(static_cast<int>(joint_1) + part % kJointInks);
    }
  }
  // Positions have no zero worth looking at.
  info.zero = info.unit != "m" && !(info.unit == "rad" && what.ends_with("position"));
  return info;
}

}  // namespace

void EnergyAccount::follow(const History& history, SampleIndex end, const LaneOfHistory& of) {
  if (end < next_) start_over();
  next_ = std::max(next_, history.first());
  // A mark placed at the last sample, after that was looked at, counts too.
  auto mark = std::ranges::lower_bound(history.marks(), looked_until_, {}, &PlotMark::time);
  for (; next_ < end; ++next_) {
    const double time = history.time(next_);
    for (; mark != history.marks().end() && mark->time <= time; ++mark) {
      if (mark->key == kResetMark) {
        const SampleIndex at = next_;
        start_over();
        next_ = at;
      } else if (changes(*mark, of.lane)) {
        shares_.change(mark->time);
      }
    }
    looked_until_ = time;
    const auto value = [&](Channel c) {
      return history.value(of.first + static_cast<int>(c), next_);
    };
    const double energy = static_cast<double>(value(Channel::energy_total)) -
                          static_cast<double>(value(Channel::energy_compensation));
    if (std::isnan(energy)) {  // this run had not begun yet
      begun_ = false;
      continue;
    }
    const auto of_joint = [&](int place) {
      return [&history, k = next_, first = of.first + place](int j) {
        return static_cast<double>(history.value(first + j, k));
      };
    };
    const auto commanded = of_joint(of.commanded_torque), own = of_joint(of.compensation_torque);
    if (!std::exchange(begun_, true)) {
      const auto x_E = of_joint(static_cast<int>(Channel::joints));
      double twice = 0;
      for (int j = 0; j < of.dof; ++j) twice -= commanded(j) * x_E(j);
      shares_.begin(std::max(0.0, 0.5 * twice));
      withheld_.begin();
    }
    const double withheld = withheld_.add(
        of.dof, of_joint(of.motor_torque), [&](int j) { return commanded(j) + own(j); },
        of_joint(of.device_position));
    shares_.take(time, energy, withheld, value(Channel::limited) > 0.5f);
  }
}

TraceChannels::TraceChannels(const RowLayout& layout, const std::vector<bool>& slides,
                             const std::vector<std::string>& bodies)
    : layout_(layout),
      norms_(norm_units(slides)),
      positions_(static_cast<std::size_t>(layout.dof())) {
  const SessionUnits units(layout, slides);
  const ColumnInfo& position = kColumnInfo[static_cast<std::size_t>(Column::device_position)];
  infos_ = first_channels(layout.dof(), norms_, units.units(position));
  for (const SessionUnits::Scaled& scaled : units.scaled()) {
    if (scaled.column != Column::device_position) continue;
    positions_[static_cast<std::size_t>(scaled.part)] = scaled;
  }
  for (const ColumnInfo& column : kColumnInfo) {
    if (column.column == Column::time || find(column.path + 1) || of_bodies(column)) continue;
    const std::vector<std::string> of_parts = units.units(column);
    for (int part = 0; part < layout.width(column.column); ++part) {
      const std::string& unit = of_parts[of_parts.size() == 1 ? 0 : static_cast<std::size_t>(part)];
      infos_.push_back(column_channel(column, part, unit));
      Place place{static_cast<std::size_t>(layout.offset(column.column) + part), {}};
      for (const SessionUnits::Scaled& scaled : units.scaled()) {
        if (scaled.column == column.column && scaled.part == part) place.scaled = scaled;
      }
      columns_.push_back(place);
    }
  }
  add_bodies(bodies);
  add_tips();
}

TraceChannels::TraceChannels(const ArmDescription& arm, const RowLayout& layout,
                             const std::vector<std::string>& bodies)
    : TraceChannels(layout, slides_of(arm), bodies) {
  tips_.emplace(arm);
}

void TraceChannels::add_tips() {
  struct Side {
    std::string path;
    const char* name;
    Ink ink;
  };
  for (const Side& side : {Side{"device", "Device", device}, Side{"proxy", "Proxy", proxy}}) {
    for (std::size_t i = 0; i < kAxisWords.size(); ++i) {
      const std::string axis(1, static_cast<char>('x' + i));
      infos_.push_back({.key = side.path + "/tip." + std::to_string(i + 1),
                        .group = side.name,
                        .name = "tip, " + axis,
                        .label = side.path + " tip " + axis,
                        .unit = "m",
                        .help = "where the tip is, " + std::string(kAxisWords[i]),
                        .ink = side.ink,
                        .zero = false});
    }
    infos_.push_back({.key = side.path + "/tip_speed",
                      .group = side.name,
                      .name = "speed of the tip",
                      .label = side.path + " tip speed",
                      .unit = "m/s",
                      .help = "how fast the tip moves",
                      .ink = side.ink});
  }
  infos_.push_back({.key = "coordination/gap",
                    .group = "Coordination error",
                    .name = "gap of the tips",
                    .label = "gap",
                    .unit = "m",
                    .help = "distance between the tips of device and proxy; in contact it tells "
                            "how deep the device's tip is in the object that the proxy touches",
                    .ink = proxy});
  infos_.push_back({.key = "contact/total_force_norm",
                    .group = "Contacts",
                    .name = "force at the tip, |F|",
                    .label = "|F|",
                    .unit = "N",
                    .help = "total force of all contacts of the scene on the proxy",
                    .ink = contact});
}

void TraceChannels::put_tips(std::span<const double> row, std::span<double> into) const {
  std::ranges::fill(into, std::numeric_limits<double>::quiet_NaN());
  if (!tips_) return;
  const DerivedColumns::Values known = tips_->of(DerivedColumns::from(layout_, row));
  for (std::size_t side = 0; side < 2; ++side) {
    const Vec3 &tip = known[2 * side], &velocity = known[2 * side + 1];
    std::ranges::copy(tip, into.begin() + static_cast<std::ptrdiff_t>(4 * side));
    into[4 * side + 3] = velocity.norm();
  }
  into[8] = (known[0] - known[2]).norm();
  into[9] = known[kTotalForce].norm();
}

void TraceChannels::add_bodies(const std::vector<std::string>& names) {
  struct Quantity {
    const char *key, *unit, *help;
  };
  constexpr std::array<Quantity, kOfBody> kQuantities{{
      {"x", "m", "position of its centre of mass, forward"},
      {"y", "m", "position of its centre of mass, to the left"},
      {"z", "m", "height of its centre of mass"},
      {"speed", "m/s", "how fast its centre of mass moves"},
      {"turning", "rad/s", "how fast it turns, about any axis"},
  }};
  for (std::size_t i = 0; i < static_cast<std::size_t>(layout_.bodies()); ++i) {
    std::string body = i < names.size() ? names[i] : "object " + std::to_string(i + 1);
    // The second body of one name has its number as well.
    if (find("objects/" + body + ".x")) body += " (" + std::to_string(i + 1) + ")";
    for (const Quantity& q : kQuantities) {
      infos_.push_back(
          {.key = "objects/" + body + "." + q.key,
           .group = "Objects",
           .name = body + ", " + q.key,
           .label = body + " " + q.key,
           .unit = q.unit,
           .help = q.help,
           .ink = static_cast<Ink>(static_cast<int>(joint_1) + static_cast<int>(i) % kJointInks),
           .zero = q.unit != std::string_view("m")});
    }
  }
}

std::optional<int> TraceChannels::find(const std::string& key) const {
  const auto found = std::ranges::find(infos_, key, &ChannelInfo::key);
  if (found == infos_.end()) return std::nullopt;
  return static_cast<int>(found - infos_.begin());
}

LaneOfHistory TraceChannels::lane(std::size_t lane) const {
  const auto of = [this](Column column) {
    const std::string path = kColumnInfo[static_cast<std::size_t>(column)].path + 1;
    return *find(path + ".1");
  };
  return {static_cast<int>(lane) * count(),
          lane,
          layout_.dof(),
          of(Column::motor_torque),
          of(Column::commanded_torque),
          of(Column::compensation_torque),
          of(Column::device_position)};
}

bool TraceChannels::limited(std::span<const double> row, int joint, std::size_t lane) const {
  return at_limit(layout_, row, limits_of(lane), joint);
}

void TraceChannels::values(std::span<const double> row, std::span<double> into,
                           std::size_t lane) const {
  const auto at = [&](Column c) { return layout_.in(row, c); };
  const auto put = [&](Channel c, double value) { into[static_cast<std::size_t>(c)] = value; };
  const auto x1 = at(Column::device_position);
  const auto x2 = at(Column::proxy_position);
  const std::span<double> joints = into.subspan(static_cast<std::size_t>(Channel::joints));
  const auto shown = [](const std::optional<SessionUnits::Scaled>& scaled, double x) {
    return scaled ? SessionUnits::filed(*scaled, x).value : x;
  };
  const auto torque = [&](std::span<const double> torques) {
    return norm(torques) * norms_.torques;
  };
  std::ranges::transform(x1, x2, joints.begin(), std::minus{});
  const double error = norm(joints.first(x1.size()));
  for (std::size_t j = 0; j < x1.size(); ++j) joints[j] = shown(positions_[j], joints[j]);
  put(Channel::kind, at(Column::kind)[0]);
  put(Channel::error, error * norms_.angles);
  put(Channel::energy_total, at(Column::energy_total)[0]);
  put(Channel::energy_commanded, at(Column::energy_commanded)[0]);
  put(Channel::energy_compensation, at(Column::energy_compensation)[0]);
  put(Channel::human, torque(layout_.human_torque(row)));
  put(Channel::human_estimate, torque(at(Column::hand_torque_estimate)));
  put(Channel::contact, torque(at(Column::contact_torque)));
  put(Channel::limited, any_at_limit(layout_, row, limits_of(lane)) ? 1 : 0);
  const auto rest = joints.subspan(x1.size());
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    rest[i] = shown(columns_[i].scaled, row[columns_[i].at]);
  }
  auto of_bodies = rest.subspan(columns_.size());
  const auto poses = at(Column::body_pose), velocities = at(Column::body_velocity);
  for (std::size_t i = 0; i < static_cast<std::size_t>(layout_.bodies()); ++i) {
    const auto velocity = velocities.subspan(i * kVelocityNumbers, kVelocityNumbers);
    std::ranges::copy(poses.subspan(i * kPoseNumbers, 3), of_bodies.begin());
    of_bodies[3] = norm(velocity.first(3));
    of_bodies[4] = norm(velocity.last(3));
    of_bodies = of_bodies.subspan(kOfBody);
  }
  put_tips(row, of_bodies.first(kOfTips));
}

void TraceChannels::append(History& history, LaneRows rows) const {
  const auto one = static_cast<std::size_t>(count());
  constexpr auto kMost = static_cast<std::size_t>(Channel::joints) + kMaxDof + kMaxStride + kOfTips;
  std::array<double, kMostLanes * kMost> all;
  const auto used = std::span(all).first(static_cast<std::size_t>(history.channels()));
  for (std::size_t lane = 0; lane * one < used.size(); ++lane) {
    const std::span<double> into = used.subspan(lane * one, one);
    if (lane < rows.size() && !rows[lane].empty() && !std::isnan(rows[lane][0])) {
      values(rows[lane], into, lane);
    } else {
      std::ranges::fill(into, std::numeric_limits<double>::quiet_NaN());
    }
  }
  history.append(layout_.in(rows[kMainLane], Column::time)[0], used);
}

std::string lane_mark(std::size_t lane) { return lane_name(lane) + ": "; }

}  // namespace limpid
