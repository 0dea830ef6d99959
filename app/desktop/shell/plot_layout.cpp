#include "app/desktop/shell/plot_layout.h"

#include <fmt/format.h>

#include "app/base/folders.h"
#include "app/desktop/base/window_layout.h"

namespace limpid {

PlotLayout::PlotLayout(Settings& settings, Notices& notices, OpenDialog& dialog)
    : layouts(data_dir() / "assets/layouts.toml", user_config_dir() / "layouts.toml"),
      settings_(settings),
      notices_(notices),
      dialog_(dialog) {}

void PlotLayout::add() {
  std::vector<PlotChoice>& plots = settings_.plot_choices;
  if (plots.empty() || !plots.back().channels.empty()) plots.emplace_back();
  choose(plots.size() - 1);
}

void PlotLayout::choose(std::size_t plot) {
  chosen_ = plot;
  settings_.show_plots = true;
  dialog_.open("plot");
}

void PlotLayout::remove(std::size_t plot) {
  std::vector<PlotChoice>& plots = settings_.plot_choices;
  if (plot < plots.size()) plots.erase(plots.begin() + static_cast<std::ptrdiff_t>(plot));
  if (dialog_.name() == "plot") dialog_.close();
}

void PlotLayout::use(const std::string& name) {
  const NamedTexts::Entry* layout = layouts.find(name);
  if (layout == nullptr) return;
  if (dialog_.name() == "plot") dialog_.close();
  apply_layout(settings_, layout->text, name);
  notices_.say(fmt::format("Layout: {}.", name));
}

}  // namespace limpid
