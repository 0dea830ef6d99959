// The parts of the desktop, and what is done that needs more than one of them.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/desktop/base/named_texts.h"
#include "app/desktop/desk/identify_desk.h"
#include "app/desktop/desk/pad_hand.h"
#include "app/desktop/document/document.h"
#include "app/desktop/panels/banners.h"
#include "app/desktop/playback/playback.h"
#include "app/desktop/shell/focus.h"
#include "app/run/analysis.h"
#include "devices/files/arm/arm_tip.h"
#include "devices/files/arm/xacro_consent.h"
#include "render/camera.h"
#include "render/quality.h"

namespace limpid {

class SweepDesk;

class Desktop {
 public:
  Desktop(Settings settings, const AskForPriority& ask);
  ~Desktop();

  Settings& settings() { return settings_; }
  Settings settings_to_keep() const;  // for the next start, with whichever arm
  Notices& notices() { return notices_; }
  Document& document() { return document_; }
  Desk& desk() { return desk_; }
  DeviceDesk& devices() { return devices_; }
  IdentifyDesk& identify() { return identify_; }
  Playback& playback() { return playback_; }
  SweepDesk& sweep() { return *sweep_; }
  Camera& camera() { return camera_; }
  // The view is chosen for the window's size until somebody chooses one.
  bool automatic_view() const { return automatic_view_; }
  void keep_view() { automatic_view_ = false; }
  void look(Camera::View view);
  void reset_view();
  AutoQuality& automatic_quality() { return automatic_quality_; }

  // After the window is there. Errors: FileError and the like, for a device or scene given by hand.
  void open_world(const std::string& device, const std::string& tip, const std::string& scene);
  // The same, empty for what was open last time; a scene that is gone by now only says so.
  // `fixed`: settings that were given by hand stay as they are, whatever the arm.
  void open_last_world(const std::string& device, const std::string& tip, const std::string& scene,
                       bool fixed);
  // Before the OpenGL context goes.
  void drop_pictures();
  // Once a frame, before anything is drawn.
  void update(double dt);

  // What is on screen: the recording that is played, or the loop. The row is empty before the
  // first.
  Stage& shown() { return playback_.on() ? playback_.shown()->stage() : desk_.stage(); }
  const Stage& shown() const { return playback_.on() ? playback_.shown()->stage() : desk_.stage(); }
  std::span<const double> row() const;
  std::span<const double> twin_row() const;  // empty without a twin
  // What sliders and keys act on: the settings of one of two runs.
  Parameters& edited();
  bool edits_twin() const { return settings_.twin.on && settings_.twin.edited && !playback_.on(); }
  const Analysis& analysis() const { return analysis_; }  // of these, at the arm's rest pose
  // The same of what is played, as it was recorded.
  const Analysis& recorded_analysis() const { return recorded_analysis_; }
  int quality_level() const;  // of Quality, as the settings want it

  Dialog dialog() const { return dialog_; }  // that is open
  void open_dialog(Dialog dialog) { dialog_ = dialog; }
  void close_dialog() { dialog_ = Dialog::none; }
  // Who has the keys at this moment.
  Focus focus() const;

  // The gamepads that are there now, `dt` [s] after the last call: the chosen one leads the hand,
  // where the window has the focus and nothing is open over it.
  void follow_pads(std::vector<Pad> pads, bool focused, double dt);
  const std::vector<Pad>& pads() const { return pads_; }
  const std::string& leading_pad() const { return leading_pad_; }  // its name; or none

  // Plots of the settings: a new one, or what one shows, is chosen in a dialog.
  void add_plot();
  void choose_plot(std::size_t plot);
  std::size_t chosen_plot() const { return chosen_plot_; }
  void remove_plot(std::size_t plot);

  // Layouts of plots and panels, presets of the settings that edited() has.
  NamedTexts& layouts() { return layouts_; }
  NamedTexts& presets() { return presets_; }
  void use_layout(const std::string& name);
  void use_preset(const std::string& name);

  void toggle_coupling();
  void toggle_twin();
  void cut_force();
  // Closes what is open first; where nothing is, and on a real device, it cuts the force.
  void escape();
  // Settings under which the loop gives energy without end, to be looked at. All that changes the
  // coupling, the world or what is shown ends it, and everything is as it was before.
  void break_passivity();
  void end_break();
  void reset_parameters();
  void toggle_recording();
  void toggle_playing();
  void play_story();

  // Loading goes on beside the window; what is there stays until it is done.
  void open_scene(const std::filesystem::path& file);
  void add_model(const std::filesystem::path& file);
  void open_files(const std::vector<std::filesystem::path>& files);  // by their extensions
  void open_sweep(const std::filesystem::path& table);               // in its map
  void run_hand(const std::filesystem::path& file);
  // Another arm in place of the virtual one, with its pictures and the gains that suit it.
  void open_arm(const std::filesystem::path& file, const std::string& tip = {});
  void use_built_in_arm();
  // The arm that Dialog::expand_xacro asks about, and the answer that it may be expanded.
  const std::optional<XacroToExpand>& xacro() const { return xacro_; }
  void expand_xacro();
  bool built_in_arm() const;
  // The arm whose tip is to be chosen, with Dialog::arm_tip.
  const std::optional<TipsToChoose>& tips() const { return tips_; }
  void add_object(Object object);
  void frame_selected();
  // Where the scene has no file of the user's own, its name is asked for.
  void save_scene();
  void save_and_leave();
  // Scenes of the last time whose changes nobody had saved: the newest is offered.
  void offer_kept(std::vector<std::filesystem::path> files) { kept_ = std::move(files); }
  void open_kept();
  void leave_kept();  // in its folder, for another time
  void discard_kept();

  // What stands over the picture as long as it is so.
  std::vector<Banner> banners() const;

  // A real device takes the arm's place, or leads the virtual one's hand; and back. The scene comes
  // along with all its changes, or, if it cannot, the user is asked first.
  void open_device(std::unique_ptr<Device> device);
  void close_device();

 private:
  bool close_one();
  void accept(LoadedArm& loaded);
  void take_arm(const LoadedArm& loaded);
  void say_about_arm();
  std::pair<std::string, std::string> last_arm();  // file and tip
  Xacro consent(const std::filesystem::path& file) const;
  void ask_about(const XacroToExpand& arm);
  void fit_to(const ArmDescription& arm);
  std::optional<SceneEditor::World> scene_for(const ArmDescription& arm) const;
  // A world, and its loop.
  void open(ArmDescription arm, SceneDocument document, MeshModels models,
            std::unique_ptr<Device> device = nullptr, bool saved = true);
  void take_stage(MeshModels models, bool saved);
  void take_compensation(bool of_device);
  void note_compensation();
  void change_arm(const ArmDescription& arm, std::unique_ptr<Device> device);
  void take_up_set_aside(const ArmDescription& arm);
  std::string why_fixed() const;
  void take_loaded();
  void accept(LoadedScene& loaded);
  void accept(LoadedModel& loaded);
  Workplace workplace() const;
  void start_recording();
  void follow_parameters();
  void follow_twin();
  void follow_playback(double dt);
  void follow_recorded(bool another);
  void follow_story();
  void mark_changes(const Parameters& now, const Parameters& before, const std::string& whose);
  void show_scene();
  void hand_scene_over(bool at_once);

  Settings settings_;
  Notices notices_;
  Document document_;
  Desk desk_;
  DeviceDesk devices_;
  IdentifyDesk identify_;
  Playback playback_;
  std::unique_ptr<SweepDesk> sweep_;
  Camera camera_;
  bool automatic_view_ = true;
  const StoryStep* step_ = nullptr;  // of the story, that the camera knows
  std::vector<Pad> pads_;
  PadHand pad_hand_;
  std::string leading_pad_;
  bool pads_known_ = false;  // asked for once
  AutoQuality automatic_quality_;
  Dialog dialog_ = Dialog::none;
  NamedTexts layouts_, presets_;
  std::size_t chosen_plot_ = 0;
  std::string device_file_, device_tip_;
  std::optional<ArmDescription>
      arm_of_file_;          // of the device in the arm's place, as its file has it
  std::string first_scene_;  // the start's, while its models come in
  std::vector<std::filesystem::path> kept_;
  std::optional<TipsToChoose> tips_;
  std::optional<XacroToExpand> xacro_;
  std::string expanded_;                      // the xacro file that may be expanded
  std::optional<ArmDescription> fitted_for_;  // the arm that the gains suit
  // While a device in the arm's place has its own compensation: its id, and the virtual arm's.
  std::optional<std::pair<std::string, CompensationSettings>> compensated_;
  Analysis analysis_;
  Parameters analysed_, analysed_twin_;  // that marks and analysis know
  bool analysed_of_twin_ = false;
  Analysis recorded_analysis_;
  std::optional<Parameters> recorded_analysed_;  // that it is of
  SceneEditor::Version shown_;
  std::shared_ptr<const SceneEditor::World> touched_;  // by the loop
  std::chrono::steady_clock::time_point touched_since_;
};

}  // namespace limpid
