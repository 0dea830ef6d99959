#include "app/desktop/shell/state.h"

#include <fmt/format.h>

#include <cstdio>

#include "app/desktop/device/device_panel.h"
#include "app/desktop/device/identify_dialog.h"
#include "app/desktop/scene/picking.h"
#include "app/desktop/shell/layout.h"
#include "app/desktop/widgets/modal.h"
#include "app/remote/remote.h"

namespace limpid {

using nlohmann::json;

namespace {

json plots_of(const Stage& stage) {
  json plots = json::array();
  for (const Plot& plot : stage.plots) {
    json curves = json::array();
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
json range_of(const Stage& stage) {
  const auto& range = stage.group.range();
  if (!range) return nullptr;
  json buttons = json::object();
  for (const char* label : {"Export range as CSV", "Play this", "Clear (Esc)"}) {
    if (const auto at = noted_place("range", label)) buttons[label] = {at->x, at->y};
  }
  return {{"start", range->start - stage.history.offset()},
          {"stop", range->stop - stage.history.offset()},
          {"plot", range->plot},
          {"buttons", buttons}};
}

// Returns the users' marks in the plots, with their times on the history's axis [s].
json notes_of(const Stage& stage) {
  json notes = json::array();
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
json state_of(const SweepController& controller) {
  if (controller.sweep() == nullptr) return nullptr;
  const OpenedSweep& sweep = *controller.sweep();
  json state{
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

// Returns the state of the work on a sweep; null without any.
json sweeping(const SweepRunner& runner) {
  if (!runner.busy()) return nullptr;
  return {
      {"folder", runner.folder().string()}, {"done", runner.done()}, {"points", runner.points()}};
}

json place(const ImVec2& at) { return {at.x, at.y}; }

// Returns the places of what may be clicked, by windows of ImGui and labels [px].
json noted() {
  json all = json::object();
  for (const NotedPlace& note : noted_places()) all[note.window][note.label] = place(note.at);
  return all;
}

// Returns the identification's state. `plugged`: the device is in the loop; `places`: the dialog's
// buttons [px].
json state_of(const IdentifyController& controller, bool plugged) {
  json places = json::object();
  for (const auto& [label, at] : IdentifyDialog::places()) places[label] = place(at);
  constexpr std::array kPhases{"asking", "moving", "load", "working", "found"};
  return {{"phase", kPhases[static_cast<std::size_t>(controller.phase())]},
          {"wrong", controller.wrong()},
          {"plugged", plugged},
          {"places", places}};
}

// Returns the banners, and the places of their buttons [px].
json banners_of(const Desktop& d) {
  json all = json::array();
  for (const Banner& banner : d.banners()) {
    json buttons = json::object();
    for (const Banner::Button& button : banner.buttons) {
      if (const auto at = noted_place(banner.id, button.label.c_str()))
        buttons[button.label] = place(*at);
    }
    all.push_back({{"text", banner.text}, {"bad", banner.bad}, {"buttons", buttons}});
  }
  return all;
}

// Returns the places that close the topmost dialog [px]; null without one.
json closing() {
  const auto places = dialog_places();
  if (!places) return nullptr;
  json all{{"cross", place(places->cross)}, {"button", nullptr}};
  if (places->button) all["button"] = place(*places->button);
  return all;
}

// Returns the state of the recording that is played, at the row shown; null without one.
json recorded(Desktop& d) {
  PlayedSession* session = d.playback.shown();
  if (session == nullptr) return nullptr;
  const Parameters& p = session->settings();
  json facts = json::object(), marks = json::array();
  for (const Mark& mark : session->marks()) {
    const auto at = noted_place("transport", fmt::format("mark {}", marks.size()).c_str());
    marks.push_back({{"time", session->time_of(mark)},
                     {"text", mark.text},
                     {"place", at ? place(*at) : json()}});
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
json state_of(const DeviceController& controller) {
  const auto check = noted_place(kSidePanel, kCheckAxes);
  const auto arm = noted_place(kSidePanel, kBuiltInArmButton);
  return {{"in_use", controller.hub().in_use()},
          {"problem", controller.problem()},
          {"waits_for_choice", controller.waits_for_choice()},
          {"check", check ? place(*check) : json()},
          {"arm", arm ? place(*arm) : json()},
          {"checking", controller.check() != nullptr},
          {"explains_force", noted_place(kSidePanel, "force").has_value()}};
}

// Returns the places of the device's tip and the scene's objects in the window [px]; null behind
// the eye.
json places_of(Desktop& d) {
  const auto seen = [&](const Vec3& point) -> json {
    const auto pixel = d.shown.camera.project(point);
    if (!pixel) return nullptr;
    return {pixel->x() + static_cast<double>(d.shown.picture.min.x),
            pixel->y() + static_cast<double>(d.shown.picture.min.y)};
  };
  const Stage& stage = d.shown.stage();
  const RowLayout& layout = stage.channels().layout();
  const std::vector<Pose> bodies = stage.rows().bodies(layout, d.shown.row());
  json objects = json::object();
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
json question_of(const Desktop& d) {
  if (!d.question.asking()) return nullptr;
  json places = json::object();
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

// Returns numbers of the row that is shown, by the names of plots' channels.
json row_of(const Desktop& d) {
  const Stage& stage = d.shown.stage();
  const TraceChannels& channels = stage.channels();
  std::vector<double> values(static_cast<std::size_t>(channels.count()));
  channels.values(d.shown.row(), values);
  const auto channel = [&](Channel c) { return values[static_cast<std::size_t>(c)]; };
  const auto column = [&](Column c) { return channels.layout().in(d.shown.row(), c)[0]; };
  return {{"time", column(Column::time)},
          {"grip", column(Column::hand_grip)},
          {"kind", channel(Channel::kind)},
          {"error", channel(Channel::error)},
          {"contact", channel(Channel::contact)},
          {"energy_total", channel(Channel::energy_total)},
          {"energy_own", stage.energy[kMainLane].own()},
          {"limited", channel(Channel::limited) > 0},
          {"shown_lanes", d.shown.rows().size()},
          {"twin_error", twin_error(d)}};
}

// Returns what the user has set.
json settings_of(Desktop& d) {
  const Settings& settings = d.settings;
  const Parameters& edited = d.tuning.edited();
  const Parameters& p = settings.parameters();
  return {{"eta", p.eta},
          {"alpha", p.alpha},
          {"k_vc", p.k_vc},
          {"hand_settings", {{"stiffness", p.hand_stiffness}, {"damping", p.hand_damping}}},
          {"edited", {{"kind", name(edited.kind)}, {"eta", edited.eta}}},
          {"overlaid", settings.overlaid},
          {"theme", static_cast<int>(settings.theme)},
          {"text_size", settings.text_size},
          {"your_turn", settings.your_turn},
          {"tried", settings.tried}};
}

// Returns what waits for the user, or is under way.
json busy_with(Desktop& d) {
  const SceneEditor& editor = d.document.editor();
  const Object* const selected = editor.selected_object();
  const PlayedSession* played = d.playback.shown();
  const Focus focus = d.focus();
  json notices = json::array();
  for (const Notice& notice : d.notices.all()) notices.push_back(notice.text);
  return {{"rerun", played != nullptr && played->has_rerun()},
          {"dropped", d.live.loop().trace_dropped()},
          {"selected", selected ? json(selected->name) : json()},
          {"loading", d.document.loader().busy()},
          {"loading_part", d.playback.loading() ? d.playback.loading_part() : 1},
          {"dirty", editor.dirty()},
          {"asking", focus.question || focus.modal},
          {"dialog", focus.question ? "question" : focus.dialog},
          {"typing", focus.text},
          {"popup", focus.popup},
          {"panel", static_cast<int>(d.led_panel)},
          {"notices", notices},
          {"told", told(d)},
          {"filming", d.playback.video().busy()},
          {"pads", d.pads.all().size()},
          {"led", d.lead.on()},
          {"quality", d.shown.quality_level()}};
}

// Returns the parts of the window.
json parts_of(Desktop& d) {
  const Stage& stage = d.shown.stage();
  return {{"plots", plots_of(stage)},
          {"range", range_of(stage)},
          {"notes", notes_of(stage)},
          {"shown", {stage.group.start(), stage.group.stop()}},
          {"sweep", state_of(d.sweep)},
          {"sweeping", sweeping(d.sweep.runner())},
          {"identify", state_of(d.identify, d.live.loop().device_plugged())},
          {"device_panel", state_of(d.devices)},
          {"banners", banners_of(d)},
          {"closing", closing()},
          {"recorded", recorded(d)},
          {"places", places_of(d)},
          {"noted", noted()},
          {"question", question_of(d)}};
}

}  // namespace

json state_of(const Desktop& d) {
  const Stage& stage = d.live.stage();
  const std::string& trouble = d.live.last_recording().trouble;
  json state = loop_state(d.live.loop(), stage.arm());
  state.update({{"scene", stage.document().title},
                {"file", d.document.file()},
                {"objects", d.document.scene().objects.size()},
                {"recording", d.live.recording()},
                {"trouble", trouble.empty() ? json() : json(trouble)},
                {"playing", d.playback.on()},
                {"twin", d.settings.lanes.count > 1},
                {"lanes", d.settings.lanes.count},
                {"blind", d.blind},
                {"hand", nullptr}});
  return state;
}

void print_state(Desktop& d, const WindowState& window) {
  json state = state_of(d);
  state.update(row_of(d));
  state.update(settings_of(d));
  state.update(busy_with(d));
  state.update(parts_of(d));
  state.update({{"size", {window.width, window.height}},
                {"frames", window.frames},
                {"input_waits", window.input_waits},
                {"taken", {{"keys", window.taken.keys}, {"buttons", window.taken.buttons}}}});
  fmt::print("{}\n", json_line(state));
  std::fflush(stdout);
}

}  // namespace limpid
