#include "tests/support/hid/reference_device.h"

namespace limpid::test {

void ReferenceDevice::power(bool on, Time now) {
  now = forward(now);
  if (powered_) run(now);
  powered_ = on;
  newest_.clear();
  restart(now);
  forces_.note(now, {}, ForceCause::power);
}

std::vector<Report> ReferenceDevice::input(Time now) {
  if (!powered_) return {};
  now = forward(now);
  run(now);
  if (fault_ == Fault::silent || fault_ == Fault::frozen) return {};
  if (fault_ == Fault::stuck) return newest_;
  newest_ = next_input(now);
  spoil(newest_);
  return newest_;
}

void ReferenceDevice::output(ReportView report, Time now) {
  if (!powered_) return;
  now = forward(now);
  run(now);
  if (fault_ != Fault::frozen && fault_ != Fault::deaf) on_output(report, now);
}

std::optional<Report> ReferenceDevice::feature(std::uint8_t id, Time now) {
  ++features_used_;
  if (!answers()) return std::nullopt;
  run(forward(now));
  return on_get_feature(id);
}

bool ReferenceDevice::set_feature(ReportView report, Time now) {
  ++features_used_;
  if (!answers()) return false;
  now = forward(now);
  run(now);
  return on_set_feature(report, now);
}

std::optional<Report> ReferenceDevice::ask(std::uint8_t id, Time now) {
  if (!answers()) return std::nullopt;
  run(forward(now));
  const std::optional<Report> answer = on_ask(id);
  if (!answer) return std::nullopt;
  std::vector<Report> one{*answer};
  spoil(one);
  return one[0];
}

void ReferenceDevice::spoil(std::vector<Report>& reports) {
  for (Report& report : reports) {
    if (fault_ == Fault::cut_short) report.resize((report.size() + 1) / 2);
    if (fault_ != Fault::garbage) continue;
    for (std::uint8_t& byte : report) byte = static_cast<std::uint8_t>(random_());
  }
}

}  // namespace limpid::test
