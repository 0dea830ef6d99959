// World: the arm, scene and device that are open, and their way from files and ports into loop and
// document.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/desktop/device/device_controller.h"
#include "app/desktop/live/live_stage.h"
#include "app/desktop/scene/document.h"
#include "devices/files/urdf_file.h"

namespace limpid {

class Desktop;

class World {
 public:
  explicit World(Desktop& desktop) : d_(desktop) {}

  // Opens files named by the user, once the window is there; empty: the default. Errors: FileError
  // and the like.
  void open_given(const std::string& device, const std::string& tip, const std::string& scene);
  // Opens files named by the user; empty: those of last time. A missing scene of last time only
  // shows a notice. `fixed`: settings named by the user stay as they are, whatever the arm.
  void open_last(const std::string& device, const std::string& tip, const std::string& scene,
                 bool fixed);

  // Load files beside the window; the present world stays until they are ready.
  void open_files(const std::vector<std::filesystem::path>& files);  // by their extensions
  void open_scene(const std::filesystem::path& file);
  // Opens an empty table, which no file has yet.
  void new_scene();
  void add_model(const std::filesystem::path& file);
  // Loads another virtual arm, with its pictures and the gains that suit it.
  void open_arm(const std::filesystem::path& file, const std::string& tip = {});
  bool built_in_arm() const;
  // Returns the virtual arm's file, whatever device is in its place.
  NamedArm arm_file() const { return {device_file_, device_tip_}; }
  // Returns the arm that the dialog "expand xacro" asks about; expand_xacro() is the answer that it
  // may be expanded.
  const std::optional<XacroToExpand>& xacro() const { return xacro_; }
  void expand_xacro();
  // Returns the arm whose tip is to be chosen, in the dialog "arm tip".
  const std::optional<TipsToChoose>& tips() const { return tips_; }
  void add_object(Object object);

  // Puts a real device in the arm's place, or lets it lead the virtual arm's hand; and back. The
  // scene comes along with all its changes, or else waits until the device is gone. The user is
  // then asked about changes of the device's own scene.
  void open_device(std::unique_ptr<Device> device);
  void close_device(const std::function<void()>& then = [] {});

  // Arm, device and scene that are open, to come back to.
  struct Place {
    ArmDescription arm;
    std::string device_file, device_tip;
    bool with_device = false;  // a real device is in the arm's place
    std::string file;          // of the scene
    std::shared_ptr<const SceneEditor::World> world;
  };
  Place place() const;
  // Opens a place again. If a real device has come or gone meanwhile, opens its scene for the
  // present arm. Errors: as LiveStage::open().
  void go_to(const Place& place);

  void toggle_recording();  // into a new file among the user's sessions
  // Records into this file; empty: a new one. `replaces`: also an existing one, which stays until
  // the recording is complete.
  void record(const std::filesystem::path& file, bool replaces = false);
  std::string why_fixed() const;

  // Takes loaded files into loop and document; hand_over(): gives the scene's changes to picture
  // and loop. Both are to be called once a frame.
  void take_loaded();
  void hand_over(bool at_once);

 private:
  void open(ArmDescription arm, SceneDocument document, MeshModels models,
            std::unique_ptr<Device> device = nullptr, bool saved = true);
  void take_stage(MeshModels models, bool saved);
  void accept(LoadedArm& loaded);
  void accept(LoadedScene& loaded);
  void accept(LoadedModel& loaded);
  void take_arm(const LoadedArm& loaded);
  void say_about_arm();
  std::pair<std::string, std::string> last_arm();  // file and tip
  Xacro consent(const std::filesystem::path& file) const;
  void ask_about(const XacroToExpand& arm);
  std::optional<SceneEditor::World> scene_for(const ArmDescription& arm) const;
  bool virtual_arm_again();
  void change_arm(const ArmDescription& arm, std::unique_ptr<Device> device);
  void take_up_set_aside(const ArmDescription& arm);
  void open_sweep(const std::filesystem::path& table);  // shows its map
  void run_hand(const std::filesystem::path& file);
  void start_recording(std::filesystem::path file, bool replaces);
  Workplace workplace() const;
  void load_scene(const std::filesystem::path& file);
  void leave_for_scene(std::function<void()> then);
  void show_scene();
  void hand_scene_over(bool at_once);
  void take_up(const SceneEditor& editor);

  Desktop& d_;
  std::string device_file_, device_tip_;
  std::optional<ArmDescription> virtual_arm_;  // the one that a device has replaced
  std::string first_scene_;  // file of the scene at the start, while its models load
  std::optional<TipsToChoose> tips_;
  std::optional<XacroToExpand> xacro_;
  std::string expanded_;  // xacro file that may be expanded
  SceneEditor::Version shown_;
  std::shared_ptr<const SceneEditor::World> touched_;  // taken by the loop
  std::chrono::steady_clock::time_point touched_since_;
};

}  // namespace limpid
