// Handles on the selected object in the picture, and the keys that do the same.
#pragma once

#include <imgui.h>

#include <optional>
#include <span>
#include <string>

#include "app/desktop/document/document.h"
#include "app/desktop/document/transform.h"
#include "app/plot/plot_frame.h"

namespace limpid {

class TransformTool {
 public:
  // From now on the selected object follows the mouse, until accept() or give_up(); it has handles
  // of this kind afterwards.
  void begin(TransformKind kind);
  // Along this axis alone; asked for again: along none.
  void lock(int axis);
  void accept() { transform_.reset(); }
  // All as it was before.
  void give_up(Document& document);
  // The object follows the mouse.
  bool follows() const { return transform_ || wanted_; }

  // Once a frame, before the view does anything with the mouse: true if that belongs to a handle.
  // `bodies`: where the scene's objects that move are, in their order.
  bool draw(Document& document, std::span<const Pose> bodies, const Camera& camera,
            ScreenRect view);

 private:
  struct Handle {
    std::optional<int> axis;
    float apart = 1e9f;  // from the mouse [px]
  };
  Handle draw_handles(const Transform& shown, const Camera& camera, ScreenRect view,
                      ImDrawList& list) const;
  void start(Document& document, const Object& now, const Eigen::Vector2d& mouse);
  void follow(Document& document, const Camera& camera, const Eigen::Vector2d& mouse,
              ImDrawList& list);

  TransformKind kind_ = TransformKind::move;
  std::optional<TransformKind> wanted_;  // by a key, from the next frame on
  std::optional<Transform> transform_;   // under way
  std::size_t place_ = 0;                // of the object
  SceneEditor::Version before_;
  Eigen::Vector2d begin_ = Eigen::Vector2d::Zero();  // of the mouse [px]
  std::optional<int> axis_;
  bool by_key_ = false;
  std::optional<int> hot_;  // the handle under the mouse
  bool over_ = false;       // one is
};

}  // namespace limpid
