#include "app/desktop/plots/export_dialog.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/desktop/widgets/modal.h"
#include "app/desktop/widgets/path_dialog.h"
#include "app/plot/plot_menu.h"
#include "app/style/imgui_input.h"
#include "app/style/palette.h"
#include "app/style/theme.h"
#include "app/style/words.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using What = ExportOrder::What;
using Format = ExportOrder::Format;

constexpr std::array kWhat{"a plot, as a picture", "all plots, as one figure",
                           "a plot, as a table (CSV)", "the whole window",
                           "the recording, as a video"};
constexpr double kLeastSize = 40, kMostSize = 400;  // limits of a size [mm]
constexpr int kLeastDpi = 72, kMostDpi = 1200;

// Tells whether plots are drawn for print.
bool is_drawn(What what) { return what == What::plot || what == What::figure; }

const char* ending(const ExportOrder& order) {
  if (order.what == What::table) return "csv";
  constexpr std::array kEndings{"png", "svg", "pdf"};
  return is_drawn(order.what) ? kEndings[static_cast<std::size_t>(order.format)] : "png";
}

// Returns a free name for the file.
fs::path offer(const ExportOrder& order, const Stage& stage, const fs::path& folder) {
  const bool of_plot = order.what == What::plot || order.what == What::table;
  const std::string name = of_plot && order.plot < stage.plots.size()
                               ? stage.plots[order.plot].spec().file_name
                           : order.what == What::figure ? "plots"
                                                        : "limpid";
  std::error_code none;
  for (int number = 1;; ++number) {
    fs::path file = folder / fmt::format("{}-{:03}.{}", name, number, ending(order));
    if (!fs::exists(file, none)) return file;
  }
}

}  // namespace

std::string wrong_ending(const ExportOrder& order, const fs::path& file) {
  const std::string wanted = fmt::format(".{}", ending(order));
  if (file.extension() == wanted) return {};
  return fmt::format("The name of this file has to end in {}.", wanted);
}

void ExportDialog::draw_what(const Stage& stage, bool recorded) {
  if (ImGui::BeginCombo("what", kWhat[static_cast<std::size_t>(order_.what)])) {
    for (std::size_t i = 0; i < kWhat.size(); ++i) {
      const auto what = static_cast<What>(i);
      if (what == What::video && !recorded) continue;
      if (ImGui::Selectable(kWhat[i], what == order_.what)) order_.what = what;
      note_place(kWhat[i]);
    }
    ImGui::EndCombo();
  }
  if (order_.what != What::plot && order_.what != What::table) return;
  order_.plot = std::min(order_.plot, std::max<std::size_t>(stage.plots.size(), 1) - 1);
  const std::string title =
      stage.plots.empty() ? "there is no plot" : stage.plots[order_.plot].spec().title;
  if (!ImGui::BeginCombo("plot", title.c_str())) return;
  for (std::size_t i = 0; i < stage.plots.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::Selectable(stage.plots[i].spec().title.c_str(), i == order_.plot)) order_.plot = i;
    ImGui::PopID();
  }
  ImGui::EndCombo();
}

void ExportDialog::draw_stretch(const Stage& stage) {
  const auto range = stage.group.range();
  if (!range || (!is_drawn(order_.what) && order_.what != What::table)) return;
  const std::string label =
      fmt::format("only the selected time, {:.3f} to {:.3f} s", range->start, range->stop);
  ImGui::Checkbox(label.c_str(), &order_.stretch);
  note_place("stretch");
}

// Asks for the size of each of these plots, which stand one above the other.
void ExportDialog::draw_size(std::size_t plots) {
  const auto choice = [](const char* label, auto& value, auto one) {
    if (ImGui::RadioButton(label, value == one)) value = one;
    note_place(label);
    ImGui::SameLine();
  };
  choice("PNG, pixels", order_.format, Format::png);
  choice("SVG, lines", order_.format, Format::svg);
  choice("PDF, a page", order_.format, Format::pdf);
  ImGui::NewLine();
  choice("light, for paper", order_.theme, Theme::light);
  choice("dark, for slides", order_.theme, Theme::dark);
  ImGui::NewLine();
  const float number = 7 * ImGui::GetFontSize();
  ImGui::SetNextItemWidth(number);
  ImGui::InputDouble("by", &order_.width, 0, 0, "%.0f mm");
  note_number_item();
  ImGui::SameLine();
  ImGui::SetNextItemWidth(number);
  ImGui::InputDouble(plots > 1 ? "each plot" : "printed", &order_.height, 0, 0, "%.0f mm");
  note_number_item();
  const double height = static_cast<double>(plots) * order_.height;
  if (plots > 1) {
    ImGui::TextDisabled("%zu plots one above the other: %.0f by %.0f mm", plots, order_.width,
                        height);
  }
  if (order_.format != Format::png) return;
  ImGui::SetNextItemWidth(number);
  ImGui::InputInt("dpi", &order_.dpi, 0);
  note_number_item();
  const double inch = 25.4;
  ImGui::SameLine();
  ImGui::TextDisabled("%.0f x %.0f pixels", std::round(order_.width / inch * order_.dpi),
                      std::round(height / inch * order_.dpi));
}

// Returns which value is wrong, and what is allowed; empty: all are right.
std::string ExportDialog::why_not() const {
  const auto outside = [](double x, double least, double most) {
    return !(x >= least && x <= most);
  };
  if (is_drawn(order_.what)) {
    if (outside(order_.width, kLeastSize, kMostSize) ||
        outside(order_.height, kLeastSize, kMostSize)) {
      return fmt::format("The size is {:g} x {:g} mm; allowed: {:g} to {:g} mm.", order_.width,
                         order_.height, kLeastSize, kMostSize);
    }
    if (order_.format == Format::png && outside(order_.dpi, kLeastDpi, kMostDpi)) {
      return fmt::format("{} dpi; allowed: {} to {}.", order_.dpi, kLeastDpi, kMostDpi);
    }
  }
  std::error_code none;
  const fs::path file = expanded(file_);
  if (file_.empty() || fs::is_directory(file, none)) return "The export needs the name of a file.";
  if (!fs::is_directory(fs::absolute(file).parent_path(), none)) {
    return fmt::format("There is no folder {}.", file.parent_path().string());
  }
  return wrong_ending(order_, file);
}

std::optional<ExportOrder> ExportDialog::draw(bool& open, const Stage& stage, std::size_t plot,
                                              const fs::path& folder, bool recorded) {
  const float em = ImGui::GetFontSize();
  const ImVec2 room = ImGui::GetMainViewport()->WorkSize;
  if (!begin_modal("Export", open, {std::min(36 * em, 0.94f * room.x), 0})) {
    was_open_ = false;
    return std::nullopt;
  }
  if (!was_open_) {
    order_.plot = plot;
    if (order_.what == What::video && !recorded) order_.what = What::plot;
    file_ = offered_ = "";
    replaces_.clear();
  }
  was_open_ = true;
  ImGui::PushItemWidth(-6 * em);
  draw_what(stage, recorded);
  draw_stretch(stage);
  if (is_drawn(order_.what)) draw_size(order_.what == What::figure ? stage.plots.size() : 1);
  // The name follows the choices until the user types another one.
  if (file_ == offered_) file_ = offered_ = offer(order_, stage, folder).string();
  const bool video = order_.what == What::video;
  bool entered = false;
  if (!video) {
    entered = ImGui::InputText("file", &file_, ImGuiInputTextFlags_EnterReturnsTrue);
  } else {
    ImGui::TextDisabled("The next dialog asks for length, size and speed.");
  }
  ImGui::PopItemWidth();
  const bool no_plot = stage.plots.empty() && (is_drawn(order_.what) || order_.what == What::table);
  const std::string wrong = video ? "" : no_plot ? "There is no plot." : why_not();
  std::error_code none;
  const fs::path file = expanded(file_);
  const bool there = !video && wrong.empty() && fs::exists(file, none);
  if (!wrong.empty() || there) {
    ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(current_palette().broken));
    ImGui::TextWrapped("%s", wrong.empty() ? "This file already exists." : wrong.c_str());
    ImGui::PopStyleColor();
  }
  ImGui::BeginDisabled(!wrong.empty());
  const bool pressed = noted_button(video   ? "Go on (Enter)"
                                    : there ? "Replace it (Enter)"
                                            : "Export (Enter)");
  ImGui::EndDisabled();
  ImGui::SameLine();
  close_button("Cancel (Esc)", open);
  std::optional<ExportOrder> given;
  if (wrong.empty() && (pressed || entered || accepted())) {
    given = order_;
    given->file = fs::absolute(file);
    open = false;
  }
  ImGui::EndPopup();
  return given;
}

}  // namespace limpid
