// Panel of the 3D view: the picture under ImGui, and the mouse in it.
#pragma once

#include <imgui.h>

#include <array>
#include <functional>
#include <optional>
#include <span>

#include "app/desktop/base/settings.h"
#include "app/desktop/scene/picking.h"
#include "app/desktop/scene/scene_editor.h"
#include "app/live/live_loop.h"
#include "app/plot/plot_frame.h"
#include "app/stage/magnifier.h"
#include "app/stage/stage.h"
#include "render/camera.h"

namespace limpid {

// Contents of the view in one frame.
struct ViewScene {
  Stage& stage;
  std::span<const double> row;
  bool recorded = false;                             // the row is a recording's
  std::span<const double> rerun = {};                // row of a re-run; or none
  std::vector<std::span<const double>> beside = {};  // rows of further runs at the same time
  RunNames names = {};                               // of all runs
  bool overlaid = false;                             // all runs in one picture
  std::string told = {};                             // sentence of a story
  std::string pad = {};  // name of the gamepad that moves the hand; or none
  std::optional<Object> selected = {};
  // Returns the body under the mouse, with the point to pull at; null: no body may be pulled.
  std::function<std::optional<BodyPull>(const Ray&)> grasp = {};
  // Return the place to aim at along a ray, and how far below a point something is; null: the hand
  // cannot be led here.
  std::function<std::optional<Aim>(const Ray&)> aim = {};
  std::function<std::optional<double>(const Vec3&)> drop = {};
  bool asked = false;                  // a question covers its lower edge, where hints are
  bool blind = false;                  // picture only: no words, no numbers
  int quality = 0;                     // a level of Quality
  double pixel_scale = 1;              // pixels per point
  int pixel_height = 0;                // height of the window [px]
  float words = 0;                     // height of words at the top, over all of its width [points]
  std::vector<ScreenRect> cards = {};  // windows over the picture

  // Number of pictures side by side.
  std::size_t pictures() const { return overlaid ? 1 : 1 + beside.size(); }
  bool split() const { return pictures() > 1; }
};

// Returns the part of a view's upper left corner that its legend takes.
ScreenRect legend_box(ScreenRect view);

// Actions of the mouse in the picture besides leading the hand.
struct ViewRequest {
  bool turned = false;           // the camera turned
  std::optional<Ray> clicked{};  // with the left button
  std::optional<Ray> asked{};    // with the right button
};

class ViewPanel {
 public:
  // Draws the view. The mouse near the tips moves the hand, in the controls; with Ctrl it pulls a
  // body; elsewhere it turns the camera. `taken`: the mouse belongs to another tool.
  ViewRequest draw(const ViewScene& scene, Camera& camera, Controls& controls, Settings& settings,
                   ScreenRect rect, bool taken);
  // Returns whether the picture has changed since it was drawn. To be called once a turn, before
  // draw().
  bool differs(const ViewScene& scene, const Camera& camera, const Settings& settings);
  // Returns what cards over the pictures should not cover, as drawn last: tips, what is acted on,
  // objects that move.
  const Crowd& crowd() const { return crowd_; }
  // Returns the same with the cards, the hints and the lens.
  Crowd crowd_with_signs() const;
  // Returns whether a drag from this pixel of the view pulls the hand.
  static bool near_tip(const ViewScene& scene, const Camera& camera, const Eigen::Vector2d& pixel);
  // Returns the place of the hints of a first start in the last frame, if there were any.
  const std::optional<ScreenRect>& hinted() const { return hinted_; }

 private:
  void see_crowd(const ViewScene& scene, const ViewState& view, std::span<const ViewState> beside,
                 const Camera& camera, ScreenRect rect);
  Crowd crowd_with_hints() const;
  void draw_hints(const ViewScene& scene, const Camera& camera, const Settings& settings,
                  ScreenRect rect, ImDrawList& list);
  void draw_signs(const ViewScene& scene, const ViewState& view, const Camera& camera,
                  const Settings& settings, ScreenRect rect);
  void draw_pictures(const ViewScene& scene, const Camera& camera, const Settings& settings,
                     ScreenRect rect);
  static ViewState state_of(const ViewScene& scene, const Settings& settings);
  static ViewState state_beside(const ViewScene& scene, std::size_t run, const Settings& settings);
  ViewRequest handle_mouse(const ViewScene& scene, Camera& camera, Controls& controls,
                           Settings& settings, ScreenRect rect, bool taken);
  bool pull_body(const ViewScene& scene, const Camera& camera, Controls& controls, ScreenRect rect,
                 const Eigen::Vector2d& pixel, bool over);
  void stay(const Camera& camera, ScreenRect rect, const Vec3& point, const Eigen::Vector2d& pixel);
  Vec3 dragged_to(const Camera& camera, const Eigen::Vector2d& pixel);
  void hold(const Camera& camera, ScreenRect rect, const Vec3& point, const Eigen::Vector2d& pixel);
  void drag_hand(const ViewScene& scene, const Camera& camera, Controls& controls, ScreenRect rect,
                 const Eigen::Vector2d& pixel);
  std::optional<Aim> aim_near(const ViewScene& scene, const Camera& camera,
                              const Eigen::Vector2d& pixel) const;
  void aim_at(const ViewScene& scene, const Camera& camera, const Eigen::Vector2d& pixel);
  void name_what_is_there(const ViewScene& scene, const Camera& camera,
                          const Eigen::Vector2d& pixel);

  void follow_task(const ViewScene& scene, const ViewState& view);

  Magnifier magnifier_;
  Crowd crowd_, around_;  // without and with the cards
  FreePlace hint_place_;
  // Size of the picture that the place was chosen in [px], and its camera.
  std::pair<float, float> hinted_in_;
  Eigen::Matrix4d hinted_by_ = Eigen::Matrix4d::Identity();
  std::optional<ScreenRect> hinted_;  // place of the hints in the last frame
  std::string task_;                  // sentence of the scene that is shown
  bool task_done_ = false;            // something of it was touched since, or pulled on
  bool magnet_on_ = false, magnet_holds_ = false;
  bool magnet_broke_ = false;        // it is on, and lost what it held
  std::optional<ScreenRect> drawn_;  // place of the view
  bool dragging_ = false;            // drags the hand
  bool pulls_ = false;               // the left button would take the hand here
  bool pulling_ = false;             // pulls a body
  std::array<std::optional<Eigen::Vector2d>, 2> pressed_{};  // places: left, right
  std::array<bool, 2> moved_{};                              // since pressed
  bool pushed_ = false;                                      // the wheel pushed the hand
  std::size_t under_mouse_ = 0;                              // picture in which the mouse began
  Vec3 anchor_ = Vec3::Zero();               // point that is dragged, without depth [m]
  Vec3 offset_ = Vec3::Zero();               // from the mouse's point to anchor_ [m]
  std::optional<std::size_t> aimed_at_;      // object whose depth the hand has taken
  double to_depth_ = 0;                      // still to go to that depth [m]
  std::optional<Eigen::Vector2d> began_at_;  // of a drag that has not left its place yet
  double rests_since_ = 0;                   // the mouse, in the picture [ImGui's clock]
  // Camera when the hand was dragged last.
  Eigen::Matrix4d looked_ = Eigen::Matrix4d::Identity();
  ImVec2 corner_{};
};

}  // namespace limpid
