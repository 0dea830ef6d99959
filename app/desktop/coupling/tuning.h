// Settings of all lanes, their changes by sliders, keys and presets, and their analysis.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "app/desktop/base/settings.h"
#include "app/desktop/base/window_layout.h"
#include "app/desktop/device/device_controller.h"
#include "app/desktop/playback/playback.h"
#include "app/run/analysis.h"

namespace limpid {

class Tuning {
  // Parameters of the virtual arm, while a device is in its place.
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
  Tuning(Settings& settings, Notices& notices, LiveStage& live, DeviceController& devices,
         Playback& playback);

  // Returns the settings that sliders and keys act on: those of one of the lanes; in playback those
  // of the next re-run, which begin as the recording's.
  Parameters& edited() {
    return playback_.on() ? of_rerun_ : settings_.lanes.parameters[edited_lane()];
  }
  std::size_t edited_lane() const { return playback_.on() ? kMainLane : settings_.lanes.edited; }
  const Analysis& analysis() const { return analysis_; }  // of edited(), at the arm's rest pose
  // Returns the analysis of a played recording's settings.
  const Analysis& recorded_analysis() const { return recorded_analysis_; }

  void next_law();  // if passivity is broken, ends that
  // Let further lanes come or go: all but the first or one beside it; one more; the last one.
  // Precondition: LiveStage::why_lanes_are_fixed() is empty.
  void toggle_twin();
  void add_lane();
  void drop_lane();
  // Breaks passivity for a demonstration. All changes of the coupling, the world or the screen end
  // it, and everything is as it was before.
  void break_passivity();
  void end_break();
  void reset();  // to the usual values
  void use_preset(const std::string& name);

  // Settings for an arm that comes into the loop, perhaps in the shape of a real device. They have
  // gains that suit it, its motors' share of its own weight, and its encoders. `device` null: the
  // virtual arm. take() makes them the settings.
  struct Suited {
    LaneParameters lanes;
    std::optional<ArmDescription> fitted_for;
    std::optional<OfVirtualArm> of_virtual;
    std::string device;
    double encoder_of_device = 0;  // [rad]
  };
  Suited suited(const ArmDescription& arm, const DeviceTraits* device) const;
  void take(Suited suited);
  void keep_as_they_are_for(const ArmDescription& arm) { fitted_for_ = arm; }
  // Makes analysis() for the present arm.
  void analyze_anew();
  // Follows the settings of all lanes, before the loop takes them. follow_recorded() follows those
  // of a recording, after the loop. Both are to be called once a frame.
  void update();
  void follow_recorded(bool another);  // session is shown
  // Remembers with the device which part of its own forces its motors compensate.
  void note_compensation();
  // Settings of all lanes as with the virtual arm, and the arm that they suit.
  struct Choices {
    LaneSettings lanes;
    std::optional<ArmDescription> fitted_for;
  };
  Choices choices() const;
  // Puts the choices back, for the present arm and device.
  void take(const Choices& of_person);
  // Returns the settings for the next start, for any arm.
  Settings settings_to_keep(const Choices& of_person) const;

  NamedTexts presets;

 private:
  void run_lanes(std::size_t count);
  void follow_lanes();
  void follow_edited();
  void mark_changes(const Parameters& now, const Parameters& before, const std::string& whose);

  Settings& settings_;
  Notices& notices_;
  LiveStage& live_;
  DeviceController& devices_;
  Playback& playback_;
  std::optional<ArmDescription> fitted_for_;  // arm that the gains suit
  std::optional<OfVirtualArm> of_virtual_;    // while a device is in the arm's place
  std::string device_;                        // id of that device
  double encoder_of_device_ = 0;              // of that device [rad]
  Parameters of_rerun_;
  Analysis analysis_;
  std::optional<Parameters> analysed_;     // parameters of analysis_
  const Stage* analysed_stage_ = nullptr;  // its arm's stage
  LaneParameters marked_;                  // as the marks in the plots know them
  Analysis recorded_analysis_;
  std::optional<Parameters> recorded_analysed_;  // parameters of recorded_analysis_
};

}  // namespace limpid
