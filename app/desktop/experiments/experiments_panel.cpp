#include "app/desktop/experiments/experiments_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "app/desktop/base/settings.h"
#include "app/desktop/widgets/modal.h"
#include "app/desktop/widgets/widgets.h"
#include "app/style/palette.h"
#include "app/style/theme.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

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
  try {
    if (auto outcome = running_.take()) {
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
    if (stopping_) {
      notices_.say("Stopped; finished trials are kept and are not run again.");
    } else {
      notices_.say(fmt::format("{}: {}", current_->name, e.what()), true);
    }
    queue_.clear();
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
  const float left = std::min(0.42f * room.x, room.x - 44 * ImGui::GetFontSize());
  ImGui::SetNextWindowPos({std::max(0.0f, left), view.min.y}, ImGuiCond_Appearing);
  ImGui::SetNextWindowSize({room.x - std::max(0.0f, left), 0.84f * room.y}, ImGuiCond_Appearing);
  if (begin_dialog("Experiments", open, ImGuiWindowFlags_None)) {
    ImGui::BeginGroup();
    const float buttons = ImGui::GetFrameHeight() + 2 * ImGui::GetStyle().ItemSpacing.y;
    ImGui::BeginChild("list", {19 * ImGui::GetFontSize(), -buttons});
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
          "The paper's experiments, each run by the ordinary loop with recorded and seeded hands. "
          "Figures, tables, verdicts and every trial are kept in %s.",
          experiments_dir().c_str());
      ImGui::Spacing();
      for (const Experiment& experiment : experiments()) {
        ImGui::Bullet();
        ImGui::TextWrapped("%s: %s", experiment.name, experiment.about);
      }
    }
    ImGui::EndChild();
  }
  ImGui::End();
  return chosen;
}

// Draws the state of an experiment at the end of its row.
void ExperimentsPanel::draw_state(const Experiment& experiment) {
  const Palette& colours = current_palette();
  if (running_.busy() && current_ == &experiment) {
    const double elapsed = ImGui::GetTime() - began_;
    const double part = running_.part();
    progress_bar(part, 0,
                 part > 0.02 ? fmt::format("{:.0f} s left", elapsed * (1 - part) / part) : "");
    return;
  }
  const auto found = verdicts_.find(experiment.name);
  if (found == verdicts_.end()) return;
  const bool passed = found->second.outcome.passed();
  ImGui::TextColored(colour_vector(passed ? colours.muted : colours.broken), "%s",
                     passed ? "passed" : "failed");
}

// Each column keeps its width, so that nothing moves when an experiment starts or ends.
void ExperimentsPanel::draw_list() {
  const float em = ImGui::GetFontSize();
  if (ImGui::BeginTable("experiments", 3)) {
    ImGui::TableSetupColumn("run", ImGuiTableColumnFlags_WidthFixed, 4 * em);
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("state", ImGuiTableColumnFlags_WidthFixed, 5.5f * em);
    for (const Experiment& experiment : experiments()) {
      ImGui::PushID(experiment.name);
      ImGui::TableNextColumn();
      const bool runs = running_.busy() && current_ == &experiment;
      const bool waits = std::ranges::find(queue_, &experiment) != queue_.end();
      ImGui::BeginDisabled(runs || waits);
      if (ImGui::Button(runs ? "runs" : waits ? "waits" : "Run", {-1, 0})) {
        queue_.push_back(&experiment);
      }
      ImGui::EndDisabled();
      ImGui::TableNextColumn();
      ImGui::AlignTextToFramePadding();
      if (ImGui::Selectable(experiment.name, shown_ == &experiment)) {
        shown_ = &experiment;
        chosen_ = true;
      }
      tooltip(experiment.about);
      ImGui::TableNextColumn();
      draw_state(experiment);
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
    verdict.figure.emplace(
        verdict.file, theme == Theme::dark ? std::optional(current_palette().panel) : std::nullopt);
  } catch (const std::exception& e) {
    verdict.figure.reset();
    notices_.say(e.what(), true);
  }
}

fs::path ExperimentsPanel::draw_verdict(Verdict& verdict) {
  const Palette& colours = palette(current_theme());
  show_figure(verdict);
  if (verdict.figure) {
    const float width = std::min(ImGui::GetContentRegionAvail().x, verdict.figure->width());
    ImGui::Image(verdict.figure->id(),
                 {width, width * verdict.figure->height() / verdict.figure->width()});
  }
  ImGui::TextWrapped("%s", verdict.outcome.figure.caption.c_str());
  ImGui::Spacing();
  if (ImGui::BeginTable("checks", 4, ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerH)) {
    ImGui::TableSetupColumn("check", ImGuiTableColumnFlags_WidthStretch);
    for (const char* name : {"value", "bound", ""}) {
      ImGui::TableSetupColumn(name, ImGuiTableColumnFlags_WidthFixed, 6 * ImGui::GetFontSize());
    }
    ImGui::TableHeadersRow();
    for (const Check& check : verdict.outcome.checks) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::TextWrapped("%s", check.what.c_str());
      for (const std::string& words :
           {check.against ? check.against->conditions : "", check.unjudged}) {
        if (words.empty()) continue;
        ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(colours.muted));
        ImGui::TextWrapped("%s", words.c_str());
        ImGui::PopStyleColor();
      }
      ImGui::TableNextColumn();
      ImGui::Text("%.4g", check.value);
      ImGui::TableNextColumn();
      ImGui::Text("%s %.4g", check.least ? "\xE2\x89\xA5" : "\xE2\x89\xA4", check.bound);
      ImGui::TableNextColumn();
      ImGui::TextColored(colour_vector(check.failed() ? colours.broken : colours.muted), "%s",
                         !check.unjudged.empty() ? "measured"
                         : check.passed          ? "passed"
                                                 : "failed");
    }
    ImGui::EndTable();
  }
  fs::path chosen;
  if (verdict.trials.empty()) return chosen;
  heading("Trials, to open in playback");
  for (const fs::path& trial : verdict.trials) {
    if (ImGui::Selectable(trial.stem().c_str())) chosen = trial;
  }
  return chosen;
}

}  // namespace limpid
