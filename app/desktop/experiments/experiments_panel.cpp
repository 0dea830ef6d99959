#include "app/desktop/experiments/experiments_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cctype>
#include <utility>

#include "app/desktop/base/settings.h"
#include "app/desktop/widgets/modal.h"
#include "app/desktop/widgets/widgets.h"
#include "app/style/palette.h"
#include "app/style/theme.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFigure = "the figure";

// Folder of the results on an arm.
fs::path experiments_dir(const ExperimentArm& on) {
  std::string name = on.name;
  std::ranges::replace(name, '/', '_');  // an arm's name may be any text
  return sessions_dir().parent_path() / (on.built_in() ? "experiments" : "experiments on " + name);
}

std::vector<fs::path> sessions_in(const fs::path& dir) {
  std::vector<fs::path> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(dir, none)) {
    if (entry.path().extension() == ".h5") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

// The verdict on all checks in a word.
const char* word_for(const Outcome& outcome) {
  if (!outcome.passed()) return "failed";
  return outcome.arm.empty() ? "passed" : "measured";
}

// Draws each check in words, its value with what it was judged by, and its verdict.
void draw_checks(const std::vector<Check>& checks) {
  const Palette& colours = current_palette();
  if (!ImGui::BeginTable("checks", 2, ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerH)) {
    return;
  }
  ImGui::TableSetupColumn("check", ImGuiTableColumnFlags_WidthStretch);
  ImGui::TableSetupColumn("verdict", ImGuiTableColumnFlags_WidthFixed,
                          ImGui::CalcTextSize("measured").x);
  for (const Check& check : checks) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextWrapped("%s", check.what.c_str());
    ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(colours.muted));
    ImGui::TextWrapped("%.4g %s %.4g", check.value, check.least ? "\u2265" : "\u2264", check.bound);
    for (const std::string& words :
         {check.against ? check.against->conditions : "", check.unjudged}) {
      if (!words.empty()) ImGui::TextWrapped("%s", words.c_str());
    }
    ImGui::PopStyleColor();
    ImGui::TableNextColumn();
    ImGui::TextColored(colour_vector(check.failed() ? colours.broken : colours.text), "%s",
                       !check.unjudged.empty() ? "measured"
                       : check.passed          ? "passed"
                                               : "failed");
  }
  ImGui::EndTable();
}

}  // namespace

// Offers the built-in arm and the one on the screen, without and with the readings of its file.
void ExperimentsPanel::offer(const ArmDescription& arm) {
  if (running_.busy() || !queue_.empty()) return;  // they run on what was chosen
  const auto& [text, tip] = offered_for_;
  if (!offered_.empty() && text == arm.urdf && tip == arm.tip_link) return;
  offered_for_ = {arm.urdf, arm.tip_link};
  const bool had_readings = !offered_.empty() && on().arm.readings;
  const bool was_built_in = offered_.empty() || on().arm.built_in();
  offered_ = {{built_in_arm(), {}}};
  if (arm.urdf != offered_.front().arm.description.urdf) {
    offered_.push_back({experiment_arm(arm, false), {}});
  }
  ExperimentArm rough = experiment_arm(arm, true);
  if (rough.settings.encoder_step > 0 || rough.settings.device_delay > 0) {
    offered_.push_back({std::move(rough), {}});
  }
  for (Offered& each : offered_) {
    for (const Experiment& one : experiments()) {
      if (std::string why = why_not(one, each.arm); !why.empty()) {
        each.refusals.emplace(one.name, std::move(why));
      }
    }
  }
  on_ = was_built_in ? 0 : std::min<std::size_t>(had_readings ? 2 : 1, offered_.size() - 1);
}

const std::string& ExperimentsPanel::refusal(const Experiment& experiment) const {
  static const std::string kNone;
  const auto found = on().refusals.find(experiment.name);
  return found == on().refusals.end() ? kNone : found->second;
}

fs::path ExperimentsPanel::dir() const { return experiments_dir(on().arm); }

ExperimentsPanel::Verdict* ExperimentsPanel::verdict_of(const Experiment& experiment) {
  const auto found = verdicts_.find(dir() / experiment.name);
  return found == verdicts_.end() ? nullptr : &found->second;
}

void ExperimentsPanel::start(const Experiment& experiment) {
  current_ = &experiment;
  began_ = ImGui::GetTime();
  stopping_ = false;
  ++begun_;
  TrialRunner::Options options;
  options.dir = dir();
  options.arm = on().arm;
  options.threads = 1;  // the loop and the picture need the rest
  running_.start(experiment.name, [&experiment, options](TaskProgress& progress) mutable {
    options.stop = &progress.cancel;
    options.progress = [&progress](double part) { progress.part = part; };
    Outcome outcome = carry_out(experiment, options);
    write_report(options.dir);  // on all results in the folder
    return outcome;
  });
}

void ExperimentsPanel::take() {
  bool ended = false;
  try {
    if (auto outcome = running_.take()) {
      ended = true;
      Verdict verdict{.outcome = std::move(*outcome),
                      .file = dir() / (std::string(current_->name) + ".png"),
                      .trials = sessions_in(dir() / current_->name)};
      const bool passed = verdict.outcome.passed();
      notices_.say(
          fmt::format("{}{}: {}", current_->name, on().arm.built_in() ? "" : " on " + on().arm.name,
                      passed ? word_for(verdict.outcome) : "a check failed"),
          !passed);
      verdicts_.insert_or_assign(dir() / current_->name, std::move(verdict));
      if (!chosen_) shown_ = current_;
    }
  } catch (const std::exception& e) {
    ended = true;
    if (!stopping_) notices_.say(fmt::format("{}: {}", current_->name, e.what()), true);
    queue_.clear();
  }
  // An experiment may end by itself before it hears that it is to stop.
  if (ended && std::exchange(stopping_, false)) {
    notices_.say("The experiments have stopped. Finished trials are kept and are not run again.");
  }
  if (!running_.busy() && queue_.empty()) begun_ = 0;
  if (!running_.busy() && !queue_.empty()) {
    const Experiment& next = *queue_.front();
    queue_.erase(queue_.begin());
    start(next);
  }
}

void ExperimentsPanel::drop_pictures() {
  for (auto& [name, verdict] : verdicts_) verdict.figure.reset();
}

std::string ExperimentsPanel::under_way() const {
  if (!running_.busy()) return {};
  const double elapsed = ImGui::GetTime() - began_, part = running_.part();
  std::string text = fmt::format("{} of {}: {}", begun_,
                                 static_cast<std::size_t>(begun_) + queue_.size(), current_->name);
  if (part > 0.02) text += fmt::format(", {:.0f} s left", elapsed * (1 - part) / part);
  return text;
}

fs::path ExperimentsPanel::draw(bool& open, ScreenRect view, const ArmDescription& arm) {
  take();
  offer(arm);
  if (!open) return {};
  fs::path chosen;
  // At the window's right edge it leaves the arm, its plots and the pressed button in sight.
  const ImVec2 room = ImGui::GetMainViewport()->Size;
  const float em = ImGui::GetFontSize();
  const float left = std::max(0.0f, std::min(0.42f * room.x, room.x - 46 * em));
  const float high = std::min(std::max(0.84f * room.y, 34 * em), room.y - view.min.y);
  ImGui::SetNextWindowPos({left, view.min.y}, ImGuiCond_Appearing);
  ImGui::SetNextWindowSize({room.x - left, high}, ImGuiCond_Appearing);
  if (begin_dialog("Experiments", open, ImGuiWindowFlags_None)) {
    const float list = std::min(22 * em, 0.5f * ImGui::GetContentRegionAvail().x);
    ImGui::BeginGroup();
    ImGui::SetNextItemWidth(list);
    draw_arm();
    const float buttons = ImGui::GetFrameHeight() + 2 * ImGui::GetStyle().ItemSpacing.y;
    ImGui::BeginChild("list", {list, -buttons});
    draw_list();
    ImGui::EndChild();
    draw_buttons();
    ImGui::SameLine();
    close_button("Close (Esc)", open);
    ImGui::EndGroup();
    ImGui::SameLine();
    ImGui::BeginChild("verdict", {0, 0});
    Verdict* verdict = shown_ == nullptr ? nullptr : verdict_of(*shown_);
    if (verdict != nullptr) {
      chosen = draw_verdict(*verdict);
    } else {
      ImGui::TextWrapped(
          "The list shows the paper's experiments, then the experiments on the predictive law and "
          "on moving objects. Each experiment runs in the ordinary loop, with recorded hand "
          "motions or with motions computed from a fixed seed. Figures, tables, verdicts and all "
          "trials are saved in this folder:\n%s",
          dir().c_str());
      ImGui::Spacing();
      ImGui::TextWrapped(
          "Run an experiment from the list at the left. Its figure and checks then appear here.");
    }
    ImGui::EndChild();
  }
  ImGui::End();
  return chosen;
}

// Draws the choice of the arm on which experiments run.
void ExperimentsPanel::draw_arm() {
  const auto label = [](const Offered& each) {
    return each.arm.built_in() ? "On the built-in arm, ideal" : "On " + each.arm.name;
  };
  ImGui::BeginDisabled(running_.busy() || !queue_.empty());
  const bool open = ImGui::BeginCombo("##arm", label(on()).c_str());
  note_place("arm of the experiments");
  if (open) {
    for (std::size_t i = 0; i < offered_.size(); ++i) {
      const std::string words = label(offered_[i]);
      if (ImGui::Selectable(words.c_str(), i == on_)) on_ = i;
      note_place(words.c_str());
    }
    ImGui::EndCombo();
  }
  ImGui::EndDisabled();
  tooltip(
      "Bounds are promised for the built-in arm alone. On another arm, experiments measure and do "
      "not judge. To choose another arm, open it first (Device > Open arm).");
}

// Draws the name of the command and the state of an experiment, or why it does not run, below its
// words.
void ExperimentsPanel::draw_state(const Experiment& experiment) {
  const Palette& colours = current_palette();
  if (const std::string& refused = refusal(experiment); !refused.empty()) {
    ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(colours.muted));
    ImGui::TextWrapped("%s", refused.c_str());
    ImGui::PopStyleColor();
    return;
  }
  ImGui::TextColored(colour_vector(colours.muted), "%s", experiment.name);
  if (running_.busy() && current_ == &experiment) {
    ImGui::SameLine();
    const double elapsed = ImGui::GetTime() - began_;
    const double part = running_.part();
    progress_bar(part, 0,
                 part > 0.02 ? fmt::format("{:.0f} s left", elapsed * (1 - part) / part) : "");
    return;
  }
  const Verdict* verdict = verdict_of(experiment);
  if (verdict == nullptr) return;
  ImGui::SameLine();
  ImGui::TextColored(colour_vector(verdict->outcome.passed() ? colours.text : colours.broken), "%s",
                     word_for(verdict->outcome));
}

// Draws an experiment's words as an item that can be chosen, over as many lines as they take.
void ExperimentsPanel::draw_words(const Experiment& experiment) {
  std::string words = experiment.about;
  words.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(words.front())));
  const float width = ImGui::GetContentRegionAvail().x;
  const ImVec2 size = ImGui::CalcTextSize(words.c_str(), nullptr, false, width);
  const ImVec2 at = ImGui::GetCursorPos();
  if (ImGui::Selectable("##words", shown_ == &experiment, 0, {width, size.y})) {
    shown_ = &experiment;
    chosen_ = true;
  }
  note_place(experiment.name);
  const ImVec2 below = ImGui::GetCursorPos();
  ImGui::SetCursorPos(at);
  ImGui::TextWrapped("%s", words.c_str());
  ImGui::SetCursorPos(below);
}

void ExperimentsPanel::draw_list() {
  const float em = ImGui::GetFontSize();
  if (ImGui::BeginTable("experiments", 2)) {
    ImGui::TableSetupColumn("run", ImGuiTableColumnFlags_WidthFixed, 4 * em);
    ImGui::TableSetupColumn("words", ImGuiTableColumnFlags_WidthStretch);
    for (const Experiment& experiment : experiments()) {
      ImGui::PushID(experiment.name);
      ImGui::TableNextColumn();
      const bool runs = running_.busy() && current_ == &experiment;
      const bool waits = std::ranges::find(queue_, &experiment) != queue_.end();
      const std::string& refused = refusal(experiment);
      ImGui::BeginDisabled(runs || waits || !refused.empty());
      if (ImGui::Button(runs ? "runs" : waits ? "waits" : "Run", {-1, 0})) {
        queue_.push_back(&experiment);
      }
      note_place(("Run " + std::string(experiment.name)).c_str());
      ImGui::EndDisabled();
      ImGui::TableNextColumn();
      draw_words(experiment);
      draw_state(experiment);
      ImGui::Dummy({0, 0.4f * em});  // its lines stand closer to each other than to the next
      ImGui::PopID();
    }
    ImGui::EndTable();
  }
}

void ExperimentsPanel::draw_buttons() {
  if (running_.busy()) {
    ImGui::BeginDisabled(stopping_);
    if (noted_button("Stop")) {
      queue_.clear();
      stopping_ = true;
      running_.ask_to_stop();  // ends at its own pace while the window goes on
    }
    ImGui::EndDisabled();
  } else if (noted_button("Run all")) {
    chosen_ = false;
    for (const Experiment& experiment : experiments()) {
      if (refusal(experiment).empty()) queue_.push_back(&experiment);
    }
  }
}

// Loads the figure for the theme. Files are for print, on white; a dark window shows them dark.
void ExperimentsPanel::show_figure(Verdict& verdict) {
  const Theme theme = current_theme();
  if (verdict.shown_in == theme) return;
  verdict.shown_in = theme;
  try {
    verdict.figure.emplace(verdict.file,
                           is_dark(theme) ? std::optional(current_palette().panel) : std::nullopt);
  } catch (const std::exception& e) {
    verdict.figure.reset();
    notices_.say(e.what(), true);
  }
}

// Draws the figure as wide as the panel; a click shows it as large as the window.
void ExperimentsPanel::draw_figure(const PictureTexture& figure) {
  const float whole = ImGui::GetContentRegionAvail().x, width = std::min(whole, figure.width());
  ImGui::Image(figure.id(), {width, width * figure.height() / figure.width()});
  note_place(kFigure);
  if (ImGui::IsItemHovered()) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
  tooltip("Click to show the figure in the size of the window.");
  if (ImGui::IsItemClicked()) ImGui::OpenPopup(kFigure);
  const ImGuiViewport& window = *ImGui::GetMainViewport();
  const ImVec2 most{0.96f * window.WorkSize.x, 0.96f * window.WorkSize.y};
  ImGui::SetNextWindowPos(window.GetWorkCenter(), ImGuiCond_Always, {0.5f, 0.5f});
  if (!ImGui::BeginPopup(kFigure, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove)) {
    return;
  }
  const ImGuiStyle& style = ImGui::GetStyle();
  const float line = ImGui::GetFrameHeight() + style.ItemSpacing.y;
  const float scale = std::min((most.x - 2 * style.WindowPadding.x) / figure.width(),
                               (most.y - 2 * style.WindowPadding.y - line) / figure.height());
  ImGui::Image(figure.id(), {scale * figure.width(), scale * figure.height()});
  if (noted_button("Close (Esc)")) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
}

fs::path ExperimentsPanel::draw_verdict(Verdict& verdict) {
  show_figure(verdict);
  if (verdict.figure) draw_figure(*verdict.figure);
  ImGui::TextWrapped("%s", verdict.outcome.figure.caption.c_str());
  ImGui::Spacing();
  draw_checks(verdict.outcome.checks);
  fs::path chosen;
  if (verdict.trials.empty()) return chosen;
  heading("Trials, to open in playback");
  for (const fs::path& trial : verdict.trials) {
    if (ImGui::Selectable(trial.stem().c_str())) chosen = trial;
  }
  return chosen;
}

}  // namespace limpid
