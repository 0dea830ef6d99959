#include "app/desktop/shell/file_question.h"

#include <imgui.h>

#include <utility>

#include "app/base/session_bus.h"
#include "app/desktop/widgets/modal.h"

namespace limpid {

namespace fs = std::filesystem;

fs::path FileQuestion::draw(bool& open, const std::function<Place()>& place) {
  if (!open) {
    asked_ = false;
    portal_.reset();
    return dialog_.draw(open, {});
  }
  const Place now = place();
  if (!std::exchange(asked_, true) && !now.own && has_session_bus()) {
    const PathDialog::Options& of = dialog_.options();
    portal_.emplace(FilePortal::Question{.title = of.title,
                                         .action = of.action,
                                         .extensions = of.extensions,
                                         .new_file = of.new_file,
                                         .first = fs::absolute(now.first),
                                         .parent = now.parent});
  }
  const auto state = portal_ ? portal_->state() : FilePortal::State::absent;
  if (state == FilePortal::State::asked) return {};
  if (state == FilePortal::State::shown) {
    draw_waiting(open);
    return {};
  }
  if (state == FilePortal::State::given_up) open = false;
  if (state == FilePortal::State::chosen) {
    fs::path file = dialog_.take(portal_->file());
    open = file.empty();
    if (!open) return file;
  }
  portal_.reset();
  return dialog_.draw(open, now.first, now.places);
}

// Draws a note on the desktop's dialog, with a way out for users who do not find it.
void FileQuestion::draw_waiting(bool& open) {
  if (!begin_modal(dialog_.options().title, open, {30 * ImGui::GetFontSize(), 0})) return;
  ImGui::TextWrapped("Choose the file in your desktop's own dialog.");
  ImGui::Spacing();
  if (noted_button("Ask here instead")) portal_.reset();
  ImGui::SameLine();
  close_button("Cancel (Esc)", open);
  ImGui::EndPopup();
}

}  // namespace limpid
