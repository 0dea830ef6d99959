#include "app/plot/channel_names.h"

#include <string_view>
#include <vector>

#include "devices/files/session/derived_columns.h"
#include "devices/files/toml_reader.h"

namespace limpid {

std::optional<std::string> meant_channel(const TraceChannels& channels, const std::string& name) {
  std::vector<std::string> known;
  const auto add = [&](std::string_view path) { known.emplace_back(path.substr(1)); };
  for (const ColumnInfo& each : kColumnInfo) add(each.path);
  for (const DerivedInfo& each : kDerivedInfo) add(each.path);
  for (const auto& each : channels.infos()) known.push_back(each.key);
  const auto meant = nearest(name, known);
  return meant ? std::optional<std::string>(*meant) : std::nullopt;
}

}  // namespace limpid
