#include "app/story/run_story.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>

#include "app/run/replay.h"
#include "app/run/run_watch.h"
#include "app/story/story.h"
#include "devices/files/session/session_stream.h"
#include "devices/files/toml_reader.h"

namespace limpid {

namespace {

constexpr Range kTime{0, 1e9, false, "s"};

// Writes a camera's box as a script has it, with edges of one length.
toml::table box_table(const StoryCamera& camera) {
  const Vec3 at = camera.of->center();
  return toml::table{{"view", view_word(camera.view)},
                     {"target", toml::array{at.x(), at.y(), at.z()}},
                     {"size", camera.of->sizes().x()}};
}

toml::table table_of(const StoryStep& step) {
  toml::table table{{"begins", step.begins}, {"ends", step.ends},     {"caption", step.caption},
                    {"mark", step.mark},     {"beside", step.beside}, {"anew", step.anew}};
  toml::array names;
  for (const std::string& name : step.names) names.push_back(name);
  table.insert("names", names);
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

double square(std::span<const double> v) {
  double sum = 0;
  for (const double x : v) sum += x * x;
  return sum;
}

StepNumbers numbers(const StoryStep& step, const Session& run) {
  StepNumbers n;
  const auto row_at = [&](double time) {
    const auto row = static_cast<std::size_t>(std::llround(time / run.info.tick));
    return std::min(row, run.size());
  };
  const std::size_t from = row_at(step.begins), to = row_at(step.ends);
  double human = 0;
  for (std::size_t k = from; k < to; ++k) {
    const auto x1 = run.at(k, Column::device_position), x2 = run.at(k, Column::proxy_position);
    double error = 0;
    for (std::size_t i = 0; i < x1.size(); ++i) error += (x1[i] - x2[i]) * (x1[i] - x2[i]);
    n.largest_error = std::max(n.largest_error, std::sqrt(error));
    n.largest_contact =
        std::max(n.largest_contact, std::sqrt(square(run.at(k, Column::contact_torque))));
    human += square(run.layout.human_torque(run.row(k)));
    const double risen = run.at(k, Column::energy_total)[0] - run.at(from, Column::energy_total)[0];
    n.energy_given = std::max(n.energy_given, risen);
  }
  if (to > from) n.rms_human = std::sqrt(human / static_cast<double>(to - from));
  return n;
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

ToldSteps told_in(const Session& session, const std::filesystem::path& file) {
  return read_told(session.info.story, file.string() + ": story");
}

StoryRun run_story(const Story& story, const std::atomic<bool>& stop,
                   const std::function<void(double)>& at) {
  const RunPlan& plan = story.plan;
  StoryRun run;
  Session& first = run.session;
  first.info = session_info(plan);
  first.layout = plan.layout();
  first.changes = plan.changes;
  const auto stride = static_cast<std::size_t>(first.layout.stride());
  for (const std::string& config : std::exchange(first.info.beside, {})) add_lane(first, config);
  for (std::size_t i = 0; i < first.lanes(); ++i) {
    first.lane(i).changes = plan.lane(i).changes;
    first.lane(i).rows.reserve(plan.rows * stride);
  }
  const auto take = [&](std::span<const double> rows, const auto&) {
    for (std::size_t i = 0; i < first.lanes(); ++i) {
      const auto row = rows.subspan(i * stride, stride);
      first.lane(i).rows.insert(first.lane(i).rows.end(), row.begin(), row.end());
    }
    at(static_cast<double>(first.size()) * plan.parameters.tick);
    return true;
  };
  run.end = simulate(plan, {.realtime = false, .stop = &stop}, take);
  return run;
}

std::vector<std::vector<StepNumbers>> measure(const std::vector<StoryStep>& steps,
                                              const Session& session) {
  std::vector<std::vector<StepNumbers>> all;
  for (const StoryStep& step : steps) {
    if (step.begins >= static_cast<double>(session.size()) * session.info.tick) break;
    std::vector<StepNumbers>& of_step = all.emplace_back();
    for (std::size_t i = 0; i < session.lanes(); ++i) {
      of_step.push_back(numbers(step, session.lane(i)));
    }
  }
  return all;
}

void write_session(const Session& session, const ToldSteps& told, const std::filesystem::path& out,
                   bool force) {
  SessionInfo info = session.info;
  info.story = told_text(told);
  SessionWriter writer(out, info, force);
  for (std::size_t i = 0; i < session.lanes(); ++i) {
    const Session& lane = session.lane(i);
    writer.append_world(lane.world, i);
    writer.append(lane.rows, i);
    for (const SettingChange& change : lane.changes) {
      if (change.row < lane.size()) writer.append(change, i);
    }
  }
  writer.close(warnings_text(warnings_of(session, out.string())));
}

}  // namespace limpid
