#include "app/desktop/widgets/picture_shelf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "app/style/theme.h"
#include "app/style/words.h"
#include "render/gl/image_texture.h"

namespace limpid {

void onto_dark(std::span<unsigned char> rgba, Rgb sheet) {
  const std::array paper{sheet.r, sheet.g, sheet.b};
  for (std::size_t i = 0; i + 3 < rgba.size(); i += 4) {
    const auto pixel = rgba.subspan(i, 3);
    const auto [least, most] = std::ranges::minmax(pixel);
    for (std::size_t c = 0; c < 3; ++c) {
      const int turned = pixel[c] + 255 - least - most;  // turned lightness, as HSL defines it
      pixel[c] = static_cast<unsigned char>(paper[c] + turned * (255 - paper[c]) / 255);
    }
  }
}

PictureTexture::PictureTexture(const std::filesystem::path& file, std::optional<Rgb> sheet) {
  texture_ = load_texture(file, width_, height_, [&](std::span<unsigned char> rgba) {
    if (sheet) onto_dark(rgba, *sheet);
  });
}

PictureTexture::~PictureTexture() { delete_texture(texture_); }

PictureTexture::PictureTexture(PictureTexture&& other) noexcept
    : texture_(std::exchange(other.texture_, 0)), width_(other.width_), height_(other.height_) {}

PictureTexture& PictureTexture::operator=(PictureTexture&& other) noexcept {
  std::swap(texture_, other.texture_);
  std::swap(width_, other.width_);
  std::swap(height_, other.height_);
  return *this;
}

ImTextureID PictureTexture::id() const {
  // ImGui's type for it is a pointer.
  return reinterpret_cast<ImTextureID>(  // NOLINT(performance-no-int-to-ptr)
      static_cast<std::intptr_t>(texture_));
}

namespace {

constexpr float kHeight = 2.7f;         // height of an item [text sizes]
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
      // A picture that cannot be read stays empty.
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

bool picture_item(const PictureItem& item, float width, bool marked) {
  const float em = ImGui::GetFontSize(), gap = ImGui::GetStyle().ItemSpacing.x;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float right = at.x + ImGui::GetContentRegionAvail().x;
  const float height = std::round(kHeight * em), across = picture_width();
  ImGui::PushID(item.name.c_str());
  ImGui::PushID(item.about.c_str());
  ImGui::BeginDisabled(!item.there);
  const bool chosen = ImGui::Selectable("##item", marked, 0, {width, height});
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
  const float room = (width > 0 ? at.x + width : right) - left;
  list.AddText({left, at.y + 0.1f * em}, colour(item.there ? colours.text : colours.muted),
               shortened(item.name, room, ImGui::GetFont()).c_str());
  ImFont* small = font(Face::small);
  list.AddText(small, small->FontSize, {left, at.y + 1.45f * em}, colour(colours.muted),
               shortened(item.about, room, small).c_str());
  return chosen;
}

}  // namespace limpid
