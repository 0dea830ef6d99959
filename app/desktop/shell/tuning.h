// The settings of the two runs as sliders, keys and presets change them, and what follows from
// them.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "app/desktop/base/settings.h"
#include "app/desktop/base/window_layout.h"
#include "app/desktop/live/device_controller.h"
#include "app/desktop/playback/playback.h"
#include "app/run/analysis.h"

namespace limpid {

class Tuning {
  // While a device is in the arm's place, what is the virtual arm's.
  struct OfVirtualArm {
    OwnForces forces;
    double encoder_step;  // [rad]

    static OfVirtualArm of(const Parameters& p) { return {OwnForces::of(p), p.encoder_step}; }
    void give(Parameters& p) const {
      forces.give(p);
      p.encoder_step = encoder_step;
    }
  };

 public:
  Tuning(Settings& settings, Notices& notices, LiveSession& live, DeviceController& devices,
         Playback& playback);

  // What sliders and keys act on: the settings of one of two runs.
  Parameters& edited();
  bool edits_twin() const { return settings_.twin.on && settings_.twin.edited && !playback_.on(); }
  const Analysis& analysis() const { return analysis_; }  // of these, at the arm's rest pose
  // The same of what is played, as it was recorded.
  const Analysis& recorded_analysis() const { return recorded_analysis_; }

  void next_law();     // where passivity is broken, it ends that
  void toggle_twin();  // precondition: LiveSession::why_twin_is_fixed() is empty
  // Settings under which the loop gives energy without end, to be looked at. All that changes the
  // coupling, the world or what is shown ends it, and everything is as it was before.
  void break_passivity();
  void end_break();
  void reset();  // all to their usual values
  void use_preset(const std::string& name);

  // Settings for an arm that comes into the loop, perhaps with a real device in its place: gains
  // that suit it, the share of its own weight that motors give, and its encoders. `device` null:
  // the virtual arm. take() makes them the settings.
  struct Suited {
    Parameters first, twin;
    std::optional<ArmDescription> fitted_for;
    std::optional<OfVirtualArm> of_virtual;
    std::string device;
    double encoder_of_device = 0;  // [rad]
  };
  Suited suited(const ArmDescription& arm, const DeviceTraits* device) const;
  void take(Suited suited);
  void keep_as_they_are_for(const ArmDescription& arm) { fitted_for_ = arm; }
  // The arm that is there now is the one that analysis() is of.
  void analyze_anew();
  // Once a frame, before and after the loop has had them.
  void update();
  void follow_recorded(bool another);  // session
  // Remembers with the device how much of its own forces its motors take off the hand.
  void note_compensation();
  // Settings of both runs, as they are with the virtual arm, and the arm that they suit.
  struct Choices {
    Parameters first;
    TwinSettings twin;
    std::optional<ArmDescription> fitted_for;
  };
  Choices choices() const;
  // Puts them back, for the arm and the device that are there now.
  void take(const Choices& of_person);
  // For the next start, with whichever arm.
  Settings settings_to_keep(const Choices& of_person) const;

  NamedTexts presets;

 private:
  void follow_twin();
  void mark_changes(const Parameters& now, const Parameters& before, const std::string& whose);

  Settings& settings_;
  Notices& notices_;
  LiveSession& live_;
  DeviceController& devices_;
  Playback& playback_;
  std::optional<ArmDescription> fitted_for_;  // the arm that the gains suit
  std::optional<OfVirtualArm> of_virtual_;    // while a device is in the arm's place
  std::string device_;                        // then: its id
  double encoder_of_device_ = 0;              // then [rad]
  Analysis analysis_;
  Parameters analysed_, analysed_twin_;  // that marks and analysis know
  bool analysed_of_twin_ = false;
  Analysis recorded_analysis_;
  std::optional<Parameters> recorded_analysed_;  // that it is of
};

}  // namespace limpid
