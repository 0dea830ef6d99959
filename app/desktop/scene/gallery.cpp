#include "app/desktop/scene/gallery.h"

#include <imgui.h>
#include <imgui_stdlib.h>
#include <toml++/toml.h>

#include <algorithm>

#include "app/base/folders.h"
#include "app/desktop/base/settings.h"
#include "app/desktop/widgets/modal.h"
#include "app/desktop/widgets/widgets.h"
#include "app/style/palette.h"
#include "app/style/theme.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

fs::path if_there(const fs::path& file) {
  std::error_code none;
  return fs::is_regular_file(file, none) ? file : fs::path();
}

// Draws shapes on a table, for scenes without a picture.
void draw_placeholder(const ImVec2& at, const ImVec2& size) {
  const Palette& p = current_palette();
  ImDrawList* draw = ImGui::GetWindowDrawList();
  const ImVec2 to(at.x + size.x, at.y + size.y);
  draw->AddRectFilled(at, to, colour(p.backdrop), 3);
  const float ground = at.y + 0.7f * size.y, r = 0.13f * size.y;
  draw->AddLine({at.x + 0.15f * size.x, ground}, {at.x + 0.85f * size.x, ground}, colour(p.axis),
                1.5f * current_scale());
  draw->AddCircle({at.x + 0.4f * size.x, ground - r}, r, colour(p.muted), 24,
                  1.5f * current_scale());
  draw->AddRect({at.x + 0.52f * size.x, ground - 1.7f * r}, {at.x + 0.66f * size.x, ground},
                colour(p.muted), 0, 0, 1.5f * current_scale());
}

// Returns the cards whose title, text or file has a part.
std::vector<const GalleryCard*> cards_with(const std::string& part,
                                           const std::vector<GalleryCard>& cards) {
  std::vector<const GalleryCard*> with;
  for (const GalleryCard& card : cards) {
    const std::string words =
        card.title + "\n" + card.about + "\n" + card.scene.filename().string();
    if (has_part(words, part)) with.push_back(&card);
  }
  return with;
}

}  // namespace

std::vector<GalleryCard> gallery_of(const fs::path& folder, const fs::path& sessions) {
  std::vector<GalleryCard> cards;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (entry.path().extension() != ".toml") continue;
    const std::string name = entry.path().stem().string();
    GalleryCard card{entry.path(), name, "", if_there(folder / "thumbnails" / (name + ".png")),
                     if_there(sessions / (name + ".h5"))};
    try {
      const toml::table text = toml::parse_file(entry.path().string());
      card.title = text["title"].value_or(name);
      card.about = text["about"].value_or(std::string());
    } catch (const toml::parse_error& e) {
      card.about = "Cannot be read: " + std::string(e.description());
    }
    cards.push_back(std::move(card));
  }
  std::ranges::sort(cards, {}, &GalleryCard::title);
  return cards;
}

void Gallery::read() {
  shipped_ = gallery_of(data_dir() / "assets/scenes", data_dir() / "assets/sessions");
  own_ = gallery_of(scenes_dir(), sessions_dir());
}

void Gallery::drop_pictures() { pictures_.clear(); }

fs::path Gallery::draw(bool& open) {
  const ImGuiViewport* screen = ImGui::GetMainViewport();
  const float em = ImGui::GetFontSize();
  const bool shown = begin_modal("Gallery", open,
                                 {std::min(64 * em, 0.94f * screen->WorkSize.x),
                                  std::min(44 * em, 0.9f * screen->WorkSize.y)});
  const bool begins = shown && !was_shown_;
  was_shown_ = shown;
  fs::path chosen;
  if (!shown) return chosen;
  if (begins) {
    read();
    typed_.clear();
    keys_.forget();
    ImGui::SetKeyboardFocusHere();
  }
  ImGui::SetNextItemWidth(-1);
  const bool entered = ImGui::InputTextWithHint("##part", "a part of a name or of its description",
                                                &typed_, ImGuiInputTextFlags_EnterReturnsTrue);
  if (ImGui::IsItemEdited()) keys_.forget();
  const auto own = cards_with(typed_, own_), shipped = cards_with(typed_, shipped_);
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const float room = ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ScrollbarSize;
  const int columns = std::max(1, static_cast<int>((room + gap) / (18 * em)));
  const float width = (room - gap * static_cast<float>(columns - 1)) / static_cast<float>(columns);
  keys_.move(static_cast<int>(own.size() + shipped.size()), columns);
  int number = 0;
  const auto cards = [&](const char* name, const std::vector<const GalleryCard*>& list) {
    if (list.empty()) return;
    heading(name);
    int column = 0;
    for (const GalleryCard* card : list) {
      if (column++ % columns != 0) ImGui::SameLine();
      const fs::path file = draw_card(*card, &list == &own, width, number++);
      if (!file.empty()) chosen = file;
    }
  };
  ImGui::BeginChild("cards", {0, -ImGui::GetFrameHeightWithSpacing()});
  cards("Yours", own);
  cards("Shipped with Limpid", shipped);
  const GalleryCard* first = !own.empty()       ? own.front()
                             : !shipped.empty() ? shipped.front()
                                                : nullptr;
  if (first == nullptr) ImGui::TextDisabled("no scene of this name");
  ImGui::EndChild();
  if (entered && chosen.empty() && !typed_.empty() && first != nullptr) chosen = first->scene;
  close_button("Close (Esc)", open);
  ImGui::SameLine();
  ImGui::TextDisabled(
      "Arrow keys and Enter choose a scene. Enter after a name opens the first scene.");
  ImGui::EndPopup();
  if (!chosen.empty()) open = false;
  return chosen;
}

fs::path Gallery::draw_card(const GalleryCard& card, bool own, float width, int number) {
  const float em = ImGui::GetFontSize();
  const float pad = 0.5f * em;
  const bool at = keys_.at(number);
  const ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 least = list.GetClipRectMin(), most = list.GetClipRectMax();
  const ImVec2 shot(width - 2 * pad, 0.5625f * (width - 2 * pad));
  const ImVec2 size(width, shot.y + 6.6f * em + ImGui::GetFrameHeight());
  ImGui::PushID(card.scene.c_str());
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {pad, pad});
  ImGui::BeginChild("card", size, true,
                    ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  const ImVec2 corner = ImGui::GetWindowPos(), start = ImGui::GetCursorScreenPos();
  if (const PictureTexture* texture = pictures_.get(card.picture)) {
    ImGui::Image(texture->id(), shot);
  } else {
    draw_placeholder(start, shot);
    ImGui::Dummy(shot);
  }
  ImGui::PushFont(font(Face::semibold));
  ImGui::TextUnformatted(card.title.c_str());
  ImGui::PopFont();
  if (own) {
    ImGui::SameLine();
    ImGui::TextDisabled("%s", card.scene.filename().c_str());
  }
  const ImVec2 text = ImGui::GetCursorScreenPos();
  ImGui::PushClipRect(text, {text.x + shot.x, text.y + 3.6f * em}, true);
  ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(current_palette().muted));
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(card.about.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
  ImGui::PopClipRect();
  ImGui::SetCursorPosY(size.y - ImGui::GetFrameHeight() - pad);
  bool on_button = false;
  fs::path chosen;
  if (!card.session.empty()) {
    if (ImGui::Button("Play its recorded session")) chosen = card.session;
    on_button = ImGui::IsItemHovered();
  }
  // The rest of the card opens the scene, and so does Enter.
  const bool over = ImGui::IsWindowHovered() && !on_button;
  if (keys_.taken(number)) chosen = card.scene;
  if (over || at) {
    const ImVec2 end(corner.x + size.x, corner.y + size.y);
    ImGui::PushClipRect(least, most, false);  // the border lies outside of the card
    ImGui::GetWindowDrawList()->AddRect(corner, end, colour(current_palette().accent), 3, 0,
                                        2 * current_scale());
    ImGui::PopClipRect();
  }
  if (over) {
    ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    if (ImGui::IsMouseReleased(ImGuiMouseButton_Left)) chosen = card.scene;
  }
  ImGui::EndChild();
  ImGui::PopStyleVar();
  ImGui::PopID();
  return chosen;
}

}  // namespace limpid
