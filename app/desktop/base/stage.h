// A world as it is seen: arm and scene, their picture, and the plots of what happens there.
#pragma once

#include <memory>
#include <optional>

#include "app/desktop/base/plot_choice.h"
#include "app/desktop/base/row_view.h"
#include "app/plot/history.h"
#include "app/plot/plot.h"
#include "app/plot/trace_channels.h"
#include "app/run/scene_meshes.h"
#include "render/camera.h"
#include "render/scene_view.h"

namespace limpid {

class Stage {
 public:
  // `models` are what the scene's meshes look like; `history`: of the arm's channels, or twice as
  // many, for a second run beside the first; `shown`: how much of it at first [s]. Needs a current
  // OpenGL context. Errors: std::runtime_error naming the file of a picture.
  Stage(ArmDescription arm, SceneDocument document, const MeshModels& models, History history,
        double shown);

  // The same arm in another scene; `highlighted` is the number of a mesh. Errors as above; the
  // picture stays as it was then.
  void show(const SceneDocument& document, const MeshModels& models,
            std::optional<std::size_t> highlighted);
  // What there is a plot of.
  void choose_plots(const std::vector<PlotChoice>& choices);
  // What the plots call their runs; a second one is drawn while it has a name.
  void name_runs(const RunNames& names);
  const RunNames& names() const { return names_; }
  // A level of Quality.
  void draw_at(int quality);

  const ArmDescription& arm() const { return arm_; }
  const SceneDocument& document() const { return document_; }
  const RowView& rows() const { return rows_; }
  const TraceChannels& channels() const { return channels_; }

  // What the motors can give under these parameters, from the next row on.
  void follow(const Parameters& p) { channels_.set_limits(motor_limits(arm_, p)); }

  // Whose energy it is in the samples up to `end`.
  void follow_energy(SampleIndex end);

  // Adds a row to the plots, and a second run's beside it.
  void append(std::span<const double> row, std::span<const double> beside = {}) {
    channels_.append(history, row, beside);
  }

  SceneView picture;
  ViewMemory memory, twin_memory;
  History history;
  PlotGroup group;
  std::vector<Plot> plots;  // one for each choice
  EnergyAccount energy, twin_energy;

 private:
  void show_meshes(const MeshModels& models, std::optional<std::size_t> highlighted);

  ArmDescription arm_;
  SceneDocument document_;
  int quality_ = -1;
  RunNames names_;
  std::vector<PlotChoice> choices_;
  RowView rows_;
  TraceChannels channels_;
};

}  // namespace limpid
