#include "app/stage/stage.h"

#include <algorithm>
#include <utility>

#include "app/base/folders.h"
#include "app/stage/row_view.h"
#include "render/arm_look.h"

namespace limpid {
namespace {

bool same_part(const BodyPart& a, const BodyPart& b) {
  return a.shape == b.shape && a.pose.matrix() == b.pose.matrix() && a.color == b.color;
}

// Returns true if two documents are alike in all that SceneView::set_scene() reads; it reads files
// and builds shapes. Meshes do not count.
bool same_items(const SceneDocument& first, const SceneDocument& second) {
  const auto seen = [](const SceneDocument& document) {
    std::vector<const Object*> objects;
    for (const Object& object : document.scene.objects) {
      if (object.body || !has_shape<Mesh>(object)) objects.push_back(&object);
    }
    return objects;
  };
  const auto same = [](const Object* a, const Object* b) {
    return a->shape == b->shape && a->pose.matrix() == b->pose.matrix() &&
           a->body.has_value() == b->body.has_value() && a->color == b->color &&
           std::ranges::equal(a->parts, b->parts, same_part);
  };
  return std::ranges::equal(seen(first), seen(second), same) &&
         std::ranges::equal(first.visuals, second.visuals, {}, &SceneVisual::file,
                            &SceneVisual::file);
}

// Reads the pictures once: all that is made of the stage's arm has them.
const ArmDescription& with_look(ArmDescription& arm) {
  load_visuals(arm);
  return arm;
}

}  // namespace

Stage::Stage(ArmDescription arm, SceneDocument document, const MeshModels& models, History past,
             double shown)
    : picture(data_dir() / "shaders", with_look(arm), document.scene, visual_pictures(document)),
      history(std::move(past)),
      group(shown),
      arm_(std::move(arm)),
      document_(std::move(document)),
      rows_(arm_, document_.scene),
      channels_(arm_, row_layout(arm_.dof(), document_.scene), body_names(document_.scene)) {
  choose_plots(default_plots());
  show_meshes(models, std::nullopt);
}

void Stage::choose_plots(const std::vector<PlotChoice>& choices) {
  if (choices == choices_) return;
  std::vector<Plot> chosen;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    const PlotSpec spec = plot_spec(choices[i], channels_, names_);
    const auto same = std::ranges::find(choices_, choices[i]);
    const auto place = same != choices_.end() ? static_cast<std::size_t>(same - choices_.begin())
                       : choices.size() == choices_.size() ? i
                                                           : plots.size();
    chosen.push_back(place < plots.size() ? plots[place] : Plot(spec));
    if (same == choices_.end()) chosen.back().show(spec);
  }
  plots = std::move(chosen);
  choices_ = choices;
}

void Stage::name_runs(const RunNames& names) {
  if (names == names_) return;
  const RunNames before = std::exchange(names_, names);
  // The history may know fewer runs.
  const auto known = static_cast<std::size_t>(history.channels() / channels_.count());
  names_.names.resize(std::min(names_.names.size(), known));
  const bool same_runs =
      names_.names.size() == before.names.size() && names_.beside == before.beside;
  for (std::size_t i = 0; i < plots.size(); ++i) {
    PlotSpec spec = plot_spec(choices_[i], channels_, names_);
    const std::vector<Curve>& shown = plots[i].spec().curves;
    for (std::size_t k = 0; same_runs && k < spec.curves.size(); ++k) {
      spec.curves[k].visible = shown[k].visible;
    }
    plots[i].show(std::move(spec));
  }
}

void Stage::follow_energy(SampleIndex end) {
  for (std::size_t lane = 0; static_cast<int>(lane) * channels_.count() < history.channels();
       ++lane) {
    energy[lane].follow(history, end, channels_.lane(lane));
  }
}

void Stage::show(const SceneDocument& document, const MeshModels& models,
                 std::optional<std::size_t> highlighted) {
  if (!same_items(document_, document)) {
    picture.set_scene(document.scene, visual_pictures(document));
  }
  document_ = document;
  rows_.show(document_.scene);
  show_meshes(models, highlighted);
}

void Stage::show_meshes(const MeshModels& models, std::optional<std::size_t> highlighted) {
  picture.set_meshes(mesh_pictures(document_.scene, models, highlighted));
}

void Stage::draw_at(int quality) {
  if (quality == quality_) return;
  quality_ = quality;
  picture.set_quality(Quality::level(quality));
}

}  // namespace limpid
