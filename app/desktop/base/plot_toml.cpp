#include "app/desktop/base/plot_toml.h"

#include <algorithm>
#include <array>

#include "devices/files/toml_reader.h"

namespace limpid {
namespace {

constexpr std::size_t kMostPlots = 24, kMostChannels = 32;
constexpr std::array kKinds{PlotKind::time, PlotKind::cross, PlotKind::spectrum};

PlotChoice plot_of(const TomlTable& table) {
  table.allow_only({"title", "kind", "across", "channels"});
  PlotChoice plot{.title = table.text("title").value_or(""),
                  .across = table.text("across").value_or("")};
  if (const auto text = table.text("kind")) {
    const auto* kind =
        std::ranges::find(kKinds, *text, [](PlotKind k) { return std::string(name(k)); });
    if (kind == kKinds.end()) table.refuse("kind", "\"time\", \"cross\", \"spectrum\"");
    plot.kind = *kind;
  }
  const toml::node* node = table.find("channels");
  if (node == nullptr) return plot;
  const toml::array* keys = node->as_array();
  const bool texts = keys != nullptr && keys->size() <= kMostChannels &&
                     std::ranges::all_of(*keys, [](const auto& key) { return key.is_string(); });
  if (!texts) {
    table.refuse("channels", "a list of at most 32 texts, such as \"device/position.2\"");
  }
  for (const toml::node& key : *keys) plot.channels.push_back(*key.value<std::string>());
  return plot;
}

}  // namespace

toml::array plots_toml(const std::vector<PlotChoice>& plots) {
  toml::array all;
  for (const PlotChoice& plot : plots) {
    toml::table table;
    if (!plot.title.empty()) table.insert("title", plot.title);
    table.insert("kind", name(plot.kind));
    if (!plot.across.empty()) table.insert("across", plot.across);
    toml::array channels;
    for (const std::string& key : plot.channels) channels.push_back(key);
    table.insert("channels", std::move(channels));
    all.push_back(std::move(table));
  }
  return all;
}

std::vector<PlotChoice> plots_of(const toml::table& table, const std::string& where) {
  const TomlTable whole(table, where, "");
  if (whole.find("plot") == nullptr) return default_plots();
  std::vector<PlotChoice> plots;
  for (const TomlTable& each : whole.tables("plot")) plots.push_back(plot_of(each));
  if (plots.size() > kMostPlots) whole.refuse("plot", "at most 24 tables [[plot]]");
  return plots;
}

}  // namespace limpid
