#include "tests/support/hid/space_mouse_model.h"

#include <algorithm>
#include <cmath>

#include "tests/support/hid/descriptor_writer.h"

namespace limpid::test {

namespace {

using Kind = DescriptorWriter::Kind;

// Descriptor of real ones: the axes are marked as relative although they are not.
Report describe(bool joined) {
  DescriptorWriter writer;
  writer.page(0x01).usage(0x08).begin(DescriptorWriter::kApplication);
  writer.begin(DescriptorWriter::kPhysical).report(1);
  writer.logical(-SpaceMouseModel::kFullScale, SpaceMouseModel::kFullScale);
  writer.physical(-1400, 1400).unit(0x11, -4).usages({0x30, 0x31, 0x32});
  if (joined) {
    writer.usages({0x33, 0x34, 0x35}).field(Kind::input, 16, 6, DescriptorWriter::kRelative);
  } else {
    writer.field(Kind::input, 16, 3, DescriptorWriter::kRelative);
    writer.end().begin(DescriptorWriter::kPhysical).report(2);
    writer.usages({0x33, 0x34, 0x35}).field(Kind::input, 16, 3, DescriptorWriter::kRelative);
  }
  writer.end().begin(DescriptorWriter::kLogical).report(3).page(0x09).usages(1, 2);
  writer.logical(0, 1).physical(0, 1).unit(0, 0).field(Kind::input, 1, 2);
  writer.padding(Kind::input, 14).end();
  writer.begin(DescriptorWriter::kLogical).report(4).page(0x08).usage(0x4B);
  writer.field(Kind::output, 1, 1);
  writer.padding(Kind::output, 7).end().end();
  return writer.descriptor();
}

}  // namespace

SpaceMouseModel::SpaceMouseModel(const SpaceMouseLayout& layout)
    : ReferenceDevice(layout.identity, describe(layout.joined), layout.period), layout_(layout) {}

void SpaceMouseModel::restart(Time now) {
  start_ = now;
  sent_buttons_ = 0;
  resting_ = true;
}

std::vector<Report> SpaceMouseModel::next_input(Time now) {
  const Cap cap = path_(std::chrono::duration<double>(now - start_).count());
  std::vector<Report> reports;
  if (buttons_ != sent_buttons_) {
    reports.push_back({3, 0, 0});
    write_at(reports.back(), 1, buttons_);
    sent_buttons_ = buttons_;
  }
  const bool rests = std::ranges::all_of(cap, [](double value) { return value == 0; });
  const bool nothing_new = rests && resting_;
  resting_ = rests;
  if (nothing_new && layout_.silent_at_rest) return reports;

  Report axes(13);
  for (std::size_t i = 0; i < cap.size(); ++i) {
    auto value = static_cast<std::int16_t>(std::lround(cap[i] * kFullScale));
    if (fault() == Fault::not_a_number) value = INT16_MIN;
    write_at(axes, 1 + 2 * i, value);
  }
  axes[0] = 1;
  if (layout_.joined) {
    reports.push_back(axes);
  } else {
    reports.emplace_back(axes.begin(), axes.begin() + 7);
    Report rotation(axes.begin() + 6, axes.end());
    rotation[0] = 2;
    reports.push_back(rotation);
  }
  return reports;
}

void SpaceMouseModel::on_output(ReportView report, Time) {
  if (report.size() != 2 || report[0] != 4) violation("an output report other than its light's");
}

}  // namespace limpid::test
