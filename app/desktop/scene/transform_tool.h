// Tool that transforms the selected object in the picture: handles, and keys that do the same.
#pragma once

#include <imgui.h>

#include <optional>
#include <span>
#include <string>

#include "app/desktop/scene/document.h"
#include "app/desktop/scene/transform.h"
#include "app/plot/plot_frame.h"

namespace limpid {

class TransformTool {
 public:
  // Lets the selected object follow the mouse until accept() or give_up(). The object has handles
  // of this kind afterwards.
  void begin(TransformKind kind);
  // Transforms along this axis alone; the same axis again frees it.
  void lock(int axis);
  void accept() { transform_.reset(); }
  // Takes a character of a number that is typed instead of moving the mouse: mm, degrees, a factor.
  // Returns whether it is part of one.
  bool type(unsigned character);
  bool untype();  // takes back the last one
  // Puts all back as it was before.
  void give_up(Document& document);
  // Returns whether the object follows the mouse.
  bool follows() const { return transform_ || wanted_; }

  // Draws the tool; to be called once a frame, before the view uses the mouse. Returns true if the
  // mouse belongs to a handle. `bodies`: frames of the scene's moving objects, in their order.
  // `on_tip`: the mouse is at the arm's tip, which a drag pulls rather than a handle.
  bool draw(Document& document, std::span<const Pose> bodies, const Camera& camera, ScreenRect view,
            bool on_tip = false);

 private:
  struct Handle {
    std::optional<int> axis;
    float apart = 1e9f;  // distance from the mouse [px]
  };
  Handle draw_handles(const Transform& shown, const Camera& camera, ScreenRect view,
                      ImDrawList& list) const;
  void start(Document& document, const Object& now, const Eigen::Vector2d& mouse);
  void follow(Document& document, const Camera& camera, const Eigen::Vector2d& mouse,
              ImDrawList& list);

  TransformKind kind_ = TransformKind::move;
  std::optional<TransformKind> wanted_;  // a key asks for it, from the next frame on
  std::optional<Transform> transform_;   // transform that goes on
  std::size_t place_ = 0;                // place of the object in the scene
  SceneEditor::Version before_;
  Eigen::Vector2d begin_ = Eigen::Vector2d::Zero();  // of the mouse [px]
  std::optional<int> axis_;
  bool by_key_ = false;
  std::string typed_;       // amount in numbers; empty: the mouse's way
  std::optional<int> hot_;  // axis of the handle under the mouse
  bool over_ = false;       // a handle is under the mouse
};

}  // namespace limpid
