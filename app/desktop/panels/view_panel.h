// The 3D view: the picture under ImGui, and what the mouse does in it.
#pragma once

#include <imgui.h>

#include <array>
#include <functional>
#include <optional>
#include <span>

#include "app/desktop/base/settings.h"
#include "app/desktop/base/stage.h"
#include "app/desktop/document/scene_editor.h"
#include "app/desktop/panels/magnifier.h"
#include "app/live/live_loop.h"
#include "app/plot/plot_frame.h"
#include "render/camera.h"

namespace limpid {

// What there is to see in one frame.
struct ViewScene {
  Stage& stage;
  std::span<const double> row;
  bool recorded = false;               // the row is a recording's
  std::span<const double> rerun = {};  // the row of its second run; or none
  std::span<const double> twin = {};   // of a second run at the same time; or none
  RunNames names = {};                 // of the two
  bool overlaid = false;               // both in one picture
  std::string told = {};               // a story's sentence
  std::string pad = {};                // the gamepad that leads the hand; or none
  std::optional<Object> selected = {};
  // The body under the mouse, to be pulled by the point that is there; null: none may be.
  std::function<std::optional<BodyPull>(const Ray&)> grasp = {};
  bool asked = false;      // a question stands over its lower edge, where hints are
  bool blind = false;      // nothing but the picture: no words, no numbers
  int quality = 0;         // a level of Quality
  double pixel_scale = 1;  // pixels a point
  int pixel_height = 0;    // of the window [px]
  float words = 0;         // that words take at the top over all of its width [points]

  bool split() const { return !twin.empty() && !overlaid; }
};

// What its legend takes of a view's upper left corner.
ScreenRect legend_box(ScreenRect view);

// What the mouse did in the picture besides leading the hand.
struct ViewRequest {
  bool turned = false;           // the camera
  std::optional<Ray> clicked{};  // with the left button
  std::optional<Ray> asked{};    // with the right one
};

class ViewPanel {
 public:
  // The mouse leads the hand, in the controls, from near the tips; with Ctrl it pulls a body;
  // elsewhere it turns the camera.
  // `taken`: what it does belongs to somebody else.
  ViewRequest draw(const ViewScene& scene, Camera& camera, Controls& controls, Settings& settings,
                   ScreenRect rect, bool taken);
  // Whether anything in the picture has moved since it was drawn. Once a turn, before draw().
  bool differs(const ViewScene& scene, const Camera& camera, const Settings& settings);

 private:
  void draw_signs(const ViewScene& scene, const ViewState& view, const Camera& camera,
                  const Settings& settings, ScreenRect rect) const;
  void draw_halves(const ViewScene& scene, const Camera& camera, const Settings& settings,
                   ScreenRect rect);
  static ViewState state_of(const ViewScene& scene, const Settings& settings);
  static ViewState twin_of(const ViewScene& scene, const Settings& settings);
  ViewRequest handle_mouse(const ViewScene& scene, Camera& camera, Controls& controls,
                           Settings& settings, ScreenRect rect, bool taken);
  bool pull_body(const ViewScene& scene, const Camera& camera, Controls& controls, ScreenRect rect,
                 const Eigen::Vector2d& pixel, bool over);
  void stay(const Camera& camera, ScreenRect rect, const Vec3& point, const Eigen::Vector2d& pixel);
  Vec3 dragged_to(const Camera& camera, const Eigen::Vector2d& pixel);
  bool near_tip(const ViewScene& scene, const Camera& camera, const Eigen::Vector2d& pixel) const;
  void hold(const Camera& camera, ScreenRect rect, const Vec3& point, const Eigen::Vector2d& pixel);
  void drag_hand(const ArmDescription& arm, const Camera& camera, Controls& controls,
                 ScreenRect rect, const Eigen::Vector2d& pixel);

  Magnifier magnifier_;
  std::optional<ScreenRect> drawn_;                          // where the view was
  bool dragging_ = false;                                    // the hand
  bool pulls_ = false;                                       // what the left button would do here
  bool pulling_ = false;                                     // a body
  std::array<std::optional<Eigen::Vector2d>, 2> pressed_{};  // left, right: where
  std::array<bool, 2> moved_{};                              // since then
  bool pushed_ = false;                                      // the hand, by the wheel
  bool on_right_ = false;       // the mouse, when it last began something
  Vec3 anchor_ = Vec3::Zero();  // the point that is dragged, without depth [m]
  Vec3 offset_ = Vec3::Zero();  // from the mouse's point to it [m]
  // How the picture was looked at when the hand was dragged last.
  Eigen::Matrix4d looked_ = Eigen::Matrix4d::Identity();
  ImVec2 corner_{};
};

}  // namespace limpid
