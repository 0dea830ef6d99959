#include "app/story/run_story.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "app/run/replay.h"
#include "devices/files/session/session_story.h"

namespace limpid {
namespace {

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

StoryRun run_story(const Story& story, const std::atomic<bool>& stop,
                   const std::function<void(double)>& at) {
  const RunPlan& plan = story.plan;
  StoryRun run;
  Session& first = run.session;
  first.info = session_info(plan);
  first.layout = RowLayout(plan.arm.dof());
  first.changes = plan.changes;
  const auto stride = static_cast<std::size_t>(first.layout.stride());
  auto twin = std::make_shared<Session>(first);
  twin->info.config = *first.info.twin;
  twin->info.twin.reset();
  twin->changes = plan.twin->changes;
  first.rows.reserve(plan.rows * stride);
  twin->rows.reserve(plan.rows * stride);
  const auto take = [&](std::span<const double> rows, const auto&) {
    first.rows.insert(first.rows.end(), rows.begin(), rows.begin() + first.layout.stride());
    twin->rows.insert(twin->rows.end(), rows.begin() + first.layout.stride(), rows.end());
    at(static_cast<double>(first.size()) * plan.parameters.tick);
    return true;
  };
  run.end = simulate_twin(plan, {.realtime = false, .stop = &stop}, take);
  first.twin = std::move(twin);
  return run;
}

std::vector<std::array<StepNumbers, 2>> measure(const std::vector<StoryStep>& steps,
                                                const Session& session) {
  std::vector<std::array<StepNumbers, 2>> all;
  for (const StoryStep& step : steps) {
    if (step.begins >= static_cast<double>(session.size()) * session.info.tick) break;
    all.push_back({numbers(step, session), numbers(step, *session.twin)});
  }
  return all;
}

void write_session(const Session& session, const ToldSteps& told, const std::filesystem::path& out,
                   bool force) {
  SessionWriter writer(out, session.info, force);
  const Session* runs[] = {&session, session.twin.get()};
  for (std::size_t lane = 0; lane < 2 && runs[lane] != nullptr; ++lane) {
    writer.append(runs[lane]->rows, lane);
    for (const SettingChange& change : runs[lane]->changes) {
      if (change.row < runs[lane]->size()) writer.append(change, lane);
    }
  }
  writer.close();
  attach_story(out, told_text(told));
}

}  // namespace limpid
