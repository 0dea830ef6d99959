// What the desktop does with plots, layouts and presets.
#include <fmt/format.h>

#include "app/desktop/base/window_layout.h"
#include "app/desktop/shell/desktop.h"

namespace limpid {

void Desktop::add_plot() {
  std::vector<PlotChoice>& plots = settings_.plot_choices;
  if (plots.empty() || !plots.back().channels.empty()) plots.emplace_back();
  choose_plot(plots.size() - 1);
}

void Desktop::choose_plot(std::size_t plot) {
  chosen_plot_ = plot;
  settings_.show_plots = true;
  open_dialog(Dialog::plot);
}

void Desktop::remove_plot(std::size_t plot) {
  std::vector<PlotChoice>& plots = settings_.plot_choices;
  if (plot < plots.size()) plots.erase(plots.begin() + static_cast<std::ptrdiff_t>(plot));
  if (dialog_ == Dialog::plot) close_dialog();
}

void Desktop::use_layout(const std::string& name) {
  const NamedTexts::Entry* layout = layouts_.find(name);
  if (layout == nullptr) return;
  if (dialog_ == Dialog::plot) close_dialog();
  apply_layout(settings_, layout->text, name);
  notices_.say(fmt::format("Layout: {}.", name));
}

void Desktop::use_preset(const std::string& name) {
  const NamedTexts::Entry* preset = presets_.find(name);
  if (preset == nullptr) return;
  end_break();
  apply_preset(edited(), preset->text, name);
  notices_.say(fmt::format("Settings: {}. Ctrl+Z brings back what was before.", name));
}

}  // namespace limpid
