#include "app/style/range_reminder.h"

#include "app/style/palette.h"
#include "app/style/theme.h"

namespace limpid {

bool counts(ImGuiID id, bool changed, bool allowed, const std::string& range) {
  RangeReminder reminder(id);
  if (changed && allowed) reminder.fall_silent();
  if (changed && !allowed) reminder.speak();
  if (reminder.speaks()) {
    ImGui::TextColored(colour_vector(current_palette().broken), "not accepted; allowed: %s",
                       range.c_str());
  }
  return changed && allowed;
}

}  // namespace limpid
