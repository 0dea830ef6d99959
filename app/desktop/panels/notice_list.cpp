#include "app/desktop/panels/notice_list.h"

#include <algorithm>

#include "app/style/palette.h"
#include "app/style/theme.h"

namespace limpid {

// Beside the legend where there is room for a sentence, else below it.
void draw_notices(const Notices& notices, ScreenRect view, ScreenRect legend) {
  const Palette& colours = palette(current_theme());
  ImDrawList* draw = ImGui::GetForegroundDrawList();
  const float em = ImGui::GetFontSize();
  const float pad = 0.5f * em;
  const bool beside = view.max.x - legend.max.x > 26 * em;
  const float left = beside ? legend.max.x + em : view.min.x + pad;
  const float right = view.max.x - pad;
  float y = (beside ? view.min.y : legend.max.y) + 0.7f * em;
  for (const Notice& notice : notices.all()) {
    const float wrap = std::max(right - left - 2 * pad, 4 * em);
    const ImVec2 size = ImGui::CalcTextSize(notice.text.c_str(), nullptr, false, wrap);
    const ImVec2 at(std::max(left + pad, (left + right - size.x) / 2), y + pad);
    const ImVec2 from(at.x - pad, at.y - pad), to(at.x + size.x + pad, at.y + size.y + pad);
    draw->AddRectFilled(from, to, colour(colours.raised, 0.95f), 4);
    draw->AddRect(from, to, colour(notice.bad ? colours.broken : colours.border), 4);
    draw->AddText(ImGui::GetFont(), em, at, colour(colours.text), notice.text.c_str(), nullptr,
                  wrap);
    y = to.y + pad;
  }
}

}  // namespace limpid
