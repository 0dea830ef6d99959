#include "app/film/session_film.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/plot/plot_frame.h"
#include "app/plot/plot_row.h"
#include "app/run/provenance.h"
#include "app/run/replay.h"
#include "app/stage/picture_signs.h"
#include "app/style/picture_legend.h"
#include "core/coupling/laws.h"
#include "core/tick/arming.h"

namespace limpid {

namespace {

constexpr double kLeastScale = 0.75;  // below, text cannot be read
constexpr float kPlotsShare = 0.33f;  // of the height
constexpr float kPlotsHeight = 190;   // at least [px at scale 1]
constexpr float kPlotWidth = 300;

float scale_of(const FilmLook& look) {
  const double fitting = std::min(look.width / 1280.0, look.height / 720.0);
  return static_cast<float>(look.text_scale > 0 ? look.text_scale : std::max(kLeastScale, fitting));
}

constexpr double kWhole = 30;          // longest stretch that the plots show whole [s]
constexpr double kPart = 10;           // part of a longer stretch, shown at once [s]
constexpr double kDrawingOfGif = 0.7;  // part of the work; the rest is colours
constexpr double kCameraSlower = 3;    // than in the window, where somebody waits
constexpr double kBefore = 1.0;        // time before the first picture whose trail is in it [s]

std::string law_text(const RowLayout& layout, std::span<const double> row) {
  const auto at = [&](Column c) { return layout.in(row, c)[0]; };
  const auto kind = static_cast<CouplingKind>(at(Column::kind));
  return fmt::format("{} coupling,  \u03b7 {:.2f},  \u03b1 {:.3g} N m s/rad", info(kind).key,
                     at(Column::eta), at(Column::alpha));
}

// Returns the stretch that the plots show at once [s]; for a story all between one beginning and
// the next.
double longest_stretch(const std::vector<StoryStep>& steps, const FilmCut& cut) {
  double longest = 0, began = cut.from;
  for (const StoryStep& step : steps) {
    if (!step.anew || step.begins <= cut.from || step.begins >= cut.to) continue;
    longest = std::max(longest, step.begins - began);
    began = step.begins;
  }
  longest = std::max(longest, cut.to - began);
  return longest <= kWhole ? longest : kPart;
}

// A session on its stage, played from one time to the next.
class Shown {
 public:
  struct Moment {
    ViewState view;
    std::vector<ViewState> beside;  // of further runs
  };

  Shown(const Session& session, const std::string& where, const FilmOrder& order,
        const FilmCut& cut, const FilmFrame& frame, const RerunRows& again)
      : session_(session),
        order_(order),
        frame_(frame),
        again_(again),
        stage_(stage(session, where, cut, order.steps, lanes_shown())),
        row_(index(cut.from)),
        seconds_(1.0 / cut.fps) {
    if (!again.rows.empty()) name_rerun();
    for (std::size_t i = 0; i < session.lanes(); ++i) {
      runs_.emplace_back(session.lane(i), session_parameters(session.lane(i), where));
    }
    apply_changes(row_);
    enter_step(row_);
    camera_.finish();
    const double step = cut.speed / cut.fps;
    for (double t = std::max(0.0, cut.from - kBefore); t < cut.from; t += step) see(index(t));
  }

  // Plays up to `time` [s], which never goes back.
  Moment play_to(double time) {
    camera_.advance(seconds_ / kCameraSlower);
    const std::size_t now = index(time);
    for (; row_ <= now; ++row_) {
      apply_changes(row_);
      enter_step(row_);
      std::vector<Row> rows;
      for (std::size_t i = 0; i < runs_shown(); ++i) rows.push_back(session_.lane(i).row(row_));
      if (!again_.rows.empty()) rows.push_back(row_again(row_));
      stage_.append(rows);
      for (const Mark& mark : session_.marks) {
        if (mark.tick == row_) stage_.history.mark(time_at(row_), mark.text, kNoteMark);
      }
    }
    return see(now);
  }
  FilmCaption caption() const {
    const std::span<const double> row = session_.row(row_ - 1);
    FilmCaption caption{.time = fmt::format("{:.2f} s", session_.layout.in(row, Column::time)[0]),
                        .text = law_text(session_.layout, row),
                        .aside = order_.title};
    if (runs_shown() > 1) {
      caption.text = fmt::format("{}", fmt::join(stage_.names().names, "  |  "));
    }
    if (!again_.rows.empty()) caption.text += "  |  " + again_.name;
    if (step_ != nullptr) caption.told = step_->caption;
    const double force = session_.layout.in(row, Column::force_state)[0];
    caption.sign = force_text(static_cast<ForceState>(force));
    return caption;
  }
  Stage& stage() { return stage_; }
  const Camera& camera() const { return camera_; }

 private:
  using Row = std::span<const double>;
  struct Run {
    Run(const Session& s, const Parameters& p) : session(s), parameters(p) {}
    const Session& session;
    Parameters parameters;
    std::size_t next = 0;  // change
  };

  static Stage stage(const Session& session, const std::string& where, const FilmCut& cut,
                     const std::vector<StoryStep>& steps, std::size_t curves) {
    RunPlan world = replay(session, where, {});
    const double shown = longest_stretch(steps, cut);
    const int lanes = static_cast<int>(curves);
    History history({.channels = TraceChannels(session.layout).count() * lanes,
                     .seconds = shown + 1,
                     .tick = session.info.tick});
    return {std::move(world.arm), std::move(world.document), world.models, std::move(history),
            shown};
  }
  std::size_t index(double time) const {
    const auto k = static_cast<std::size_t>(time / session_.info.tick + 1e-6);
    return std::min(k, session_.size() - 1);
  }
  std::size_t runs_shown() const {
    if (!again_.rows.empty()) return 1;
    return step_ == nullptr || step_->beside ? session_.lanes() : 1;
  }
  // Returns how many runs have curves.
  std::size_t lanes_shown() const { return again_.rows.empty() ? session_.lanes() : 2; }
  Row row_again(std::size_t k) const {
    const auto stride = static_cast<std::size_t>(session_.layout.stride());
    return std::span<const double>(again_.rows).subspan(k * stride, stride);
  }
  void name_rerun() {
    const auto law = static_cast<int>(session_.layout.in(row_again(0), Column::kind)[0]);
    stage_.name_runs({{again_.recorded, again_.name}, false, {laws_at(session_, 0).front(), law}});
  }

  Moment see(std::size_t k) {
    Moment moment{.view = view(session_.row(k), stage_.memory[kMainLane]), .beside = {}};
    if (!again_.rows.empty()) {
      const Row again = row_again(k);
      moment.view.rerun = stage_.rows().pose(session_.layout.in(again, Column::proxy_position));
      moment.view.rerun_bodies = stage_.rows().bodies(session_.layout, again);
      return moment;
    }
    for (std::size_t i = 1; i < session_.lanes(); ++i) {
      ViewState beside = view(session_.lane(i).row(k), stage_.memory[i]);
      if (i < runs_shown()) moment.beside.push_back(std::move(beside));
    }
    return moment;
  }
  ViewState view(Row row, ViewMemory& memory) const {
    const RowLayout& layout = session_.layout;
    ViewState view = stage_.rows().view(layout, row);
    memory.update(view, stage_.rows().contacts(layout, row), layout.in(row, Column::time)[0]);
    return view;
  }

  // Applies the changes up to row k; a story marks its steps instead.
  void apply_changes(std::size_t k) {
    for (Run& run : runs_) {
      const std::vector<SettingChange>& changes = run.session.changes;
      for (; run.next < changes.size() && changes[run.next].row <= k; ++run.next) {
        const SettingChange& change = changes[run.next];
        apply_change(run.parameters, change);
        if (&run != &runs_.front() || change.row < k || !order_.steps.empty()) continue;
        std::string label = change.setting;
        std::erase(label, '"');
        stage_.history.mark(time_at(k), label, std::string(change.key()));
      }
    }
    for (std::size_t i = 0; i < runs_shown(); ++i) stage_.follow(runs_[i].parameters, i);
    const std::vector<SettingsFrom>& again = again_.settings;
    for (; next_again_ < again.size() && again[next_again_].row <= k; ++next_again_) {
      stage_.follow(again[next_again_].parameters, runs_shown());
    }
    if (!order_.steps.empty() || !again_.rows.empty()) return;
    std::vector<Parameters> now;
    for (const Run& run : runs_) now.push_back(run.parameters);
    stage_.name_runs(run_names(now));
  }
  // Names all runs in the plots, with their laws at `time` [s].
  void name_runs(std::vector<std::string> names, double time) {
    names.resize(std::min(names.size(), session_.lanes()));
    stage_.name_runs({std::move(names), true, laws_at(session_, time)});
  }
  double time_at(std::size_t k) const { return session_.at(k, Column::time)[0]; }

  void enter_step(std::size_t k) {
    const StoryStep* step = order_.steps.empty() ? nullptr : &step_at(order_.steps, time_at(k));
    if (step == step_ && aimed_) return;
    step_ = step;
    aimed_ = true;
    const StoryCamera aim = step == nullptr ? StoryCamera{} : camera_in(order_.steps, *step);
    const ImVec2 viewport = frame_.viewport(runs_shown());
    camera_.resize(viewport.x, viewport.y);
    camera_.look(aim.view);
    camera_.frame(aim.of.value_or(stage_.picture.bounds()));
    if (step == nullptr) return;
    if (step->anew) stage_.history.clear();
    if (step->beside) name_runs(step->names, step->begins);
    const bool begins =
        time_at(k) < step->begins + session_.info.tick;  // the video does not begin in it
    if (begins && !step->mark.empty()) stage_.history.mark(time_at(k), step->mark);
  }

  const Session& session_;
  const FilmOrder& order_;
  const FilmFrame& frame_;
  const RerunRows& again_;  // without rows: no re-run
  Stage stage_;
  Camera camera_;
  std::size_t row_;  // next row for the plots
  double seconds_;   // of a picture
  std::vector<Run> runs_;
  std::size_t next_again_ = 0;  // settings of the re-run
  const StoryStep* step_ = nullptr;
  bool aimed_ = false;
};

}  // namespace

FilmFrame::FilmFrame(const FilmLook& look)
    : look_(look), scale_(scale_of(look)), context_(look.width, look.height) {
  ImGuiGl::set_up(look.theme, scale_);
  ImGui::GetIO().DisplaySize = {static_cast<float>(look.width), static_cast<float>(look.height)};
}

FilmFrame::Places FilmFrame::lay_out() const {
  const auto width = static_cast<float>(look_.width), height = static_cast<float>(look_.height);
  const float caption = std::round(1.7f * text_size(Face::regular, "0").y);
  const float wanted = std::round(std::max(kPlotsShare * height, kPlotsHeight * scale_));
  const float plots = look_.plots && 2 * wanted <= height ? wanted : 0;
  return {.caption = {{0, 0}, {width, caption}},
          .picture = {{0, caption}, {width, height - plots}},
          .plots = {{0, height - plots}, {width, height}}};
}

ImVec2 FilmFrame::viewport(std::size_t runs) const {
  return part_of(lay_out().picture, 0, look_.overlaid ? 1 : runs).size();
}

std::vector<unsigned char> FilmFrame::draw(Stage& stage, ViewState view, const Camera& camera,
                                           const FilmCaption& caption, double elapsed,
                                           std::vector<ViewState> beside) {
  ImGui::GetIO().DeltaTime = static_cast<float>(elapsed);
  ImGuiGl::begin_frame();
  ImGui::NewFrame();
  const Places at = lay_out();
  view.theme = look_.theme;
  for (ViewState& other : beside) other.theme = look_.theme;
  const bool overlaid = !beside.empty() && look_.overlaid;
  if (overlaid) {
    for (const ViewState& other : std::exchange(beside, {})) lay_over(view, other);
  }
  stage.draw_at(0);  // at the best quality: there is time
  stage.picture.set_pixel_scale(scale_);
  draw_picture(at.picture, stage, view, camera, beside);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  draw_legend(at.picture, {.beside = view.rerun ? "proxy of the re-run (ghost)" : nullptr,
                           .runs = overlaid ? stage.names().names : std::vector<std::string>(),
                           .compact = !beside.empty()});
  draw_caption(at.caption, caption);
  draw_told(caption.told, at.picture, list);
  draw_sign(caption.sign, at.picture, !beside.empty(), list);
  if (at.plots.height() > 0) draw_plots(at.plots, stage);
  ImGuiGl::render();
  return read_rgba(look_.width, look_.height);
}

void FilmFrame::draw_picture(const ScreenRect& rect, Stage& stage, const ViewState& view,
                             const Camera& camera, std::span<const ViewState> beside) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const auto paint = [&](const ViewState& state, const ScreenRect& part, std::size_t run) {
    stage.picture.draw(state, camera, static_cast<int>(part.min.x),
                       look_.height - static_cast<int>(part.max.y), static_cast<int>(part.width()),
                       static_cast<int>(part.height()), SceneView::sheet_of(run));
  };
  if (beside.empty()) {
    paint(view, rect, kMainLane);
    Camera shown = camera;
    shown.resize(rect.width(), rect.height());
    list.PushClipRect(rect.min, rect.max);
    if (look_.lens) {
      Crowd crowd;
      keep_acted_on_free(view, shown, rect, crowd);
      magnifier_.draw(stage.picture, view, shown, {rect, 1, look_.height, 0}, crowd);
      magnifier_.draw_frame(view, shown, list);
    }
    if (!view.beside.empty()) draw_gap(view, shown, {rect}, list, stage.names());
    return list.PopClipRect();
  }
  for (std::size_t run = 0; run <= beside.size(); ++run) {
    const ViewState& state = run == kMainLane ? view : beside[run - 1];
    const ScreenRect part = part_of(rect, run, 1 + beside.size());
    paint(state, part, run);
    Camera shown = camera;
    shown.resize(part.width(), part.height());
    list.PushClipRect(part.min, part.max);
    draw_gap(state, shown, {part}, list);
    draw_run_name(stage.names(), run, part, list);
    list.PopClipRect();
  }
}

void FilmFrame::draw_legend(const ScreenRect& rect, const PictureLegend& legend) const {
  const float em = font(Face::small)->FontSize;
  if (rect.height() < 10 * em) return;
  const float below_names = legend.compact ? run_name_room() : 0;
  draw_picture_legend(*ImGui::GetBackgroundDrawList(), {rect.min.x, rect.min.y + below_names},
                      rect.max, legend);
}

void FilmFrame::draw_caption(const ScreenRect& rect, const FilmCaption& caption) const {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const Palette& colours = current_palette();
  list.AddRectFilled(rect.min, rect.max, colour(colours.panel));
  const float gap = std::round(12 * scale_);
  const float top = rect.min.y + 0.5f * (rect.height() - text_size(Face::regular, "0").y);
  float left = rect.min.x + gap, right = rect.max.x - gap;
  const auto put = [&](Face face, Rgb rgb, const std::string& text) {
    left += draw_clipped_text(list, face, {left, top}, rgb, text, right - left) + 2 * gap;
  };
  put(Face::semibold, colours.text, caption.time);
  put(Face::regular, colours.text, caption.text);
  const float aside = text_size(Face::regular, caption.aside).x;
  if (right - aside < left) return;
  draw_text(list, Face::regular, {right - aside, top}, colours.muted, caption.aside);
}

void FilmFrame::draw_plots(const ScreenRect& rect, Stage& stage) const {
  ImGui::SetNextWindowPos(rect.min);
  ImGui::SetNextWindowSize(rect.size());
  ImGui::Begin("plots", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs);
  stage.group.begin_frame(stage.history, stage.history.end_time());
  const auto fitting =
      static_cast<std::size_t>(std::max(1.0f, rect.width() / (kPlotWidth * scale_)));
  std::vector<PlotKind> kinds;
  for (const Plot& plot : stage.plots) kinds.push_back(plot.spec().kind);
  kinds.resize(std::min(kinds.size(), fitting));
  const ImVec2 origin = ImGui::GetCursorPos(), room = ImGui::GetContentRegionAvail();
  const PlotPlaces at = place_plots(kinds, room, ImGui::GetStyle().ItemSpacing.x, scale_);
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const ScreenRect& place = at.places[i];
    ImGui::SetCursorPos({origin.x + place.min.x, origin.y + place.min.y});
    // Hidden curves go: nobody can click on the legend to have them back.
    std::erase_if(stage.plots[i].spec().curves, [](const Curve& c) { return !c.visible; });
    stage.plots[i].draw(stage.history, stage.group, place.size());
  }
  ImGui::End();
}

std::size_t FilmCut::pictures() const {
  return static_cast<std::size_t>(std::max(1LL, std::llround(duration() * fps)));
}

double FilmCut::time(std::size_t picture) const {
  return std::min(to, from + static_cast<double>(picture) * speed / fps);
}

FilmCut cut(const FilmOrder& order, const Session& session, const std::string& where) {
  if (session.size() == 0) throw FileError(where + ": contains no rows");
  const double length = static_cast<double>(session.size()) * session.info.tick;
  const double to = order.to.value_or(length);
  if (!(order.from >= 0 && order.from < to && to <= length * (1 + 1e-9))) {
    throw FileError(
        fmt::format("{}: from {} to {} s; allowed: from 0 to {:.9g} s, the end after the beginning",
                    where, order.from, to, length));
  }
  return {order.from, to, order.speed, order.fps.value_or(usual_fps(video_kind(order.out)))};
}

FilmEnd film(const Session& session, const std::string& where, const FilmOrder& order,
             const std::atomic<bool>& stop, const std::function<void(double)>& at) {
  const FilmCut plan = cut(order, session, where);
  VideoFile video(order.out,
                  {order.look.width, order.look.height, plan.fps, provenance_of(session.info)},
                  order.force);
  RerunRows again;
  if (!order.rerun.empty()) {
    again = run_once_more(session, where, with_changes(session, where, order.rerun), stop,
                          [](double) {});
    if (again.rows.empty()) return {true, 0};
  }
  FilmFrame frame(order.look);
  Shown shown(session, where, order, plan, frame, again);
  const double drawing = video_kind(order.out) == VideoKind::gif ? kDrawingOfGif : 1;
  for (std::size_t i = 0; i < plan.pictures(); ++i) {
    if (stop) return {true, static_cast<double>(i) / plan.fps};
    const Shown::Moment now = shown.play_to(plan.time(i));
    video.add(frame.draw(shown.stage(), now.view, shown.camera(), shown.caption(), 1.0 / plan.fps,
                         now.beside));
    at(drawing * static_cast<double>(i + 1) / static_cast<double>(plan.pictures()));
  }
  const bool whole = video.finish(stop, [&](double part) { at(drawing + (1 - drawing) * part); });
  return {!whole, plan.duration()};
}

}  // namespace limpid
