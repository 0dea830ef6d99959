#include "app/desktop/experiments/new_sweep.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "app/base/folders.h"
#include "app/desktop/base/settings.h"
#include "app/desktop/widgets/modal.h"
#include "app/desktop/widgets/widgets.h"
#include "app/run/shipped_files.h"
#include "app/style/imgui_input.h"
#include "app/style/theme.h"
#include "app/sweep/read_axes.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTitle = "New sweep";
constexpr std::uint64_t kMostRuns = 20'000;  // for more there is the command line
constexpr std::size_t kMostRecordings = 6;
constexpr float kLabels = 7, kControls = 30;  // widths of the columns [em]

// Returns all that an axis can be about, in the order of the panels.
std::vector<const FieldInfo*> axis_fields() {
  std::vector<const FieldInfo*> fields;
  for (const ParameterInfo& info : parameter_table()) {
    const bool one_of_some = info.kind == FieldInfo::Kind::choice;
    if (one_of_some || (info.is_number() && info.slider_maximum > info.slider_minimum)) {
      fields.push_back(&info);
    }
  }
  fields.push_back(axis_field(kStiffnessKey));
  return fields;
}

// Draws an item of a list: words, and behind them the name in plans. Returns whether it is chosen.
bool item(const char* words, const char* name, bool present) {
  ImGui::PushID(name);
  ImGui::BeginGroup();  // a tooltip is of the whole row
  const bool chosen = ImGui::Selectable(words, present);
  ImGui::SameLine();
  ImGui::TextColored(colour_vector(current_palette().muted), "%s", name);
  ImGui::EndGroup();
  ImGui::PopID();
  return chosen;
}

void label(const char* words, const char* help) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(words);
  if (help[0] != '\0') tooltip(help);
  ImGui::TableNextColumn();
}

// Recordings of the user's, the newest first.
std::vector<fs::path> newest_recordings() {
  std::vector<std::pair<fs::file_time_type, fs::path>> found;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(sessions_dir(), none)) {
    if (entry.path().extension() == ".h5") {
      found.emplace_back(entry.last_write_time(none), entry.path());
    }
  }
  std::ranges::sort(found, std::greater());
  std::vector<fs::path> files;
  for (const auto& each : found) {
    if (files.size() < kMostRecordings) files.push_back(each.second);
  }
  return files;
}

// Returns what is wrong with a plan, without its file and line; empty for nothing.
std::string wrong_with(const std::string& text) {
  try {
    plan_of_text(text, "plan");
    return {};
  } catch (const std::exception& e) {
    const std::string what = e.what();
    const std::size_t colon = what.find(": ");
    return what.starts_with("plan:") && colon != std::string::npos ? what.substr(colon + 2) : what;
  }
}

// Returns what is wrong with the plan, by the words of the dialog; empty if nothing is.
std::string wrong_with(const SweepDraft& draft) {
  constexpr std::string_view kAxis = "axis.";
  std::string wrong = wrong_with(plan_text(draft));
  if (!wrong.starts_with(kAxis)) return wrong;
  for (const DraftAxis& each : draft.axes) {
    SweepDraft alone = draft;
    alone.axes = {each};
    const std::string here = wrong_with(plan_text(alone));
    if (!here.starts_with(kAxis)) continue;
    return fmt::format("{}, {}", axis_field(each.key)->caption, here.substr(kAxis.size()));
  }
  return wrong;
}

// Names the law of all runs, and says if it does not use a varied eta; empty if the law is varied
// itself.
std::string law_text(const SweepDraft& draft) {
  const auto varies = [&](std::string_view key) {
    return std::ranges::find(draft.axes, key, &DraftAxis::key) != draft.axes.end();
  };
  if (varies("coupling.kind")) return {};
  const LawInfo& law = info(draft.parameters.kind);
  std::string text = fmt::format("Law: {}.", law.label);
  if (varies("coupling.eta") && !law.takes_eta) {
    text += " It does not use \xCE\xB7. All values of \xCE\xB7 give the same result.";
  }
  return text;
}

}  // namespace

// Fills in what is likely: η from the slider's least to its most, by the hand that comes with the
// scene.
void NewSweepDialog::begin(const SweepBasis& basis) {
  hands_.clear();
  hand_ = 0;
  complaint_.clear();
  checked_.clear();
  const auto add_recording = [&](const fs::path& file) {
    for (const Hand& hand : hands_) {
      if (hand.file == file.string()) return;
    }
    hands_.push_back({"recording " + file.stem().string(), file.string()});
  };
  if (!basis.recording.empty()) add_recording(basis.recording);
  bool found = false;  // the hand of the scene's own name
  for (const std::string& name : shipped_names("hands")) {
    if (fs::path(name).extension() != ".csv") continue;
    const std::string stem = fs::path(name).stem().string();
    const bool of_scene = stem == fs::path(basis.scene).stem();
    if (basis.recording.empty() && (of_scene || (stem == "touch" && !found))) {
      hand_ = hands_.size();
      found = of_scene;
    }
    hands_.push_back({"recorded hand: " + stem, name});
  }
  for (const fs::path& file : newest_recordings()) add_recording(file);
  hands_.push_back({"a tap with 4 N on a wall of its own, without the scene", ""});
  if (first_.field != nullptr) return;  // as it was left
  const auto measures = measure_table();
  measure_ = static_cast<std::size_t>(
      std::ranges::find(measures, std::string_view("energy_highest"), &MeasureInfo::name) -
      measures.begin());
  first_.field = find_parameter("coupling.eta");
  first_.draft = {.key = first_.field->key, .from = 0.1, .to = 1, .count = 8, .logarithmic = true};
  second_.draft.count = 8;
}

void NewSweepDialog::choose_field(Axis& axis, const char* id, bool may_be_none) {
  ImGui::SetNextItemWidth(-1);
  const bool open =
      ImGui::BeginCombo(id, axis.field != nullptr ? axis.field->caption : "nothing else");
  note_place(id);
  if (!open) return;
  if (may_be_none && ImGui::Selectable("nothing else", axis.field == nullptr)) axis.field = nullptr;
  for (const FieldInfo* field : axis_fields()) {
    const bool here = axis.field == field;
    if (here && ImGui::IsWindowAppearing()) ImGui::SetScrollHereY();
    const bool chosen = item(field->caption, field->key, here);
    note_place(field->key);
    if (!chosen) continue;
    axis.field = field;
    const bool slider = field->slider_maximum > field->slider_minimum;
    const double least = slider ? field->slider_minimum : 500;
    axis.draft = {.key = field->key,
                  .from = field->logarithmic && least == 0 ? 1e-3 * field->slider_maximum : least,
                  .to = slider ? field->slider_maximum : 5000,
                  .count = axis.draft.count,
                  .logarithmic = field->logarithmic};
    axis.wanted.assign(field->words.size(), 1);
  }
  ImGui::EndCombo();
}

void NewSweepDialog::draw_values(Axis& axis, const char* id) {
  if (axis.field == nullptr) return;
  label("", "");
  ImGui::PushID(id);
  const float em = ImGui::GetFontSize();
  if (!axis.field->words.empty()) {
    for (std::size_t i = 0; i < axis.field->words.size(); ++i) {
      bool on = axis.wanted[i] != 0;
      if (i > 0) flow(axis.field->words[i]);
      if (ImGui::Checkbox(axis.field->words[i], &on)) axis.wanted[i] = on ? 1 : 0;
    }
    return ImGui::PopID();
  }
  const auto number = [&](const char* what, double& value) {
    ImGui::PushID(what);
    ImGui::TextUnformatted(what);
    ImGui::SameLine();
    ImGui::SetNextItemWidth(5 * em);
    ImGui::InputDouble("##number", &value, 0, 0, "%.6g");
    note_number_item();
    ImGui::PopID();
    note_place(fmt::format("{} {}", id, what).c_str());
    ImGui::SameLine();
  };
  number("from", axis.draft.from);
  number("to", axis.draft.to);
  ImGui::TextUnformatted(axis.field->has_unit() ? axis.field->unit : "");
  auto count = static_cast<int>(axis.draft.count);
  flow(8 * em);
  ImGui::TextUnformatted("in");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(3 * em);
  if (ImGui::InputInt("values", &count, 0)) {
    axis.draft.count = static_cast<std::uint64_t>(std::clamp(count, 2, 1000));
  }
  note_number_item();
  note_place(fmt::format("{} count", id).c_str());
  if (axis.draft.from > 0) {
    ImGui::Checkbox("spaced evenly in ratio", &axis.draft.logarithmic);
    tooltip(
        "On: values like 1, 10, 100 (equal ratios). Off: values like 1, 50, 100 (equal "
        "differences).");
  }
  ImGui::PopID();
}

void NewSweepDialog::draw_measure() {
  const auto measures = measure_table();
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##measure", measures[measure_].words)) {
    for (std::size_t i = 0; i < measures.size(); ++i) {
      if (item(measures[i].words, measures[i].name, i == measure_)) measure_ = i;
      tooltip(measures[i].what);
    }
    ImGui::EndCombo();
  }
  note_place("measure");
  tooltip(measures[measure_].what);
}

void NewSweepDialog::draw_hand() {
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##hand", hands_[hand_].label.c_str())) {
    for (std::size_t i = 0; i < hands_.size(); ++i) {
      ImGui::PushID(static_cast<int>(i));
      if (ImGui::Selectable(hands_[i].label.c_str(), i == hand_)) hand_ = i;
      ImGui::PopID();
    }
    ImGui::EndCombo();
  }
  note_place("hand");
}

std::uint64_t NewSweepDialog::points() const {
  std::uint64_t all = 1;
  for (const Axis* axis : {&first_, &second_}) {
    if (axis->field == nullptr) continue;
    all *= axis->field->words.empty()
               ? axis->draft.count
               : static_cast<std::uint64_t>(std::ranges::count(axis->wanted, 1));
  }
  return all;
}

SweepDraft NewSweepDialog::draft(const SweepBasis& basis) {
  SweepDraft draft{.device = basis.device,
                   .scene = basis.scene,
                   .hand = hands_[hand_].file,
                   .seconds = seconds_,
                   .parameters = basis.parameters};
  for (Axis* axis : {&first_, &second_}) {
    if (axis->field == nullptr) continue;
    axis->draft.words.clear();
    for (std::size_t i = 0; i < axis->wanted.size(); ++i) {
      if (axis->wanted[i] != 0) axis->draft.words.emplace_back(axis->field->words[i]);
    }
    draft.axes.push_back(axis->draft);
    draft.axes.back().logarithmic = axis->draft.logarithmic && axis->draft.from > 0;
    draft.title += (draft.title.empty() ? "" : " and ") + std::string(axis->field->caption);
  }
  draft.measures = {measure_table()[measure_].name};
  if (draft.measures.front() != "diverged") draft.measures.emplace_back("diverged");
  draft.title = fmt::format("{} over {}", measure_table()[measure_].words, draft.title);
  const std::string text = plan_text(draft);
  if (text != checked_) {
    checked_ = text;
    complaint_ = points() > kMostRuns ? fmt::format(
                                            "{} runs are too many: the window can do at most {}. "
                                            "`limpid sweep` has no such limit.",
                                            points(), kMostRuns)
                 : points() == 0 ? "Choose at least one entry of each list."
                                 : wrong_with(draft);
  }
  return draft;
}

void NewSweepDialog::draw(bool& open, const SweepBasis& basis, SweepController& controller) {
  const float wide = std::min((kLabels + kControls + 3) * ImGui::GetFontSize(),
                              0.96f * ImGui::GetMainViewport()->WorkSize.x);
  if (!begin_modal(kTitle, open, {wide, 0})) {
    shown_ = false;
    return;
  }
  if (!std::exchange(shown_, true)) begin(basis);
  ImGui::TextWrapped(
      "A sweep makes many runs in the background with different values of one or two settings, and "
      "draws a map of the results. Arm, scene and all other settings stay as they are now.");
  ImGui::Spacing();
  if (ImGui::BeginTable("asked", 2)) {
    const float em = ImGui::GetFontSize();
    ImGui::TableSetupColumn("label", ImGuiTableColumnFlags_WidthFixed, kLabels * em);
    ImGui::TableSetupColumn("control", ImGuiTableColumnFlags_WidthStretch);
    label("Vary", "The setting on the map's horizontal axis");
    choose_field(first_, "##first", false);
    draw_values(first_, "first");
    label("and", "The setting on the map's vertical axis, if there is a second setting");
    choose_field(second_, "##second", true);
    draw_values(second_, "second");
    label("Measure",
          "The value that is computed for each run. Limpid also notes for each run whether it "
          "diverged.");
    draw_measure();
    label("Hand", "The motion that moves the device, the same in each run");
    draw_hand();
    label("Length", "Length of each run. 0: as long as the hand's path.");
    ImGui::SetNextItemWidth(5 * em);
    ImGui::InputDouble("s, 0: as the hand", &seconds_, 0, 0, "%.3g");
    note_number_item();
    ImGui::EndTable();
  }
  draw_end(basis, controller);
  close_button("Cancel (Esc)", open);
  ImGui::EndPopup();
}

// Draws what the sweep comes to, what is wrong with it, and the button that starts it.
void NewSweepDialog::draw_end(const SweepBasis& basis, SweepController& controller) {
  const SweepDraft wanted = draft(basis);
  std::string wrong = complaint_;
  if (wrong.empty() && !wanted.hand.empty()) wrong = basis.why_not_scene;
  if (wrong.empty() && controller.runner().busy()) wrong = "Another sweep is running.";
  const bool may = wrong.empty();
  if (may && started_ == checked_) wrong = controller.why_not_started();
  ImGui::Spacing();
  ImGui::TextWrapped("%s",
                     fmt::format("{} runs, kept in {}", points(), sweeps_dir().string()).c_str());
  if (const std::string law = law_text(wanted); !law.empty()) ImGui::TextWrapped("%s", law.c_str());
  if (!wrong.empty()) {
    ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(current_palette().broken));
    ImGui::TextWrapped("%s", wrong.c_str());
    ImGui::PopStyleColor();
  }
  ImGui::BeginDisabled(!may);
  const bool start = noted_button("Start (Enter)");
  ImGui::EndDisabled();
  if (may && (start || accepted())) {
    started_ = checked_;
    controller.start(wanted);
  }
  ImGui::SameLine();
}

}  // namespace limpid
