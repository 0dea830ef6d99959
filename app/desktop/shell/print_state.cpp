#include "app/desktop/shell/print_state.h"

#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/desktop/device/device_panel.h"
#include "app/desktop/device/identify_dialog.h"
#include "app/desktop/scene/picking.h"
#include "app/desktop/shell/layout.h"
#include "app/desktop/widgets/modal.h"

namespace limpid {

namespace {

nlohmann::json plots_of(const Stage& stage) {
  nlohmann::json plots = nlohmann::json::array();
  for (const Plot& plot : stage.plots) {
    nlohmann::json curves = nlohmann::json::array();
    for (const Curve& curve : plot.spec().curves) curves.push_back(curve.label);
    const ScreenRect& area = plot.area();
    plots.push_back({{"title", plot.spec().title},
                     {"kind", name(plot.spec().kind)},
                     {"curves", curves},
                     {"area", {area.min.x, area.min.y, area.max.x, area.max.y}}});
  }
  return plots;
}

// Returns the range selected in the plots, and the places of its buttons [px]; null: none.
nlohmann::json range_of(const Stage& stage) {
  const auto& range = stage.group.range();
  if (!range) return nullptr;
  nlohmann::json buttons = nlohmann::json::object();
  for (const char* label : {"Export range as CSV", "Play this", "Clear (Esc)"}) {
    if (const auto at = noted_place("range", label)) buttons[label] = {at->x, at->y};
  }
  return {{"start", range->start - stage.history.offset()},
          {"stop", range->stop - stage.history.offset()},
          {"plot", range->plot},
          {"buttons", buttons}};
}

// Returns the users' marks in the plots, with their times on the history's axis [s].
nlohmann::json notes_of(const Stage& stage) {
  nlohmann::json notes = nlohmann::json::array();
  for (const PlotMark& mark : stage.history.marks()) {
    if (mark.key == kNoteMark) notes.push_back({mark.time, mark.label});
  }
  return notes;
}

// Returns |x_E| of the twin, 0 without one [rad].
double twin_error(const Desktop& d) {
  const TraceChannels& channels = d.shown.stage().channels();
  std::vector<double> values(static_cast<std::size_t>(channels.count()));
  if (const auto rows = d.shown.rows(); rows.size() > 1) channels.values(rows[kTwinLane], values);
  return values[static_cast<std::size_t>(Channel::error)];
}

// Returns the sweep's state, null without one; `map`: left, top, right and bottom of the map on the
// screen [px].
nlohmann::json state_of(const SweepController& controller) {
  if (controller.sweep() == nullptr) return nullptr;
  const OpenedSweep& sweep = *controller.sweep();
  nlohmann::json state{
      {"file", sweep.file.string()},
      {"done", sweep.table.count()},
      {"points", sweep.table.points()},
      {"measure", sweep.table.columns[controller.choice().column].name},
      {"x", sweep.plan->axes[controller.choice().x].name},
      {"place", controller.choice().place},
      {"drawn", controller.map() != nullptr && controller.map()->choice == controller.choice()}};
  if (controller.choice().y) state["y"] = sweep.plan->axes[*controller.choice().y].name;
  if (controller.on_screen) {
    const auto& [rect, pointed_at] = *controller.on_screen;
    state["map"] = {rect.min.x, rect.min.y, rect.max.x, rect.max.y};
    if (pointed_at) state["pointed_at"] = *pointed_at;
  }
  return state;
}

nlohmann::json place(const ImVec2& at) { return {at.x, at.y}; }

// Returns the identification's state. `plugged`: the device is in the loop; `places`: the dialog's
// buttons [px].
nlohmann::json state_of(const IdentifyController& controller, bool plugged) {
  nlohmann::json places = nlohmann::json::object();
  for (const auto& [label, at] : IdentifyDialog::places()) places[label] = place(at);
  constexpr std::array kPhases{"asking", "moving", "load", "working", "found"};
  return {{"phase", kPhases[static_cast<std::size_t>(controller.phase())]},
          {"wrong", controller.wrong()},
          {"plugged", plugged},
          {"places", places}};
}

// Returns the banners, and the places of their buttons [px].
nlohmann::json banners_of(const Desktop& d) {
  nlohmann::json all = nlohmann::json::array();
  for (const Banner& banner : d.banners()) {
    nlohmann::json buttons = nlohmann::json::object();
    for (const Banner::Button& button : banner.buttons) {
      if (const auto at = noted_place(banner.id, button.label.c_str()))
        buttons[button.label] = place(*at);
    }
    all.push_back({{"text", banner.text}, {"bad", banner.bad}, {"buttons", buttons}});
  }
  return all;
}

// Returns the places that close the topmost dialog [px]; null without one.
nlohmann::json closing() {
  const auto places = dialog_places();
  if (!places) return nullptr;
  nlohmann::json all{{"cross", place(places->cross)}, {"button", nullptr}};
  if (places->button) all["button"] = place(*places->button);
  return all;
}

// Returns the state of the recording that is played, at the row shown; null without one.
nlohmann::json recorded(Desktop& d) {
  PlayedSession* session = d.playback.shown();
  if (session == nullptr) return nullptr;
  const Parameters& p = session->settings();
  nlohmann::json facts = nlohmann::json::object(), marks = nlohmann::json::array();
  for (const Mark& mark : session->marks()) {
    const auto at = noted_place("transport", fmt::format("mark {}", marks.size()).c_str());
    marks.push_back({{"time", session->time_of(mark)},
                     {"text", mark.text},
                     {"place", at ? place(*at) : nlohmann::json()}});
  }
  for (const Fact& fact : session->facts()) facts[fact.name] = fact.value;
  return {{"kind", name(p.kind)},
          {"eta", p.eta},
          {"facts", facts},
          {"marks", marks},
          {"at", session->player().time()}};
}

// Returns the device's state. `check`: place of the button that begins the check of its axes;
// `arm`: of the one that makes it the built-in arm; null while they are not there [px].
nlohmann::json state_of(const DeviceController& controller) {
  const auto check = noted_place(kSidePanel, kCheckAxes);
  const auto arm = noted_place(kSidePanel, kBuiltInArmButton);
  return {{"in_use", controller.hub().in_use()},
          {"problem", controller.problem()},
          {"waits_for_choice", controller.waits_for_choice()},
          {"check", check ? place(*check) : nlohmann::json()},
          {"arm", arm ? place(*arm) : nlohmann::json()},
          {"checking", controller.check() != nullptr},
          {"explains_force", noted_place(kSidePanel, "force").has_value()}};
}

// Returns the places of the device's tip and the scene's objects in the window [px]; null behind
// the eye.
nlohmann::json places_of(Desktop& d) {
  const auto seen = [&](const Vec3& point) -> nlohmann::json {
    const auto pixel = d.shown.camera.project(point);
    if (!pixel) return nullptr;
    return {pixel->x() + static_cast<double>(d.shown.picture.min.x),
            pixel->y() + static_cast<double>(d.shown.picture.min.y)};
  };
  const Stage& stage = d.shown.stage();
  const RowLayout& layout = stage.channels().layout();
  const std::vector<Pose> bodies = stage.rows().bodies(layout, d.shown.row());
  nlohmann::json objects = nlohmann::json::object();
  const Scene& scene = stage.document().scene;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    objects[scene.objects[i].name] = seen(placed_now(scene, i, bodies).pose.translation());
  }
  const auto target = layout.in(d.shown.row(), Column::hand_target);
  return {{"target", std::vector<double>(target.begin(), target.end())},
          {"tip", seen(stage.rows().tip(layout.in(d.shown.row(), Column::device_position)))},
          {"objects", objects}};
}

// Returns the places of the answers to a program's question [px]; null: none.
nlohmann::json question_of(const Desktop& d) {
  if (!d.question.asking()) return nullptr;
  nlohmann::json places = nlohmann::json::object();
  for (std::size_t i = 0; i < d.question.choices(); ++i) {
    const std::string& label = d.question.choice(i);
    if (const auto at = noted_place(d.question.title(), label.c_str())) {
      places[label] = place(*at);
    }
  }
  return places;
}

std::string told(Desktop& d) {
  const StoryStep* step = d.playback.on() ? d.playback.shown()->step() : nullptr;
  return step != nullptr ? step->caption : "";
}

}  // namespace

void print_state(Desktop& d, const WindowState& window) {
  const Parameters& p = d.settings.parameters();
  const LiveStage& live = d.live;
  const SceneEditor& editor = d.document.editor();
  const PlayedSession* played = d.playback.shown();
  const Focus focus = d.focus();
  nlohmann::json notices = nlohmann::json::array();
  for (const Notice& notice : d.notices.all()) notices.push_back(notice.text);
  const std::span<const double> row = d.shown.row();
  const RowLayout& layout = d.shown.stage().channels().layout();
  const LoopStatus status = live.loop().status();
  std::vector<double> values(static_cast<std::size_t>(d.shown.stage().channels().count()));
  d.shown.stage().channels().values(row, values);
  const Object* const selected = editor.selected_object();
  const auto channel = [&](Channel c) { return values[static_cast<std::size_t>(c)]; };
  fmt::print(
      "{{\"time\": {:.3f}, \"kind\": {}, \"eta\": {}, \"error\": {:.6f}, \"contact\": {:.5f}, "
      "\"energy_total\": {:.6g}, \"energy_own\": {:.6g}, \"limited\": {}, \"grip\": {:.2f}, "
      "\"force\": {}, \"recording\": {}, "
      "\"playing\": {}, \"rerun\": {}, \"rate\": {:.2f}, \"ticks\": {}, \"late\": {}, \"missed\": "
      "{}, "
      "\"slipped\": {}, \"dropped\": {}, \"objects\": {}, \"selected\": {}, \"loading\": {}, "
      "\"dirty\": {}, \"scene\": {}, \"asking\": {}, \"quality\": {}, \"alpha\": {}, \"dialog\": "
      "{}, "
      "\"typing\": {}, \"arm\": {}, \"k_vc\": {}, \"notices\": {}, \"plots\": {}, \"twin\": {}, "
      "\"lanes\": {}, "
      "\"twin_error\": {:.6f}, \"size\": [{}, {}], \"overlaid\": {}, \"told\": {}, "
      "\"filming\": {}, \"pads\": {}, \"frames\": {}, \"input_waits\": {}, "
      "\"loading_part\": {:.3f}, \"sweep\": {}, \"identify\": {}, \"device\": {}, \"banners\": {}, "
      "\"closing\": {}, "
      "\"recorded\": {}, \"places\": {}, \"blind\": {}, \"led\": {}, \"question\": {}, "
      "\"your_turn\": {}, \"tried\": {}, \"range\": {}, \"notes\": {}, \"shown\": [{:.4f}, "
      "{:.4f}], "
      "\"hand\": {{\"stiffness\": {}, \"damping\": {}}}, "
      "\"taken\": {{\"keys\": {}, \"buttons\": {}}}, \"popup\": {}}}\n",
      layout.in(row, Column::time)[0], channel(Channel::kind), p.eta, channel(Channel::error),
      channel(Channel::contact), channel(Channel::energy_total),
      d.shown.stage().energy[kMainLane].own(), channel(Channel::limited) > 0,
      layout.in(row, Column::hand_grip)[0], live.force_armed(), live.loop().recording(),
      played != nullptr, played != nullptr && played->has_rerun(), status.rate, status.ticks,
      status.late, status.missed, status.slipped, live.loop().trace_dropped(),
      editor.scene().objects.size(), selected ? nlohmann::json(selected->name).dump() : "null",
      d.document.loader().busy(), editor.dirty(), nlohmann::json(d.document.file()).dump(),
      focus.question || focus.modal, d.shown.quality_level(), p.alpha,
      nlohmann::json(focus.question ? "question" : focus.dialog).dump(), focus.text,
      nlohmann::json(live.stage().arm().name).dump(), p.k_vc, notices.dump(),
      plots_of(d.shown.stage()).dump(), d.shown.rows().size() > 1, d.shown.rows().size(),
      twin_error(d), window.width, window.height, d.settings.overlaid,
      nlohmann::json(told(d)).dump(), d.playback.video().busy(), d.pads.all().size(), window.frames,
      window.input_waits, d.playback.loading() ? d.playback.loading_part() : 1,
      state_of(d.sweep).dump(), state_of(d.identify, live.loop().device_plugged()).dump(),
      state_of(d.devices).dump(), banners_of(d).dump(), closing().dump(), recorded(d).dump(),
      places_of(d).dump(), d.blind, d.lead.on(), question_of(d).dump(), d.settings.your_turn,
      nlohmann::json(d.settings.tried).dump(), range_of(d.shown.stage()).dump(),
      notes_of(d.shown.stage()).dump(), d.shown.stage().group.start(), d.shown.stage().group.stop(),
      p.hand_stiffness, p.hand_damping, window.taken.keys, window.taken.buttons, focus.popup);
  std::fflush(stdout);
}

}  // namespace limpid
