#include "app/desktop/stage.h"

#include <limits>

#include "app/assets.h"

namespace limpid {

Stage::Stage(ArmDescription arm, Scene scene, const StageOptions& options)
    : picture(data_dir() / "shaders", arm, scene),
      history({.channels = TraceChannels(RowLayout(arm.dof())).count() * (options.rerun ? 2 : 1),
               .seconds = options.seconds,
               .tick = options.tick}),
      group(options.shown),
      arm_(std::move(arm)),
      scene_(std::move(scene)),
      rows_(arm_),
      channels_(RowLayout(arm_.dof())),
      values_(static_cast<std::size_t>(history.channels())) {
  for (PlotSpec& spec : channels_.plots(options.rerun)) plots.emplace_back(std::move(spec));
}

void Stage::append(std::span<const double> row, std::span<const double> again) {
  const auto count = static_cast<std::size_t>(channels_.count());
  const std::span<double> values(values_);
  channels_.values(row, values.first(count));
  if (values.size() > count) {
    if (again.empty()) {
      std::ranges::fill(values.subspan(count), std::numeric_limits<double>::quiet_NaN());
    } else {
      channels_.values(again, values.subspan(count));
    }
  }
  history.append(channels_.layout().in(row, Column::time)[0], values_);
}

}  // namespace limpid
