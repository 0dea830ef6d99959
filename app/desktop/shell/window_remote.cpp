#include "app/desktop/shell/window_remote.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "app/base/folders.h"
#include "app/desktop/shell/commands.h"
#include "app/desktop/shell/state.h"
#include "app/remote/remote_settings.h"
#include "app/run/shipped_files.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

fs::path file_of(const Keys& keys, const char* key, const char* kind) {
  const std::string named = keys.text(key);
  fs::path file = shipped_file(named, {kind}).value_or(named);
  if (!file.is_absolute() || !fs::exists(file)) {
    const std::string hint = shipped_hint(named, {kind});
    throw keys.error(key, fmt::format("there is no file {}{} allowed: a path that begins with /, "
                                      "or a file that came with the program",
                                      shown(named), hint.empty() ? ";" : hint));
  }
  return file;
}

std::string limits_of(const Parameters& p) {
  std::string text;
  for (const char* key : kMotorLimits) {
    text += parameter_text(p, *find_parameter(key)) + " ";
  }
  return text;
}

}  // namespace

WindowRemote::WindowRemote(const fs::path& socket, Desktop& desktop)
    : d_(desktop),
      highest_(desktop.settings.parameters()),
      limits_(limits_of(highest_)),
      remote_(socket, host(), [&desktop] { desktop.live.loop().cut(); }) {
  d_.live.on_row = [this](LaneRows rows, std::uint64_t tick) {
    tick_ = tick;
    remote_.row(rows, tick);
  };
}

bool WindowRemote::turn() {
  follow_limits();
  // Gains that were fitted to a new arm are no choice of the person.
  if (const Stage* now = &d_.live.stage(); std::exchange(stage_, now) != now) {
    remote_.reopened();
    if (d_.lead.on()) d_.lead.note_program();
  }
  follow_lead();
  const bool any = remote_.turn();
  // The question stays open after Esc and other dialogs.
  if (d_.question.asking() && d_.dialog.kind() == nullptr && !d_.document.asking())
    d_.dialog.open("ask");
  return any;
}

// Takes limits that the person sets with a slider or a preset as the highest for programs.
void WindowRemote::follow_limits() {
  const Parameters& now = d_.settings.parameters();
  if (std::string limits = limits_of(now); limits != limits_) {
    highest_ = now;
    limits_ = std::move(limits);
  }
}

void WindowRemote::saved(std::span<const SavedPicture> pictures) {
  saved_.insert(saved_.end(), pictures.begin(), pictures.end());
  constexpr std::size_t kKept = 32;  // the window's own key saves pictures, too
  if (saved_.size() > kKept) saved_.erase(saved_.begin(), saved_.end() - kKept);
}

RemoteHost WindowRemote::host() {
  RemoteHost host;
  host.kind = "window";
  host.state = [this] { return state_of(d_); };
  host.lanes = [this] { return d_.settings.lanes.count; };
  host.parameters = [this](std::size_t lane) -> const Parameters& {
    return d_.settings.lanes.parameters[lane];
  };
  host.highest = [this] { return with_limits_of(d_.live.stage().arm(), highest_); };
  host.before_set = [this](LineServer::Client client) { lead(client); };
  host.usual = [this] {
    return usual_settings(d_.settings.parameters(), highest_, d_.live.stage().arm(),
                          d_.live.loop().device_in_place());
  };
  host.set = [this](const Parameters& p, std::size_t lane) { set(p, lane); };
  host.channels = [this]() -> const TraceChannels& { return d_.live.stage().channels(); };
  host.rows = [this] { return d_.live.rows(); };
  host.tick = [this] { return tick_; };
  host.trouble = [this] { return d_.live.last_recording().trouble; };
  host.gone = [this](LineServer::Client client) { gone(client); };
  add_actions(host);
  return host;
}

void WindowRemote::add_actions(RemoteHost& host) {
  using Client = LineServer::Client;
  auto& actions = host.actions;
  actions["open"] = [this](const Keys& keys, Client client) { return open(keys, client); };
  actions["record"] = [this](const Keys& keys, Client) { return record(keys); };
  actions["stop"] = [this](const Keys&, Client) { return stop(); };
  actions["start_over"] = [this](const Keys&, Client) { return start_over(); };
  actions["mark"] = [this](const Keys& keys, Client) { return mark(keys); };
  actions["twin"] = [this](const Keys& keys, Client client) { return twin(keys, client); };
  actions["blind"] = [this](const Keys& keys, Client client) { return blind(keys, client); };
  actions["ask"] = [this](const Keys& keys, Client client) { return ask(keys, client); };
  actions["picture"] = [this](const Keys& keys, Client) { return picture(keys); };
  actions["cut"] = [this](const Keys&, Client) -> Answer {
    d_.cut_force();
    return json::object();
  };
}

// Runs a command as its key does, even if a program hides the settings.
void WindowRemote::run(const char* command) {
  if (const std::string why = run_command(command, d_, Asker::program); !why.empty()) {
    throw RemoteError(why);
  }
}

// Returns the window's last notice of a failure.
std::string WindowRemote::last_complaint(const char* otherwise) const {
  const auto& all = d_.notices.all();
  const auto bad = std::find_if(all.rbegin(), all.rend(), [](const Notice& n) { return n.bad; });
  return bad != all.rend() ? bad->text : otherwise;
}

void WindowRemote::set(const Parameters& p, std::size_t lane) {
  d_.settings.lanes.parameters[lane] = p;
  if (lane == kMainLane) limits_ = limits_of(p);
  d_.lead.note_program();
}

// Gives the settings to this client until it is gone.
void WindowRemote::lead(LineServer::Client client) {
  d_.tuning.end_break();
  d_.lead.begin();
  leaders_.insert(client);
}

// Ends the leaders' recording and brings the person's settings back, once all leaders are gone.
void WindowRemote::follow_lead() {
  d_.lead.follow_person();
  if (!leaders_.empty() || !d_.lead.on()) return;
  const LiveLoop& loop = d_.live.loop();
  if (loop.recording() && loop.recorder()->out() == recorded_) run("session.record");
  if (d_.lead.end(study_)) study_ = false;
}

Answer WindowRemote::open(const Keys& keys, LineServer::Client client) {
  if (d_.live.recording()) {
    throw RemoteError("open: not while a recording runs; stop the recording first");
  }
  if (d_.document.editor().dirty() && !keys.has("session")) {
    throw RemoteError("open: the scene has unsaved changes; a person must decide about them");
  }
  const bool arm = keys.has("arm");
  const int asked = static_cast<int>(keys.has("scene")) + static_cast<int>(arm) +
                    static_cast<int>(keys.has("session")) + static_cast<int>(keys.has("hand"));
  if (asked != 1) throw RemoteError("open: allowed: one of scene, arm, session, hand");
  if (keys.has("tip") && !arm) throw keys.error("tip", "belongs to an arm");
  if (keys.has("wait"))
    throw keys.error("wait", "needs `limpid serve`; here motions of a hand are run immediately");
  const auto elsewhere = [&](fs::path file) {
    lead(client);
    d_.lead.begin_elsewhere();
    return file;
  };
  if (keys.has("scene")) return open_scene(elsewhere(file_of(keys, "scene", "scenes")));
  if (arm) {
    if (d_.live.loop().device_in_place()) {
      throw RemoteError("open: a real device is used instead of the virtual arm");
    }
    return open_arm(elsewhere(file_of(keys, "arm", "devices")), keys.text_if("tip").value_or(""));
  }
  return play(keys.has("session") ? file_of(keys, "session", "sessions")
                                  : file_of(keys, "hand", "hands"));
}

Answer WindowRemote::open_scene(const fs::path& file) {
  d_.notices.clear();
  d_.world.open_scene(file);
  return Answer::Later([this, before = stage_]() -> std::optional<json> {
    if (d_.document.loader().busy()) return std::nullopt;
    if (&d_.live.stage() == before)
      throw RemoteError(last_complaint("open: the scene was not loaded"));
    return state_of(d_);
  });
}

Answer WindowRemote::open_arm(const fs::path& file, const std::string& tip) {
  d_.notices.clear();
  d_.world.open_arm(file, tip);
  return Answer::Later([this, before = stage_]() -> std::optional<json> {
    if (d_.document.loader().busy()) return std::nullopt;
    if (&d_.live.stage() == before)
      throw RemoteError(last_complaint("open: the arm was not loaded"));
    hold_limits(d_.settings.parameters(), highest_, d_.live.stage().arm());
    limits_ = limits_of(d_.settings.parameters());
    d_.lead.note_program();
    return state_of(d_);
  });
}

Answer WindowRemote::play(const fs::path& file) {
  d_.playback.close();
  d_.notices.clear();
  d_.world.open_files({file});
  return Answer::Later([this]() -> std::optional<json> {
    if (d_.playback.loading()) return std::nullopt;
    if (!d_.playback.on()) throw RemoteError(last_complaint("open: the session was not loaded"));
    return state_of(d_);
  });
}

Answer WindowRemote::record(const Keys& keys) {
  if (d_.live.recording()) {
    throw RemoteError("record: a recording runs already; stop that recording first");
  }
  if (!d_.live.may_record())
    throw RemoteError(
        "record: the previous recording is still being written; try again in a moment");
  fs::path file;
  const bool replaces = keys.flag_or("force", false);
  if (keys.has("file")) {
    file = keys.file(".h5");
    if (fs::exists(file) && !replaces) {
      throw keys.error("file", file.string() + " exists already; with force it is replaced");
    }
  }
  d_.notices.clear();
  d_.world.record(file, replaces);
  records_ = true;
  return Answer::Later([this]() -> std::optional<json> {
    if (!d_.live.recording())
      throw RemoteError(last_complaint("record: the recording has not begun"));
    const LiveLoop& loop = d_.live.loop();
    if (!loop.recording() || !loop.snapshot().recording) return std::nullopt;
    recorded_ = loop.recorder()->out();
    return json{{"file", recorded_.string()}};
  });
}

Answer WindowRemote::stop() {
  const bool began = std::exchange(records_, false);
  if (!d_.live.recording() && !began) throw RemoteError("stop: nothing is being recorded");
  // A recording that ended by itself, as on a full disk, says why.
  return Answer::Later([this]() -> std::optional<json> {
    if (d_.live.recording()) {
      if (d_.live.loop().recording()) run("session.record");  // ends the recording
      return std::nullopt;
    }
    if (d_.live.closing()) return std::nullopt;
    const Recorded& last = d_.live.last_recording();
    if (!last.complete) {
      throw RemoteError(last_complaint("stop: the recording could not be completed"));
    }
    return json{{"file", last.file.string()}, {"rows", last.rows}, {"dropped", last.dropped}};
  });
}

// Starts over, or goes back to live: both have the same key.
Answer WindowRemote::start_over() {
  if (d_.live.recording()) {
    throw RemoteError("start_over: not while a recording runs; stop the recording first");
  }
  run(d_.playback.on() ? "session.back_to_live" : "device.start_over");
  return place();
}

json WindowRemote::place() const {
  const double time = d_.live.loop().layout().in(d_.live.row(), Column::time)[0];
  return {{"tick", tick_}, {"time", time}};
}

Answer WindowRemote::mark(const Keys& keys) {
  d_.live.note(d_.live.now(), noted(keys));
  return place();
}

Answer WindowRemote::twin(const Keys& keys, LineServer::Client client) {
  const bool on = keys.flag_or("on", true);
  const bool sets = on && keys.has("values");
  LaneSettings& lanes = d_.settings.lanes;
  const std::size_t lane = asked_lane(keys, kTwinLane);
  check_beside(keys, lane, lanes.count);
  Parameters p = lanes.parameters[lane];
  if (sets) set_values(p, keys, lane, with_limits_of(d_.live.stage().arm(), highest_));
  lead(client);
  if (on && lanes.count == lane) run("session.add_run");
  while (!on && lanes.count > lane) run("session.drop_run");
  d_.lead.note_program();
  if (!sets) return json{{"on", on}};
  set(p, lane);
  return json{{"on", on}};
}

Answer WindowRemote::blind(const Keys& keys, LineServer::Client client) {
  if (hides_ && *hides_ != client)
    throw RemoteError("blind: another program hides the plots already");
  const bool on = keys.flag_or("on", true);
  if (on && d_.dialog.kind() != nullptr && d_.dialog.name() != "ask") d_.dialog.close();
  d_.blind = on;
  study_ |= on;
  hides_ = on ? std::optional(client) : std::nullopt;
  return json{{"on", on}};
}

Answer WindowRemote::ask(const Keys& keys, LineServer::Client client) {
  if (d_.question.asking()) throw RemoteError("ask: another question is open");
  if (d_.document.asking() || d_.identify.busy()) {
    throw RemoteError("ask: the window already asks another question; answer that question first");
  }
  const bool ends = keys.has("seconds");
  auto choices = keys.texts_if("choices", PersonQuestion::kMostChoices);
  if (!choices || choices->empty()) {
    choices = ends ? std::vector<std::string>() : std::vector<std::string>{"Go on"};
  }
  const double seconds = keys.number_or("seconds", 0, 0.1, 3600);
  d_.question.ask(keys.text("text"), *choices, {keys.flag_or("beside", false), seconds});
  asks_ = client;
  if (!d_.dialog.modal()) d_.dialog.open("ask");  // else turn() opens it once that is answered
  return Answer::Later([this]() -> std::optional<json> {
    const auto answer = d_.question.take();
    if (!answer) return std::nullopt;
    asks_.reset();
    json said{
        {"answer", nullptr}, {"index", nullptr}, {"seconds", answer->seconds}, {"tick", tick_}};
    if (answer->choice) {
      said["answer"] = d_.question.choice(*answer->choice);
      said["index"] = *answer->choice;
    }
    return said;
  });
}

Answer WindowRemote::picture(const Keys& keys) {
  const fs::path file = keys.file_to_write(".png");
  std::erase_if(saved_, [&](const SavedPicture& each) { return each.file == file; });
  if (!d_.asked.picture.empty()) throw RemoteError("picture: another picture is being saved");
  d_.asked.picture = file;
  return Answer::Later([this, file]() -> std::optional<json> {
    const auto done = std::ranges::find(saved_, file, &SavedPicture::file);
    if (done == saved_.end()) return std::nullopt;
    const SavedPicture result = *done;
    saved_.erase(done);
    if (!result.error.empty()) throw RemoteError("picture: " + result.error);
    return json{{"file", file.string()}};
  });
}

// Ends the client's hiding and its question.
void WindowRemote::gone(LineServer::Client client) {
  if (hides_ == client) {
    d_.blind = false;
    hides_.reset();
  }
  leaders_.erase(client);
  if (asks_ != client) return;
  asks_.reset();
  d_.question.withdraw();
  if (d_.dialog.name() == "ask") d_.dialog.close();
}

}  // namespace limpid
