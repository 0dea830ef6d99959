#include "app/film/session_film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/run/replay.h"
#include "core/coupling/laws.h"

namespace limpid {
namespace {

constexpr double kWhole = 30;          // so much of a session the plots show at once [s]
constexpr double kPart = 10;           // of a longer one
constexpr double kDrawingOfGif = 0.7;  // part of the work; the rest is colours
constexpr double kBefore = 1.0;  // what came before the first picture leaves its trail in it [s]

std::string law_text(const RowLayout& layout, std::span<const double> row) {
  const auto at = [&](Column c) { return layout.in(row, c)[0]; };
  const auto kind = static_cast<CouplingKind>(at(Column::kind));
  return fmt::format("{} coupling,  \u03b7 {:.2f},  \u03b1 {:.3g} N m s/rad", info(kind).key,
                     at(Column::eta), at(Column::alpha));
}

// A session on its stage, played from one time to the next.
class Shown {
 public:
  Shown(const Session& session, const std::string& where, const FilmCut& cut)
      : session_(session), stage_(stage(session, where, cut)), row_(index(cut.from)) {
    camera_.reset(stage_.picture.bounds());
    camera_.finish();
    const double step = cut.speed / cut.fps;
    for (double t = std::max(0.0, cut.from - kBefore); t < cut.from; t += step) view(index(t));
  }

  // Up to `time` [s], which never goes back.
  ViewState play_to(double time) {
    const std::size_t now = index(time);
    for (; row_ <= now; ++row_) {
      stage_.append(session_.row(row_));
      mark_changes();
    }
    return view(now);
  }
  std::span<const double> row() const { return session_.row(row_ - 1); }
  Stage& stage() { return stage_; }
  const Camera& camera() const { return camera_; }

 private:
  static Stage stage(const Session& session, const std::string& where, const FilmCut& cut) {
    RunPlan world = replay(session, where, {});
    const double length = cut.to - cut.from;
    const double shown = length <= kWhole ? length : kPart;
    History history({.channels = TraceChannels(session.layout).count(),
                     .seconds = shown + 1,
                     .tick = session.info.tick});
    return {std::move(world.arm), std::move(world.document), std::move(world.models),
            std::move(history), shown};
  }
  std::size_t index(double time) const {
    const auto k = static_cast<std::size_t>(time / session_.info.tick + 1e-6);
    return std::min(k, session_.size() - 1);
  }
  ViewState view(std::size_t k) {
    const RowLayout& layout = session_.layout;
    const std::span<const double> row = session_.row(k);
    ViewState view = stage_.rows().view(layout, row);
    stage_.memory.update(view, stage_.rows().contacts(layout, row),
                         layout.in(row, Column::time)[0]);
    return view;
  }
  void mark_changes() {
    for (const SettingChange& change : session_.changes) {
      if (change.row != row_) continue;
      std::string label = change.setting;
      std::erase(label, '"');
      stage_.history.mark(session_.at(row_, Column::time)[0], label);
    }
  }

  const Session& session_;
  Stage stage_;
  Camera camera_;
  std::size_t row_;  // the next one for the plots
};

}  // namespace

std::size_t FilmCut::pictures() const {
  return static_cast<std::size_t>(std::max(1LL, std::llround(duration() * fps)));
}

double FilmCut::time(std::size_t picture) const {
  return std::min(to, from + static_cast<double>(picture) * speed / fps);
}

FilmCut cut(const FilmOrder& order, const Session& session, const std::string& where) {
  if (session.size() == 0) throw FileError(where + ": holds no rows");
  const double length = static_cast<double>(session.size()) * session.info.tick;
  const double to = order.to.value_or(length);
  if (!(order.from >= 0 && order.from < to && to <= length * (1 + 1e-9))) {
    throw FileError(fmt::format("{}: from {} to {} s; allowed: from 0 to {} s, forwards", where,
                                order.from, to, length));
  }
  return {order.from, to, order.speed, order.fps.value_or(usual_fps(video_kind(order.out)))};
}

FilmEnd film(const Session& session, const std::string& where, const FilmOrder& order,
             const std::atomic<bool>& stop, const std::function<void(double)>& at) {
  const FilmCut plan = cut(order, session, where);
  VideoFile video(order.out, {order.look.width, order.look.height, plan.fps}, order.force);
  FilmFrame frame(order.look);
  Shown shown(session, where, plan);
  const double drawing = video_kind(order.out) == VideoKind::gif ? kDrawingOfGif : 1;
  for (std::size_t i = 0; i < plan.pictures(); ++i) {
    if (stop) return {true, static_cast<double>(i) / plan.fps};
    const ViewState view = shown.play_to(plan.time(i));
    const FilmCaption caption{
        .time = fmt::format("{:.2f} s", session.layout.in(shown.row(), Column::time)[0]),
        .text = law_text(session.layout, shown.row()),
        .aside = order.title};
    video.add(frame.draw(shown.stage(), view, shown.camera(), caption, 1.0 / plan.fps));
    at(drawing * static_cast<double>(i + 1) / static_cast<double>(plan.pictures()));
  }
  const bool whole = video.finish(stop, [&](double part) { at(drawing + (1 - drawing) * part); });
  return {!whole, plan.duration()};
}

}  // namespace limpid
