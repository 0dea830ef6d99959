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

fs::path experiments_dir() { return sessions_dir().parent_path() / "experiments"; }

std::vector<fs::path> sessions_of(const Experiment& experiment) {
  std::vector<fs::path> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(experiments_dir() / experiment.name, none)) {
    if (entry.path().extension() == ".h5") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
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

void ExperimentsPanel::start(const Experiment& experiment) {
  current_ = &experiment;
  began_ = ImGui::GetTime();
  stopping_ = false;
  ++begun_;
  running_.start(experiment.name, [&experiment](TaskProgress& progress) {
    TrialRunner::Options options;
    options.dir = experiments_dir();
    options.threads = 1;  // the loop and the picture need the rest
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
                      .file = experiments_dir() / (std::string(current_->name) + ".png"),
                      .trials = sessions_of(*current_)};
      notices_.say(fmt::format("{}: {}", current_->name,
                               verdict.outcome.passed() ? "passed" : "a check failed"),
                   !verdict.outcome.passed());
      verdicts_.insert_or_assign(current_->name, std::move(verdict));
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

fs::path ExperimentsPanel::draw(bool& open, ScreenRect view) {
  take();
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
    const auto found = shown_ == nullptr ? verdicts_.end() : verdicts_.find(shown_->name);
    if (found != verdicts_.end()) {
      chosen = draw_verdict(found->second);
    } else {
      ImGui::TextWrapped(
          "The list shows the paper's experiments, then the experiments on the predictive law and "
          "on moving objects. Each experiment runs in the ordinary loop, with recorded hand "
          "motions or with motions computed from a fixed seed. Figures, tables, verdicts and all "
          "trials are saved in this folder:\n%s",
          experiments_dir().c_str());
      ImGui::Spacing();
      ImGui::TextWrapped(
          "Run an experiment from the list at the left. Its figure and checks then appear here.");
    }
    ImGui::EndChild();
  }
  ImGui::End();
  return chosen;
}

// Draws the name of the command and the state of an experiment, below its words.
void ExperimentsPanel::draw_state(const Experiment& experiment) {
  const Palette& colours = current_palette();
  ImGui::TextColored(colour_vector(colours.muted), "%s", experiment.name);
  if (running_.busy() && current_ == &experiment) {
    ImGui::SameLine();
    const double elapsed = ImGui::GetTime() - began_;
    const double part = running_.part();
    progress_bar(part, 0,
                 part > 0.02 ? fmt::format("{:.0f} s left", elapsed * (1 - part) / part) : "");
    return;
  }
  const auto found = verdicts_.find(experiment.name);
  if (found == verdicts_.end()) return;
  const bool passed = found->second.outcome.passed();
  ImGui::SameLine();
  ImGui::TextColored(colour_vector(passed ? colours.text : colours.broken), "%s",
                     passed ? "passed" : "failed");
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
      ImGui::BeginDisabled(runs || waits);
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
    for (const Experiment& experiment : experiments()) queue_.push_back(&experiment);
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
