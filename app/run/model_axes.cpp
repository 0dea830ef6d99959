#include "app/run/model_axes.h"

#include <fmt/format.h>

#include "devices/files/scene/model_units.h"

namespace limpid {

ModelAxes axes_of(const Model& model, const std::filesystem::path& file) {
  const std::string suffix = small_suffix(file);
  ModelAxes axes{usual_unit(file), suffix == ".obj", false};
  if (model.unit > 0) {
    axes.unit = model.unit;
  } else {
    axes.guessed = true;
    if (model.bounds().sizes().maxCoeff() < 1) axes.unit = 1;
  }
  if (model.up != Model::Up::unsaid) axes.y_up = model.up == Model::Up::y;
  return axes;
}

std::string text_of(const ModelAxes& axes) {
  const ModelUnit* const unit = model_unit(axes.unit);
  return fmt::format("in {}, {} up{}", unit ? unit->name : "units of its own",
                     axes.y_up ? "y" : "z", axes.guessed ? " (guessed)" : "");
}

}  // namespace limpid
