#include "app/desktop/scene/scene_loader.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>

namespace limpid {
namespace {

namespace fs = std::filesystem;

// Lowers this thread's priority, as the window draws meanwhile. The thread inherits the window's
// scheduling, never the haptic thread's.
void step_back() { ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), 10); }

LoadProgress progress_of(TaskProgress& progress) {
  return {.part = &progress.part, .cancel = &progress.cancel};
}

}  // namespace

void SceneLoader::open_scene(fs::path file, std::function<ArmDescription()> arm) {
  const std::string what = fmt::format("opening {}", file.filename().string());
  waiting_.push_back({what, Kind::scene, [file = std::move(file), arm = std::move(arm)] {
                        return [file, arm = arm()](TaskProgress& progress) -> Loaded {
                          step_back();
                          return load_scene(file, arm, progress_of(progress));
                        };
                      }});
  start_next();
}

void SceneLoader::add_model(fs::path file) {
  const std::string what = fmt::format("loading {}", file.filename().string());
  waiting_.push_back({what, Kind::model, [file = std::move(file)] {
                        return [file](TaskProgress& progress) -> Loaded {
                          step_back();
                          return load_model(file, progress_of(progress));
                        };
                      }});
  start_next();
}

void SceneLoader::open_arm(fs::path file, const std::string& tip, Xacro xacro) {
  const std::string what = fmt::format("opening {}", file.filename().string());
  waiting_.push_back({what, Kind::arm, [file = std::move(file), tip, xacro] {
                        return [file, tip, xacro](TaskProgress& progress) -> Loaded {
                          step_back();
                          return load_arm(file, tip, xacro, progress_of(progress));
                        };
                      }});
  start_next();
}

bool SceneLoader::opening(Kind kind) const {
  return (work_.busy() && !unwanted_ && kind_ == kind) ||
         std::ranges::count(waiting_, kind, &Request::kind) > 0;
}

void SceneLoader::start_next() {
  if (work_.busy() || waiting_.empty()) return;
  unwanted_ = false;
  const Request next = std::move(waiting_.front());
  waiting_.pop_front();
  kind_ = next.kind;
  work_.start(next.what, next.work());
}

void SceneLoader::cancel() {
  waiting_.clear();
  unwanted_ = true;
  work_.ask_to_stop();
}

std::optional<Loaded> SceneLoader::take() {
  start_next();
  try {
    std::optional<Loaded> loaded = work_.take();
    return unwanted_ ? std::nullopt : std::move(loaded);
  } catch (const std::exception&) {
    if (unwanted_) return std::nullopt;
    throw;
  }
}

double SceneLoader::seconds_left() const {
  const double part = work_.part();
  return part > 0.05 ? work_.seconds() * (1 - part) / part : -1;
}

}  // namespace limpid
