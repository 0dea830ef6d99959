#include "app/story/told_steps.h"

#include <sstream>

#include "app/story/camera_words.h"
#include "devices/files/session/session_story.h"
#include "devices/files/toml_reader.h"

namespace limpid {
namespace {

constexpr Range kTime{0, 1e9, false, "s"};

// A box has edges of one length, as read from a script.
toml::table box_table(const StoryCamera& camera) {
  const Vec3 at = camera.of->center();
  return toml::table{{"view", view_word(camera.view)},
                     {"target", toml::array{at.x(), at.y(), at.z()}},
                     {"size", camera.of->sizes().x()}};
}

toml::table table_of(const StoryStep& step) {
  toml::table table{{"begins", step.begins}, {"ends", step.ends},     {"caption", step.caption},
                    {"mark", step.mark},     {"beside", step.beside}, {"anew", step.anew}};
  table.insert("names", toml::array{step.names[0], step.names[1]});
  if (step.camera && step.camera->of) {
    table.insert("camera", box_table(*step.camera));
  } else if (step.camera) {
    table.insert("camera", view_word(step.camera->view));
  }
  return table;
}

StoryStep step_in(const TomlTable& table, const std::string& where, double begins) {
  StoryStep step;
  step.begins = table.need(table.number("begins", kTime), "begins");
  step.ends = table.need(table.number("ends", kTime), "ends");
  if (step.begins < begins || step.ends <= step.begins) {
    table.refuse("begins", "steps one after the other");
  }
  step.caption = table.need(table.text("caption"), "caption");
  step.mark = table.text("mark").value_or("");
  step.beside = flag_in(table, "beside", true);
  step.anew = flag_in(table, "anew", false);
  step.names = table.need(names_said(table), "names");
  step.camera = camera_said(table, where);
  return step;
}

}  // namespace

std::string told_text(const ToldSteps& told) {
  toml::array steps;
  for (const StoryStep& step : told.steps) steps.push_back(table_of(step));
  std::ostringstream text;
  text << toml::table{{"title", told.title}, {"step", steps}} << '\n';
  return text.str();
}

ToldSteps read_told(const std::string& text, const std::string& where) {
  const toml::table whole = parse_toml(text, where);
  const TomlTable table(whole, where, "");
  ToldSteps told{table.text("title").value_or(""), {}};
  double begins = 0;
  for (const TomlTable& step : table.tables("step")) {
    begins = told.steps.emplace_back(step_in(step, where, begins)).ends;
  }
  return told;
}

ToldSteps told_in(const std::filesystem::path& session) {
  return read_told(attached_story(session), session.string() + ": story");
}

}  // namespace limpid
