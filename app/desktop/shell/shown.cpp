#include "app/desktop/shell/shown.h"

namespace limpid {

std::span<const double> Shown::row() const {
  return playback_.on() ? playback_.shown()->player().row() : live_.row();
}

std::span<const double> Shown::twin_row() const {
  return playback_.on() ? playback_.shown()->twin_row() : live_.twin_row();
}

void Shown::look(Camera::View view) {
  automatic_ = false;
  camera.look(view);
}

void Shown::reset_view() {
  automatic_ = true;
  camera.reset(stage().picture.bounds());
}

void Shown::follow_story() {
  const StoryStep* step = playback_.on() ? playback_.shown()->step() : nullptr;
  if (step == step_) return;
  step_ = step;
  if (step == nullptr) return reset_view();
  playback_.shown()->stage().name_runs({step->names[0], step->names[1], true});
  const StoryCamera aim = camera_in(playback_.shown()->steps(), *step);
  reset_view();
  if (!aim.of && aim.view == Camera::View::iso) return;
  look(aim.view);
  camera.frame(aim.of.value_or(stage().picture.bounds()));
}

int Shown::quality_level() const {
  if (settings_.picture_quality == "high") return 0;
  if (settings_.picture_quality == "medium") return 2;
  if (settings_.picture_quality == "low") return Quality::kLowest;
  return automatic_quality.level();
}

}  // namespace limpid
