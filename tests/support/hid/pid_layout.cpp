#include "tests/support/hid/pid_layout.h"

namespace limpid::test {

namespace {

using Writer = DescriptorWriter;
using Kind = Writer::Kind;

constexpr std::uint16_t kDesktop = 0x01, kButtons = 0x09, kOrdinals = 0x0A, kPid = 0x0F;
constexpr std::uint16_t kSeconds = 0x1003, kDegrees = 0x14, kRadians = 0x12;
constexpr int kEffects = 40;

struct Builder {
  const PidLayout& layout;
  PidReports reports{};
  Writer& writer = reports.writer;
  std::uint8_t next_id = layout.first_id;

  Builder& begin(std::uint8_t usage) {
    writer.page(kPid).usage(usage).begin(Writer::kLogical);
    return *this;
  }
  std::uint8_t begin_report(std::uint8_t usage) {
    begin(usage);
    writer.report(next_id);
    return next_id++;
  }
  void end() { writer.end(); }

  Field index(Kind kind) {
    writer.page(kPid).usage(0x22).logical(1, kEffects).physical(0, 0).unit(0, 0);
    return writer.field(kind, 8, 1);
  }
  // Field that chooses one of several usages, by its position among them.
  Field choice(Kind kind, std::uint8_t usage, const std::vector<std::uint8_t>& usages) {
    begin(usage);
    writer.logical(1, static_cast<int>(usages.size())).physical(0, 0).unit(0, 0);
    for (const std::uint8_t one : usages) writer.usage(one);
    const Field field = writer.field(kind, 8, 1, Writer::kArray);
    end();
    return field;
  }
  Field ratio(std::uint8_t usage) {
    writer.page(kPid).usage(usage).logical(0, 255).physical(0, 10000).unit(0, 0);
    return writer.field(Kind::output, 8, 1);
  }
  Field milliseconds(std::initializer_list<std::uint8_t> usages) {
    writer.page(kPid).usages(usages).logical(0, 32767).physical(0, 32767).unit(kSeconds, -3);
    const Field first = writer.field(Kind::output, 16, static_cast<int>(usages.size()));
    writer.physical(0, 0).unit(0, 0);
    return first;
  }
  // Fields of the same signed range, one for each usage.
  Field levels(std::initializer_list<std::uint8_t> usages, int min) {
    const int max = layout.magnitude_max;
    writer.page(kPid).usages(usages).logical(min ? -max : 0, max).physical(min, 10000);
    return writer.field(Kind::output, max > 127 ? 16 : 8, static_cast<int>(usages.size()));
  }

  void inputs();
  void set_effect();
  void axes_and_direction();
  void set_parameters();
  void operate();
  void features();
};

void Builder::inputs() {
  writer.usage(0x01).begin(Writer::kPhysical).report(1).page(kDesktop).usages({0x30, 0x31});
  writer.logical(-32767, 32767);
  if (layout.physical_axes) writer.physical(-350, 350).unit(kRadians, -3);
  reports.x = writer.field(Kind::input, 16, 2);
  reports.y = reports.x.at(1);
  writer.physical(0, 0).unit(0, 0).end();
  writer.page(kButtons).usages(1, 8).logical(0, 1);
  reports.buttons = writer.field(Kind::input, 1, 8);

  begin(0x92);
  const int override_switch = layout.override_switch ? 1 : 0;
  writer.report(2).usages({0x9F, 0xA0, 0xA4});
  if (layout.override_switch) writer.usage(0xA5);
  writer.usage(0xA6).logical(0, 1);
  reports.paused = writer.field(Kind::input, 1, 4 + override_switch);
  reports.actuators = reports.paused.at(1);
  reports.safety = reports.paused.at(2);
  reports.power = reports.paused.at(3 + override_switch);
  writer.padding(Kind::input, 4 - override_switch).usage(0x94);
  reports.state_playing = writer.field(Kind::input, 1, 1);
  writer.usage(0x22).logical(0, kEffects);
  reports.state_index = writer.field(Kind::input, 7, 1);
  end();
}

void Builder::set_effect() {
  begin_report(0x21);
  reports.effect_index = index(Kind::output);
  reports.effect_type = choice(Kind::output, 0x25, layout.effect_types);
  reports.duration = milliseconds({0x50, 0x54, 0x51, 0xA7});
  reports.gain = ratio(0x52);
  writer.usage(0x53).logical(0, 8).physical(0, 8);
  reports.trigger_button = writer.field(Kind::output, 8, 1);
  axes_and_direction();
  end();
}

void Builder::axes_and_direction() {
  if (layout.enables_axes) {
    begin(0x55);
    writer.page(kDesktop).usages({0x30, 0x31}).logical(0, 1).physical(0, 1);
    reports.axes = writer.field(Kind::output, 1, 2);
    end();
  }
  writer.page(kPid).usage(0x56).logical(0, 1).physical(0, 1);
  reports.direction_enable = writer.field(Kind::output, 1, 1);
  writer.padding(Kind::output, layout.enables_axes ? 5 : 7);
  begin(0x57);
  writer.page(kOrdinals).usages({1, 2}).logical(0, layout.direction_max);
  if (layout.direction_in_hundredths) {
    writer.physical(0, 36000).unit(0, -2);
  } else {
    writer.physical(0, 360).unit(kDegrees, 0);
  }
  reports.direction = writer.field(Kind::output, layout.direction_max > 255 ? 16 : 8, 2);
  writer.physical(0, 0).unit(0, 0);
  end();
}

void Builder::set_parameters() {
  reports.envelope_id = begin_report(0x5A);
  index(Kind::output);
  levels({0x5B, 0x5D}, 0);
  milliseconds({0x5C, 0x5E});
  end();
  reports.condition_id = begin_report(0x5F);
  index(Kind::output);
  levels({0x60, 0x61, 0x62}, -10000);
  levels({0x63, 0x64, 0x65}, 0);
  end();
  reports.periodic_id = begin_report(0x6E);
  index(Kind::output);
  levels({0x70}, 0);
  levels({0x6F}, -10000);
  milliseconds({0x72});
  end();
  begin_report(0x73);
  reports.constant_index = index(Kind::output);
  reports.magnitude = levels({0x70}, -10000);
  writer.physical(0, 0);
  end();
}

void Builder::operate() {
  begin_report(0x77);
  reports.operation_index = index(Kind::output);
  reports.operation = choice(Kind::output, 0x78, {0x79, 0x7A, 0x7B});
  writer.page(kPid).usage(0x7C).logical(0, 255);
  reports.loops = writer.field(Kind::output, 8, 1);
  end();
  begin_report(0x90);
  reports.free_index = index(Kind::output);
  end();
  const std::vector<std::uint8_t> commands = {0x97, 0x98, 0x99, 0x9A, 0x9B, 0x9C};
  if (layout.control_in_bits) {
    begin_report(0x96);
    writer.usages({0x97, 0x98, 0x99, 0x9A, 0x9B, 0x9C}).logical(1, 6).physical(0, 0);
    reports.control = writer.field(Kind::output, 1, 8);
    end();
  } else if (layout.control_in_report) {
    begin_report(0x95);
    reports.control = choice(Kind::output, 0x96, commands);
    end();
  } else {
    writer.page(kPid).report(next_id++);
    reports.control = choice(Kind::output, 0x96, commands);
  }
  begin_report(0x7D);
  reports.device_gain = ratio(0x7E);
  end();
}

void Builder::features() {
  if (layout.creates_effects) {
    begin_report(0xAB);
    reports.create_type = choice(Kind::feature, 0x25, layout.effect_types);
    writer.page(kDesktop).usage(0x3B).logical(0, 511);
    writer.field(Kind::feature, 10, 1);
    writer.padding(Kind::feature, 6);
    end();
    begin_report(0x89);
    writer.usage(0x22).logical(0, kEffects);
    reports.load_index = writer.field(Kind::feature, 8, 1);
    reports.load_status = choice(Kind::feature, 0x8B, {0x8C, 0x8D, 0x8E});
    writer.page(kPid).usage(0xAC).logical(0, 32767);
    reports.load_free = writer.field(Kind::feature, 16, 1);
    end();
  }
  begin_report(0x7F);
  writer.usage(0x80).logical(0, 32767).physical(0, 0).unit(0, 0);
  reports.pool_size = writer.field(Kind::feature, 16, 1);
  writer.usage(0x83).logical(0, 127);
  reports.pool_effects = writer.field(Kind::feature, 8, 1);
  writer.usages({0xA9, 0xAA}).logical(0, 1);
  reports.pool_managed = writer.field(Kind::feature, 1, 2);
  writer.padding(Kind::feature, 6);
  end();
}

}  // namespace

PidLayout PidLayout::unusual() {
  return {.effect_types = {0x40, 0x31, 0x30, 0x26},
          .first_id = 0x21,
          .magnitude_max = 127,
          .enables_axes = false,
          .direction_max = 3599,
          .physical_axes = false,
          .control_in_report = true,
          .creates_effects = true};
}

PidReports pid_reports(const PidLayout& layout) {
  Builder builder{layout};
  builder.writer.page(kDesktop).usage(0x04).begin(Writer::kApplication);
  builder.inputs();
  builder.set_effect();
  builder.set_parameters();
  builder.operate();
  builder.features();
  builder.end();
  return std::move(builder.reports);
}

}  // namespace limpid::test
