#include "app/remote/live_channels.h"

#include <algorithm>
#include <cmath>

namespace limpid {

using nlohmann::json;

json number(double x) { return std::isfinite(x) ? json(x) : json(); }

namespace {

// Indices of "hand/torque.1", "hand/torque.2", ...
std::vector<int> parts_of(const TraceChannels& channels, const std::string& name) {
  std::vector<int> parts;
  while (const auto part = channels.find(name + "." + std::to_string(parts.size() + 1))) {
    parts.push_back(*part);
  }
  return parts;
}

}  // namespace

LiveRow::LiveRow(const TraceChannels& channels, std::span<const double> of_lane, std::size_t lane)
    : row(of_lane.begin(), of_lane.end()), values(static_cast<std::size_t>(channels.count())) {
  const RowLayout& layout = channels.layout();
  file_points(layout.in(std::span(row), Column::contact_point),
              layout.in(of_lane, Column::contact_force));
  channels.values(row, values, lane);
}

std::optional<LiveChannel> LiveChannel::find(const TraceChannels& channels,
                                             const std::string& name) {
  if (const auto one = channels.find(name)) return LiveChannel{.parts = {*one}};
  if (std::vector<int> parts = parts_of(channels, name); !parts.empty()) {
    return LiveChannel{.parts = std::move(parts), .vector = true};
  }
  const std::string path = "/" + name;
  const auto* derived = std::ranges::find(kDerivedInfo, path, &DerivedInfo::path);
  if (derived != kDerivedInfo.end() && channels.tips() != nullptr) {
    return LiveChannel{.derived = static_cast<std::size_t>(derived - kDerivedInfo.begin()),
                       .vector = true};
  }
  const auto* column = std::ranges::find(kColumnInfo, path, &ColumnInfo::path);
  if (column == kColumnInfo.end() || channels.layout().width(column->column) == 0) return {};
  return LiveChannel{.column = column->column, .vector = column->width != ColumnWidth::one};
}

json LiveChannel::unit(const TraceChannels& channels) const {
  if (derived) return kDerivedInfo[*derived].unit;
  if (column) return kColumnInfo[static_cast<std::size_t>(*column)].unit;
  json units = json::array();
  for (const int channel : parts) {
    units.push_back(channels.infos()[static_cast<std::size_t>(channel)].unit);
  }
  const bool same = std::ranges::all_of(units, [&](const json& u) { return u == units[0]; });
  return same ? units[0] : units;
}

json LiveChannel::value(const TraceChannels& channels, const LiveRow& row) const {
  json all = json::array();
  if (derived) {
    const auto known = channels.tips()->of(DerivedColumns::from(channels.layout(), row.row));
    for (const double x : known[*derived]) all.push_back(number(x));
  } else if (column) {
    for (const double x : channels.layout().in(std::span(row.row), *column))
      all.push_back(number(x));
  } else {
    for (const int channel : parts) {
      all.push_back(number(row.values[static_cast<std::size_t>(channel)]));
    }
  }
  return vector ? all : all[0];
}

}  // namespace limpid
