#include "tests/support/hid/pid_joystick_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace limpid::test {

namespace {

using Kind = DescriptorWriter::Kind;

constexpr std::uint8_t kConstant = 0x26;
constexpr int kBytesAnEffect = 32;
enum Operation { kStart = 1, kStartSolo, kStop };
enum Control { kEnable = 1, kDisable, kStopAll, kReset, kPause, kContinue };
enum LoadStatus { kSuccess = 1, kFull, kError };

double share(std::int64_t value, const Field& field) {
  return static_cast<double>(value) / static_cast<double>(field.max);
}

}  // namespace

std::string name(PidFirmware firmware) {
  switch (firmware) {
    case PidFirmware::standard: return "standard";
    case PidFirmware::arduino: return "arduino";
    case PidFirmware::fino: return "fino";
    case PidFirmware::open_ffboard: return "open_ffboard";
    case PidFirmware::adapt: return "adapt";
  }
  return {};
}

PidJoystickOptions PidJoystickOptions::of(PidFirmware firmware) {
  PidJoystickOptions options;
  options.firmware = firmware;
  if (firmware == PidFirmware::standard) return options;
  options.layout.control_in_report = true;
  options.layout.direction_in_hundredths = true;
  options.layout.physical_axes = false;
  options.capacity = 13;
  if (firmware == PidFirmware::open_ffboard) {
    options.layout.magnitude_max = 32767;
    options.layout.direction_max = 36000;
    options.layout.control_in_bits = true;
    options.layout.override_switch = false;
    options.capacity = 40;
  }
  if (firmware == PidFirmware::adapt) {
    options.layout.magnitude_max = 255;
    options.layout.direction_max = 180;
    options.capacity = 17;
    options.first_block = 2;
  }
  return options;
}

PidJoystickModel::PidJoystickModel(const PidJoystickOptions& options)
    : PidJoystickModel(options, pid_reports(options.layout)) {}

PidJoystickModel::PidJoystickModel(const PidJoystickOptions& options, PidReports reports)
    : ReferenceDevice(options.identity, reports.writer.descriptor(), options.period),
      options_(options),
      reports_(std::move(reports)),
      hand_(std::vector<AxisPhysics>(2, options.physics)) {}

void PidJoystickModel::restart(Time now) {
  const PidFirmware firmware = options_.firmware;
  effects_.clear();
  actuators_ = firmware == PidFirmware::arduino || firmware == PidFirmware::fino;
  paused_ = false;
  device_gain_ = 1;
  created_ = 0;
  sent_stick_ = {};
  sent_state_ = state();
  said_.clear();
  if (actuators_) say_state();  // as soon as it is plugged in
  hand_.begin(now);
}

Torque PidJoystickModel::acting(Time now) const {
  Torque torque{};
  if (!actuators_ || paused_) return torque;
  for (const auto& [index, effect] : effects_) {
    const bool pushes = effect.playing && effect.type == kConstant && effect.parameters;
    const bool waits = effect.delay > Time::zero() && now < effect.start + effect.delay;
    if (!pushes || waits) continue;
    const double size = effect.magnitude * effect.gain * device_gain_ * options_.torque_limit;
    torque[0] += size * effect.x;
    torque[1] += size * effect.y;
  }
  for (double& one : torque) one = std::clamp(one, -options_.torque_limit, options_.torque_limit);
  return torque;
}

void PidJoystickModel::end_effects(Time now) {
  for (auto& [index, effect] : effects_) {
    const Time length = effect.delay + effect.duration * std::max(effect.loops, 1);
    const bool over = effect.duration > Time::zero() && now - effect.start >= length;
    if (over) effect.playing = false;
  }
}

void PidJoystickModel::run(Time now) {
  hand_.run(now, [&](Time step) {
    if (fault() == Fault::frozen) return forces().newest();
    end_effects(step);
    const Torque torque = acting(step);
    if (torque != forces().newest()) forces().note(step, torque, ForceCause::expired);
    return torque;
  });
}

Report PidJoystickModel::stick() const {
  Report report = reports_.writer.blank(Kind::input, reports_.x.id);
  for (int axis = 0; axis < 2; ++axis) {
    const Field field = reports_.x.at(axis);
    const double x = std::clamp(hand_.encoder(axis) / hand_.axis(axis).upper, -1.0, 1.0);
    const bool broken = fault() == Fault::not_a_number;
    put(report, field, broken ? field.min - 1 : std::lround(x * field.max));
  }
  report.back() = buttons_;
  return report;
}

std::vector<Report> PidJoystickModel::next_input(Time) {
  std::vector<Report> due;
  if (Report news = stick(); !options_.only_changes || news != sent_stick_) {
    due.push_back(news);
    sent_stick_ = news;
  }
  due.insert(due.end(), said_.begin(), said_.end());
  said_.clear();
  const bool by_itself = options_.firmware != PidFirmware::open_ffboard;
  if (Report news = state(); by_itself && news != sent_state_) {
    due.push_back(news);
    sent_state_ = news;
  }
  return due;
}

Report PidJoystickModel::state() const {
  Report report = reports_.writer.blank(Kind::input, reports_.state_playing.id);
  put(report, reports_.power, powerless_ ? 0 : 1);
  put(report, reports_.actuators, actuators_ ? 1 : 0);
  if (options_.firmware == PidFirmware::open_ffboard) {
    put(report, reports_.paused, actuators_ ? 0 : 1);
    put(report, reports_.state_playing, actuators_ ? 1 : 0);
    return report;
  }
  put(report, reports_.paused, paused_ ? 1 : 0);
  put(report, reports_.safety, let_go_ ? 0 : 1);
  for (const auto& [index, effect] : effects_) {
    if (!effect.playing) continue;
    put(report, reports_.state_playing, 1);
    put(report, reports_.state_index, index);
  }
  return report;
}

void PidJoystickModel::on_output(ReportView report, Time now) {
  const std::uint8_t id = report.empty() ? 0 : report[0];
  const auto is = [&](const Field& field) {
    return field.id == id && complete(report, field, Kind::output);
  };
  if (is(reports_.effect_index)) {
    set_effect(report);
  } else if (is(reports_.constant_index)) {
    set_constant(report);
  } else if (is(reports_.operation)) {
    operate(report, now);
  } else if (is(reports_.free_index)) {
    if (effect(get(report, reports_.free_index))) {
      effects_.erase(static_cast<int>(get(report, reports_.free_index)));
    }
  } else if (is(reports_.control)) {
    control(report);
  } else if (is(reports_.device_gain)) {
    device_gain_ = share(get(report, reports_.device_gain), reports_.device_gain);
  } else if (id != reports_.envelope_id && id != reports_.condition_id &&
             id != reports_.periodic_id) {
    violation("an output report that cannot be used, id " + std::to_string(id));
  }
  forces().note(now, acting(now), ForceCause::told);
}

bool PidJoystickModel::complete(ReportView report, const Field& field, Kind kind) {
  return report.size() == reports_.writer.blank(kind, field.id).size();
}

std::int64_t PidJoystickModel::allowed(ReportView report, const Field& field, const char* name) {
  const std::int64_t value = get(report, field);
  if (!field.allows(value)) violation(std::string(name) + " is " + std::to_string(value));
  return std::clamp<std::int64_t>(value, field.min, field.max);
}

PidEffect* PidJoystickModel::effect(std::int64_t index) {
  if (!reports_.create_type && index >= 1 && index <= options_.capacity) {
    return &effects_[static_cast<int>(index)];  // the host chooses the index
  }
  const auto found = effects_.find(static_cast<int>(index));
  if (found != effects_.end()) return &found->second;
  violation("there is no effect " + std::to_string(index));
  return nullptr;
}

void PidJoystickModel::set_effect(ReportView report) {
  PidEffect* effect = this->effect(get(report, reports_.effect_index));
  if (!effect) return;
  const auto choice = allowed(report, reports_.effect_type, "the effect's type");
  const std::uint8_t type = options_.layout.effect_types[static_cast<std::size_t>(choice - 1)];
  if (effect->type != 0 && effect->type != type) violation("an effect changes its type");
  effect->type = type;
  const auto milliseconds = [&](int field) {
    const Field where = reports_.duration.at(field);
    return std::chrono::milliseconds(allowed(report, where, "a duration"));
  };
  effect->duration = milliseconds(0);
  effect->delay = milliseconds(3);
  effect->gain = share(get(report, reports_.gain), reports_.gain);
  if (get(report, reports_.trigger_button) != 0) violation("an effect waits for a button");
  std::tie(effect->x, effect->y) = direction(report);
  effect->parameters = true;
  if (options_.firmware != PidFirmware::open_ffboard) return;
  actuators_ = true;
  say_state();
}

// Direction in which a force of this effect pushes, as the firmware reads the report.
std::pair<double, double> PidJoystickModel::direction(ReportView report) {
  const bool enabled = get(report, reports_.direction_enable) != 0;
  const bool x = get(report, *reports_.axes) != 0, y = get(report, reports_.axes->at(1)) != 0;
  const auto turn = [&](int field) {
    const Field where = reports_.direction.at(field);
    return static_cast<double>(allowed(report, where, "a direction")) / where.max;
  };
  const auto angle = [&](int field) { return 2 * std::numbers::pi * turn(field); };
  switch (options_.firmware) {
    case PidFirmware::standard: break;
    case PidFirmware::arduino: {  // it compares all three bits at once
      const bool polar = enabled && !x && !y;
      return {std::sin(angle(0)), -std::cos(angle(polar ? 0 : 1))};
    }
    case PidFirmware::fino: {
      const bool polar = enabled && !x && !y;
      return {polar || x ? -std::sin(angle(0)) : 0, polar || y ? std::cos(angle(0)) : 0};
    }
    case PidFirmware::open_ffboard:
      if (enabled) return {-std::sin(angle(0)), std::cos(angle(0))};
      return {x ? 1 - 2 * turn(0) : 0, y ? 2 * turn(1) - 1 : 0};
    case PidFirmware::adapt: return {-std::sin(angle(0)), std::cos(angle(0))};
  }
  return standard_direction(report);
}

std::pair<double, double> PidJoystickModel::standard_direction(ReportView report) {
  if (get(report, reports_.direction_enable) != 0) {
    const Field& field = reports_.direction;
    const auto turn = static_cast<double>(allowed(report, field, "a direction")) / field.max;
    const double angle = 2 * std::numbers::pi * turn;
    return {-std::sin(angle), std::cos(angle)};
  }
  if (!reports_.axes) {
    violation("an effect without a direction");
    return {0, 0};
  }
  const bool x = get(report, *reports_.axes), y = get(report, reports_.axes->at(1));
  if (x == y) violation("an effect of both axes or none without a direction");
  return {x ? 1 : 0, y ? 1 : 0};
}

void PidJoystickModel::set_constant(ReportView report) {
  PidEffect* effect = this->effect(get(report, reports_.constant_index));
  if (!effect) return;
  if (effect->type != 0 && effect->type != kConstant) violation("not an effect of constant force");
  const auto magnitude = allowed(report, reports_.magnitude, "the magnitude");
  effect->magnitude = share(magnitude, reports_.magnitude);
  // The adapter passes the magnitude on to the joystick as a number of 7 bits.
  if (options_.firmware == PidFirmware::adapt) {
    effect->magnitude = static_cast<double>(magnitude / 2) / 127;
  }
}

void PidJoystickModel::operate(ReportView report, Time now) {
  PidEffect* effect = this->effect(get(report, reports_.operation_index));
  if (!effect) return;
  const auto what = allowed(report, reports_.operation, "the operation");
  if (what == kStartSolo) {
    for (auto& [index, other] : effects_) other.playing = false;
  }
  effect->playing = what != kStop;
  if (!effect->playing) return;
  if (!effect->parameters) violation("an effect starts before it is set");
  effect->start = now;
  effect->loops = static_cast<int>(get(report, reports_.loops));
}

void PidJoystickModel::control(ReportView report) {
  if (!options_.layout.control_in_bits) {
    return control(static_cast<int>(allowed(report, reports_.control, "the device control")));
  }
  for (int i = 0; i < kContinue; ++i) {
    if (get(report, reports_.control.at(i)) != 0) control(i + 1);
  }
}

void PidJoystickModel::control(int what) {
  if (what == kEnable) actuators_ = true;
  if (what == kDisable) actuators_ = false;
  if (what == kPause) paused_ = true;
  if (what == kContinue) paused_ = false;
  if (what == kStopAll) {
    for (auto& [index, effect] : effects_) effect.playing = false;
  }
  if (what == kReset) effects_.clear();
  switch (options_.firmware) {
    case PidFirmware::arduino: break;
    case PidFirmware::fino: break;
    case PidFirmware::open_ffboard:  // the effect either plays or does not
      paused_ = false;
      actuators_ = what == kEnable || what == kContinue;
      break;
    case PidFirmware::standard:
    case PidFirmware::adapt:
      if (what != kReset) break;
      paused_ = false;
      actuators_ = true;
  }
}

bool PidJoystickModel::on_set_feature(ReportView report, Time) {
  const auto& type = reports_.create_type;
  if (!type || report.empty() || report[0] != type->id) return false;
  if (!complete(report, *type, Kind::feature)) return false;
  const auto choice = allowed(report, *type, "the effect's type");
  created_ = 0;
  if (options_.fails_to_load) return true;
  const int first = options_.first_block;
  for (int index = first + options_.capacity - 1; index >= first; --index) {
    if (!effects_.contains(index)) created_ = index;  // the lowest free index
  }
  if (created_ == 0) return true;
  if (options_.firmware == PidFirmware::open_ffboard) say_state();
  effects_[created_].type = options_.layout.effect_types[static_cast<std::size_t>(choice - 1)];
  return true;
}

std::optional<Report> PidJoystickModel::on_ask(std::uint8_t id) {
  if (id != reports_.x.id) return std::nullopt;
  return stick();
}

std::optional<Report> PidJoystickModel::on_get_feature(std::uint8_t id) {
  if (reports_.create_type && id == reports_.load_index.id) {
    Report report = reports_.writer.blank(Kind::feature, id);
    const int free = options_.capacity - static_cast<int>(effects_.size());
    put(report, reports_.load_index, created_);
    const LoadStatus failure = options_.fails_to_load ? kError : kFull;
    put(report, reports_.load_status, created_ ? kSuccess : failure);
    put(report, reports_.load_free, free * kBytesAnEffect);
    return report;
  }
  if (id != reports_.pool_size.id) return std::nullopt;
  Report report = reports_.writer.blank(Kind::feature, id);
  put(report, reports_.pool_size, options_.capacity * kBytesAnEffect);
  put(report, reports_.pool_effects, options_.capacity);
  put(report, reports_.pool_managed, reports_.create_type ? 1 : 0);
  return report;
}

}  // namespace limpid::test
