#include "app/desktop/panels/notice_list.h"

#include "app/style/palette.h"
#include "app/style/theme.h"

namespace limpid {

void draw_notices(const Notices& notices, ScreenRect view) {
  const Palette& colours = palette(current_theme());
  ImDrawList* draw = ImGui::GetForegroundDrawList();
  float y = view.min.y + 0.7f * ImGui::GetFontSize();
  for (const Notice& notice : notices.all()) {
    const float wrap = 0.7f * view.size().x;
    const ImVec2 size = ImGui::CalcTextSize(notice.text.c_str(), nullptr, false, wrap);
    const float pad = 0.5f * ImGui::GetFontSize();
    const ImVec2 at((view.min.x + view.max.x - size.x) / 2, y + pad);
    const ImVec2 from(at.x - pad, at.y - pad), to(at.x + size.x + pad, at.y + size.y + pad);
    draw->AddRectFilled(from, to, colour(colours.raised, 0.95f), 4);
    draw->AddRect(from, to, colour(notice.bad ? colours.broken : colours.border), 4);
    draw->AddText(ImGui::GetFont(), ImGui::GetFontSize(), at, colour(colours.text),
                  notice.text.c_str(), nullptr, wrap);
    y = to.y + pad;
  }
}

}  // namespace limpid
