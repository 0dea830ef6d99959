// What Esc does.
#include <imgui.h>
#include <imgui_internal.h>

#include "app/desktop/shell/desktop.h"

namespace limpid {

void Desktop::escape() {
  const bool closed = close_one();
  const bool real = desk_.loop().device_in_place() || devices_.check() != nullptr;
  if (!closed || real) cut_force();
}

// A device that moves by itself stops, and its dialog says so. Else a menu, then typing outside of
// dialogs (which ImGui ends), the question, a run that goes on beside the window, the dialog.
bool Desktop::close_one() {
  const Focus now = focus();
  if (identify_.moving()) {
    identify_.stop();
  } else if (now.popup) {
    // Lists inside of a dialog go, the dialog stays.
    const int level = ImGui::GetTopMostPopupModal() != nullptr ? 1 : 0;
    ImGui::ClosePopupToLevel(level, true);
  } else if (now.question) {
    document_.stay();
  } else if (playback_.loading_part() > 0 && playback_.loading()) {
    playback_.cancel_loading();
  } else if (now.dialog == Dialog::none) {
    return now.text;
  } else if (!now.text || modal(now.dialog) || now.dialog == Dialog::plot) {
    close_dialog();
  }
  return true;
}

}  // namespace limpid
