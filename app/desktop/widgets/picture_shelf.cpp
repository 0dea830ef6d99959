#include "app/desktop/widgets/picture_shelf.h"

#include <algorithm>
#include <cmath>

#include "app/style/theme.h"

namespace limpid {
namespace {

constexpr float kHeight = 2.7f;         // of an item [text sizes]
constexpr float kAspect = 256 / 144.f;  // of a picture

float picture_width() { return std::round(kAspect * kHeight * ImGui::GetFontSize()); }

}  // namespace

const PictureTexture* PictureShelf::get(const std::filesystem::path& picture) {
  if (picture.empty()) return nullptr;
  const auto [known, is_new] = pictures_.try_emplace(picture);
  if (is_new) {
    try {
      known->second.emplace(picture);
    } catch (const std::exception&) {
      // There is none then.
    }
  }
  return known->second ? &*known->second : nullptr;
}

float picture_item_width(const PictureItem& item) {
  const float text = std::max(
      ImGui::CalcTextSize(item.name.c_str()).x,
      font(Face::small)->CalcTextSizeA(font(Face::small)->FontSize, 1e9f, 0, item.about.c_str()).x);
  return picture_width() + text + 2 * ImGui::GetStyle().ItemSpacing.x;
}

bool picture_item(const PictureItem& item, float width) {
  const float em = ImGui::GetFontSize(), gap = ImGui::GetStyle().ItemSpacing.x;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float height = std::round(kHeight * em), across = picture_width();
  ImGui::PushID(item.name.c_str());
  ImGui::PushID(item.about.c_str());
  ImGui::BeginDisabled(!item.there);
  const bool chosen = ImGui::Selectable("##item", false, 0, {width, height});
  ImGui::EndDisabled();
  ImGui::PopID();
  ImGui::PopID();
  const Palette& colours = current_palette();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 end(at.x + across, at.y + height);
  if (item.picture != nullptr) {
    list.AddImageRounded(item.picture->id(), at, end, {0, 0}, {1, 1},
                         IM_COL32(255, 255, 255, item.there ? 255 : 90), 3);
  } else {
    list.AddRectFilled(at, end, colour(colours.frame, 0.6f), 3);
  }
  const float left = end.x + gap;
  list.AddText({left, at.y + 0.1f * em}, colour(item.there ? colours.text : colours.muted),
               item.name.c_str());
  ImFont* small = font(Face::small);
  list.AddText(small, small->FontSize, {left, at.y + 1.45f * em}, colour(colours.muted),
               item.about.c_str());
  return chosen;
}

}  // namespace limpid
