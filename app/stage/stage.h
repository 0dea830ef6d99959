// Stage: arm and scene, their picture, and the plots of their rows.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "app/plot/history.h"
#include "app/plot/plot.h"
#include "app/plot/trace_channels.h"
#include "app/run/scene_meshes.h"
#include "app/stage/plot_choice.h"
#include "app/stage/row_view.h"
#include "render/camera.h"
#include "render/scene_view.h"

namespace limpid {

class Stage {
 public:
  // Draws the scene's meshes by `models`. `history` has the arm's channels, once for each run; the
  // plots show `shown` of it at first [s]. Needs a current OpenGL
  // context. Errors: std::runtime_error naming the file of a picture.
  Stage(ArmDescription arm, SceneDocument document, const MeshModels& models, History history,
        double shown);

  // Shows the same arm in another scene; `highlighted` is the number of a mesh. Errors as above;
  // the picture stays as it was then.
  void show(const SceneDocument& document, const MeshModels& models,
            std::optional<std::size_t> highlighted);
  // Makes a plot for each choice; plots that stay keep their range.
  void choose_plots(const std::vector<PlotChoice>& choices);
  // Names the runs in the plots; further runs are drawn while they have a name.
  void name_runs(const RunNames& names);
  const RunNames& names() const { return names_; }
  // Draws at a level of Quality.
  void draw_at(int quality);

  const ArmDescription& arm() const { return arm_; }
  const SceneDocument& document() const { return document_; }
  const RowView& rows() const { return rows_; }
  const TraceChannels& channels() const { return channels_; }

  // Sets the torque limits of a lane under these parameters, from the next row on.
  void follow(const Parameters& p, std::size_t lane = kMainLane) {
    channels_.set_limits(motor_limits(arm_, p), lane);
  }

  // Accounts for the energy of all runs in the samples up to `end`.
  void follow_energy(SampleIndex end);

  // Adds the rows of one tick to the plots.
  void append(LaneRows rows) { channels_.append(history, rows); }
  void append(std::span<const double> row) { channels_.append(history, row); }

  SceneView picture;
  std::array<ViewMemory, kMostLanes> memory;
  History history;
  PlotGroup group;
  std::vector<Plot> plots;  // one for each choice
  std::array<EnergyAccount, kMostLanes> energy;

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
