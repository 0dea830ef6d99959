// What the desktop does with gamepads.
#include <fmt/format.h>

#include <algorithm>

#include "app/desktop/shell/desktop.h"

namespace limpid {

// One that comes while the window is open is told of, once; those of the start are in the panel.
void Desktop::follow_pads(std::vector<Pad> pads, bool focused, double dt) {
  const std::string& wanted = settings_.gamepad;
  for (const Pad& pad : pads) {
    const bool known = std::ranges::find(pads_, pad.id, &Pad::id) != pads_.end();
    if (known || !pads_known_ || pad.id == wanted) continue;
    notices_.say(
        fmt::format("{} is plugged in. Device, in the panel at the right (F3), lets it lead the "
                    "hand.",
                    pad.name));
  }
  pads_ = std::move(pads);
  pads_known_ = true;
  const auto pad = std::ranges::find(pads_, wanted, &Pad::id);
  const bool there = pad != pads_.end();
  if (!there || !devices_.hub().in_use().empty()) {
    if (!there && !wanted.empty() && !leading_pad_.empty()) {
      notices_.say(
          fmt::format("{} is gone; the mouse leads the hand until it is back.", leading_pad_),
          true);
    }
    leading_pad_.clear();
    return pad_hand_.lose(desk_.controls());
  }
  if (leading_pad_ != pad->name) {
    leading_pad_ = pad->name;
    notices_.say(
        fmt::format("{} leads the hand: left stick, triggers nearer and farther, A takes "
                    "hold or lets go, B cuts the force, Y is the next coupling.",
                    leading_pad_));
  }
  const Focus who = focus();
  const bool listens = focused && !playback_.on() && !who.question && !modal(who.dialog);
  const PadReading now = listens ? pad->now : PadReading{.b = pad->now.b};
  const Vec3 tip =
      desk_.stage().rows().tip(desk_.loop().layout().in(desk_.row(), Column::device_position));
  if (!tip.allFinite()) return;
  const auto asked = pad_hand_.lead(now, {camera_.right(), camera_.up(), camera_.forward()},
                                    desk_.stage().arm(), tip, dt, desk_.controls());
  if (asked.cut) cut_force();
  if (asked.next_law) toggle_coupling();
}

}  // namespace limpid
