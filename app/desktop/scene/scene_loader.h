// Loads scenes, models and arms beside the window, one after the other.
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "app/base/tasks.h"
#include "app/stage/load_files.h"

namespace limpid {

class SceneLoader {
 public:
  // Queues a scene. `arm` is called at the scene's turn, as another arm may come before it.
  void open_scene(std::filesystem::path file, std::function<ArmDescription()> arm);
  void add_model(std::filesystem::path file);
  void open_arm(std::filesystem::path file, const std::string& tip, Xacro xacro);

  bool busy() const { return work_.busy() || !waiting_.empty(); }
  bool opening_scene() const { return opening(Kind::scene) || opening_arm(); }  // or an arm
  bool opening_arm() const { return opening(Kind::arm); }
  // Returns "loading gear.glb" for people; part() is the part that is done, 0 to 1.
  const std::string& what() const { return work_.what(); }
  double part() const { return work_.part(); }
  double seconds_left() const;  // negative: nobody can tell yet
  std::size_t waiting() const { return waiting_.size(); }
  // Drops the queue, and cancels the running work, which ends at its own pace.
  void cancel();

  // Returns a result that is ready; to be called once a frame. Throws the errors of loading, unless
  // it was cancelled.
  std::optional<Loaded> take();

 private:
  enum class Kind : std::uint8_t { scene, model, arm };
  struct Request {
    std::string what;
    Kind kind;
    std::function<Task<Loaded>::Work()> work;  // on the caller's thread, when its turn comes
  };
  void start_next();
  bool opening(Kind kind) const;

  std::deque<Request> waiting_;
  Task<Loaded> work_;
  Kind kind_ = Kind::model;  // of the request that runs
  bool unwanted_ = false;    // the request that runs was cancelled
};

}  // namespace limpid
