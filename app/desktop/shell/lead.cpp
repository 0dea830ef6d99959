#include "app/desktop/shell/lead.h"

#include <exception>
#include <utility>

#include "app/desktop/base/passivity_break.h"
#include "app/desktop/shell/desktop.h"
#include "app/run/lane_settings.h"

namespace limpid {
namespace {

// Makes the changes from `before` to `now` in `own`.
void take_changes(Parameters& own, const Parameters& now, const Parameters& before,
                  bool of_controller_only) {
  if (now == before) return;
  for (const ParameterInfo* info : differing(now, before)) {
    if (of_controller_only && !of_controller(*info)) continue;
    set_parameter_number(own, *info, parameter_number(now, *info));
  }
}

}  // namespace

void Lead::begin() {
  if (on()) return;
  own_ = d_.tuning.choices();
  recent_ = d_.settings.recent;
  note_program();
}

void Lead::begin_elsewhere() {
  begin();
  if (elsewhere_) return;
  const Settings& now = d_.settings;
  elsewhere_ = Elsewhere{d_.world.place(), now.scene, now.device, now.device_tip};
}

void Lead::note_program() { seen_ = d_.settings.lanes.parameters; }

void Lead::follow_person() {
  if (!on() || passivity_broken(d_.settings)) return;
  for (std::size_t i = 0; i < kMostLanes; ++i) {
    take_changes(own_->lanes.parameters[i], d_.settings.lanes.parameters[i], seen_[i],
                 i != kMainLane);
  }
  note_program();
}

bool Lead::end(bool study) {
  if (!on()) return true;
  if (d_.live.recording() || d_.live.closing() || d_.document.loader().busy()) return false;
  d_.tuning.end_break();
  const LaneSettings lanes = d_.settings.lanes;
  d_.tuning.take(*own_);
  d_.settings.recent = recent_;
  const auto before = std::exchange(elsewhere_, std::nullopt);
  if (before || !(lanes == d_.settings.lanes)) {
    // The law must not change without notice under a hand on the device.
    if (d_.live.loop().device_in_place()) d_.cut_force();
    if (before) go_back(*before);
    d_.notices.say(
        study ? "The study has ended. Your settings are back."
              : "The program that controlled this window has ended. Your settings are back.");
  }
  own_.reset();
  return true;
}

// Goes back to the person's world, after the user was asked about changes of the program's scene.
// The person's settings are taken again at the end, as the world on its way may have fitted gains.
void Lead::go_back(const Elsewhere& before) {
  d_.settings.scene = before.scene;
  d_.settings.device = before.device;
  d_.settings.device_tip = before.device_tip;
  d_.document.leave([this, place = before.place, own = *own_] {
    try {
      d_.world.go_to(place);
      d_.tuning.take(own);
    } catch (const std::exception& e) {
      d_.notices.say(e.what(), true);
    }
  });
}

Settings Lead::settings_to_keep() const {
  if (!on()) return d_.tuning.settings_to_keep(d_.tuning.choices());
  Settings kept = d_.tuning.settings_to_keep(*own_);
  kept.recent = recent_;
  if (!elsewhere_) return kept;
  kept.scene = elsewhere_->scene;
  kept.device = elsewhere_->device;
  kept.device_tip = elsewhere_->device_tip;
  return kept;
}

}  // namespace limpid
