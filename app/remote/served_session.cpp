#include "app/remote/served_session.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <ctime>
#include <stdexcept>
#include <utility>

#include "app/device/device_store.h"
#include "app/remote/remote_settings.h"
#include "app/run/replay.h"
#include "app/run/twin_settings.h"

namespace limpid {
namespace {

constexpr double kLeastTick = 1e-4;  // in a loop that a recording asks for [s]

namespace fs = std::filesystem;
using nlohmann::json;
using namespace std::chrono_literals;

constexpr std::size_t kDrained = 256;  // rows at a time

TraceChannels channels_of(const RunPlan& plan) {
  return {plan.arm, plan.layout(), body_names(plan.document.scene)};
}

template <class T>
bool ready(const std::future<T>& work) {
  return work.valid() && work.wait_for(0s) == std::future_status::ready;
}

// Whether the last work of this kind is still going on.
template <class T>
bool busy(const std::shared_ptr<std::future<T>>& work) {
  return work && work->valid() && !ready(*work);
}

}  // namespace

ServedSession::ServedSession(World world, std::unique_ptr<Device> device,
                             const SafetyLimits& limits, Options options)
    : options_(std::move(options)),
      world_(std::move(world)),
      highest_(world_.plan.parameters),
      channels_(channels_of(world_.plan)),
      loop_(options_.ask) {
  controls_.parameters = world_.plan.parameters;
  controls_.limits = limits;
  if (!device) {
    begin(std::move(world_), false);
    return;
  }
  world_.led = false;
  loop_.open(world_.plan.arm, world_.plan.document.scene, controls_.parameters, std::move(device));
  loop_.set(controls_);
  rows_.resize(kDrained * 2 * static_cast<std::size_t>(loop_.layout().stride()));
}

ServedSession::~ServedSession() {
  loop_.close();
  try {
    if (recording_.opening.valid()) {
      const auto empty = recording_.opening.get();  // a recording that never began
      empty->finish();
      fs::remove(empty->out());
    }
    loop_.finish_recording();
    if (recording_.closing.valid()) recording_.closing.get();
  } catch (const std::exception& e) {
    std::fputs(fmt::format("limpid: {}\n", e.what()).c_str(), stderr);
  }
}

// Opens the virtual arm in `world`; the last world goes on if that fails.
void ServedSession::begin(World world, bool hand_waits) {
  RunPlan& plan = world.plan;
  hold_limits(plan.parameters, highest_, plan.arm);
  const Vec3 home = world.led ? plan.hand.position.front() : rest_tip(plan.arm);
  loop_.open(plan.arm, plan.document.scene, plan.parameters, home);
  auto path = std::make_unique<LedPath>();
  if (world.led) path->hand = plan.hand;
  path->waits = hand_waits;
  loop_.lead(std::move(path));
  channels_ = channels_of(plan);
  controls_.parameters = plan.parameters;
  controls_.grab = false;
  controls_.goal = home;
  controls_.twin = of_twin_.has_value();
  if (of_twin_) share_world(controls_.parameters, *of_twin_);
  if (of_twin_) controls_.twin_parameters = *of_twin_;
  loop_.set(controls_);
  rows_.assign(kDrained * 2 * static_cast<std::size_t>(loop_.layout().stride()), 0.0);
  newest_.clear();
  reopened_ = true;
  world_ = std::move(world);
}

RemoteHost ServedSession::host() {
  RemoteHost host;
  host.kind = "serve";
  host.state = [this] { return state(); };
  host.parameters = [this]() -> const Parameters& { return controls_.parameters; };
  host.twin = [this] { return of_twin_ ? &*of_twin_ : nullptr; };
  host.highest = [this] { return with_limits_of(world_.plan.arm, highest_); };
  host.usual = [this] {
    return usual_settings(controls_.parameters, highest_, world_.plan.arm, loop_.device_in_place());
  };
  host.set = [this](const Parameters& p, bool of_twin) { set(p, of_twin); };
  host.channels = [this]() -> const TraceChannels& { return channels_; };
  const auto half = [this](bool second) -> std::span<const double> {
    const std::size_t stride = newest_.size() / 2;
    const auto row = std::span<const double>(newest_).subspan(second ? stride : 0, stride);
    return row.empty() || std::isnan(row[0]) ? std::span<const double>() : row;
  };
  host.row = [half] { return half(false); };
  host.twin_row = [half] { return half(true); };
  host.tick = [this] { return tick_; };
  host.trouble = [this] { return recording_.trouble; };
  const auto add = [&](const char* verb, auto action) {
    host.actions[verb] = [action](const Keys& keys, LineServer::Client) { return action(keys); };
  };
  add("open", [this](const Keys& keys) { return open(keys); });
  add("record", [this](const Keys& keys) { return record(keys); });
  add("stop", [this](const Keys&) { return stop(); });
  add("start_over", [this](const Keys&) { return start_over(); });
  add("mark", [this](const Keys& keys) { return mark(keys); });
  add("twin", [this](const Keys& keys) { return twin(keys); });
  add("picture", [this](const Keys& keys) { return picture(keys); });
  add("cut", [this](const Keys&) -> Answer {
    loop_.cut();
    return json::object();
  });
  return host;
}

void ServedSession::turn(Remote& remote) {
  loop_.set(controls_);
  loop_.update();
  if (const LoopStatus status = loop_.status(); !status.running) {
    throw std::runtime_error("the loop has ended: " + status.failure);
  }
  follow_recording();
  watch_buttons();
  if (std::exchange(reopened_, false)) remote.reopened();
  const auto stride = static_cast<std::size_t>(loop_.layout().stride());
  while (const std::size_t count = loop_.drain(rows_)) {
    const std::span<const double> rows(rows_);
    for (std::size_t i = 0; i < count; ++i) {
      tick_ = loop_.drained_from() + i;
      remote.row(rows.subspan(2 * i * stride, stride), rows.subspan((2 * i + 1) * stride, stride),
                 tick_);
    }
    const auto last = rows.subspan(2 * (count - 1) * stride, 2 * stride);
    newest_.assign(last.begin(), last.end());
  }
}

// Lets the device's second button arm it, and cut its force; nothing else here arms it.
void ServedSession::watch_buttons() {
  if (!loop_.device_in_place()) return;
  // A button held while the device comes back asks for nothing.
  if (!loop_.snapshot().connected) return buttons_.forget();
  const std::uint32_t pressed = buttons_.take(loop_.snapshot().reading.buttons);
  if ((pressed & 2) == 0) return;
  loop_.snapshot().armed() ? loop_.cut() : loop_.arm();
}

json ServedSession::state() const {
  json state = loop_state(loop_, world_.plan.arm);
  state.update({{"scene", world_.plan.document.title},
                {"objects", world_.plan.document.scene.objects.size()},
                {"recording", recording()},
                {"trouble", recording_.trouble.empty() ? json() : json(recording_.trouble)},
                {"twin", of_twin_.has_value()},
                {"hand", nullptr}});
  if (world_.led) {
    state["hand"] = {{"source", world_.plan.hand.source},
                     {"time", loop_.snapshot().led},
                     {"duration", world_.plan.hand.duration()}};
  }
  return state;
}

void ServedSession::set(const Parameters& p, bool of_twin) {
  (of_twin ? *of_twin_ : controls_.parameters) = p;
  if (of_twin_) {
    share_world(controls_.parameters, *of_twin_);
    controls_.twin_parameters = *of_twin_;
  }
}

// Opens other files; what is open goes on until they are read.
Answer ServedSession::open(const Keys& keys) {
  const auto text = [&](const char* key) { return keys.text_if(key).value_or(""); };
  const OpenRequest asked{text("scene"), text("arm"), text("tip"), text("session"), text("hand")};
  const bool waits = keys.flag_or("wait", false);
  if (recording()) throw RemoteError("open: stop the recording before");
  if (loop_.device_in_place() &&
      (!asked.arm.empty() || !asked.session.empty() || !asked.hand.empty())) {
    throw RemoteError(
        "open: a real device is in the arm's place, and a person's hand leads it; allowed: scene");
  }
  if (asked.scene.empty() && asked.arm.empty() && asked.session.empty() && asked.hand.empty()) {
    throw RemoteError("open: nothing to open; allowed: scene, arm, session, hand");
  }
  if (busy(opening_)) throw RemoteError("open: something else is being opened");
  opening_ = std::make_shared<std::future<World>>(files_.run(
      [open = options_.open, asked, now = controls_.parameters] { return open(asked, now); }));
  return Answer::Later([this, loading = opening_, waits,
                        of_session = !asked.session.empty()]() -> std::optional<json> {
    if (!ready(*loading)) return std::nullopt;
    World world = loading->get();
    if (const double tick = world.plan.parameters.tick; of_session && tick < kLeastTick) {
      throw RemoteError(
          fmt::format("open: session: a tick of {} s would take the computer; allowed: {} to 0.1",
                      tick, kLeastTick));
    }
    if (recording()) throw RemoteError("open: a recording has begun meanwhile");
    if (!loop_.device_in_place()) {
      begin(std::move(world), waits);
      return state();
    }
    if (count_bodies(world.plan.document.scene) != loop_.layout().bodies()) {
      throw RemoteError("open: scene: has another number of objects that move");
    }
    loop_.cut();
    loop_.exchange(std::make_unique<TouchWorlds>(world_.plan.arm, world.plan.document.scene));
    world_.plan.document = std::move(world.plan.document);
    return state();
  });
}

std::string ServedSession::source() const {
  if (loop_.device_in_place()) return "device";
  return world_.led ? world_.plan.hand.source : "nobody";
}

Answer ServedSession::record(const Keys& keys) {
  if (recording()) throw RemoteError("record: a recording is under way; stop it before");
  if (loop_.recorder() != nullptr || recording_.closing.valid())
    throw RemoteError("record: the last one is being closed");
  fs::path file;
  if (keys.has("file")) {
    file = keys.file(".h5");
  } else {
    fs::create_directories(options_.folder);
    file = options_.folder /
           fmt::format("session-{:%Y%m%d-%H%M%S}.h5", fmt::localtime(std::time(nullptr)));
  }
  RunPlan plan;
  plan.arm = world_.plan.arm;
  plan.document = world_.plan.document;
  plan.seed = world_.plan.seed;
  plan.hand.source = source();
  plan.parameters = loop_.taken(controls_.parameters);
  if (of_twin_) plan.beside.push_back({*of_twin_, {}});
  SessionInfo about = session_info(plan);
  if (loop_.device_in_place()) about.safety = limits_text(controls_.limits);
  recording_ = {};
  recording_.file = file;
  recording_.opening = recordings_.run([file, about, initial = plan.parameters, twin = of_twin_,
                                        replaces = keys.flag_or("force", false)] {
    return std::make_unique<Recorder>(file, about, initial, replaces, Recorder::kLiveRoom,
                                      twin ? &*twin : nullptr);
  });
  return Answer::Later([this, file]() -> std::optional<json> {
    if (!recording_.failure.empty()) throw RemoteError("record: " + recording_.failure);
    if (!loop_.recording() || !loop_.snapshot().recording) return std::nullopt;
    return json{{"file", file.string()}};
  });
}

Answer ServedSession::stop() {
  if (!recording() && loop_.recorder() == nullptr && !recording_.closing.valid()) {
    const std::string failure = std::exchange(recording_.failure, {});  // ended by itself
    throw RemoteError("stop: " + (failure.empty() ? "nothing is being recorded" : failure));
  }
  return Answer::Later([this]() -> std::optional<json> {
    if (recording_.opening.valid()) return std::nullopt;  // stopped once it is open
    loop_.stop_recording();
    if (!recording_.failure.empty()) throw RemoteError("stop: " + recording_.failure);
    if (!recording_.complete) return std::nullopt;
    return json{{"file", recording_.file.string()},
                {"rows", recording_.rows},
                {"dropped", recording_.dropped}};
  });
}

void ServedSession::follow_recording() {
  try {
    if (ready(recording_.opening)) {
      auto recorder = recording_.opening.get();
      if (const std::string note = lock_note(*recorder); !note.empty()) {
        fmt::print(stderr, "limpid: note: {}\n", note);
      }
      loop_.record(std::move(recorder));
    }
    if (loop_.recording() && loop_.recorder()->failed()) {
      recording_.trouble = why_it_ended(*loop_.recorder());
      loop_.stop_recording();
    }
    if (std::shared_ptr<Recorder> done = loop_.take_recorded()) {
      recording_.rows = done->rows();
      recording_.dropped = done->dropped();
      recording_.closing = recordings_.run([done] { done->finish(); });
    }
    if (!ready(recording_.closing)) return;
    recording_.closing.get();
    recording_.complete = true;
  } catch (const std::exception& e) {
    recording_.failure = e.what();
  }
}

Answer ServedSession::start_over() {
  if (recording()) throw RemoteError("start_over: stop the recording before");
  if (!loop_.device_in_place()) loop_.arm();
  ++controls_.resets;
  return place();
}

json ServedSession::place() const {
  json at{{"tick", tick_}, {"time", nullptr}};
  if (!newest_.empty()) at["time"] = loop_.layout().in(std::span(newest_), Column::time)[0];
  return at;
}

Answer ServedSession::mark(const Keys& keys) {
  const std::string text = noted(keys);
  if (loop_.recording()) loop_.mark({loop_.recorder()->newest(), text});
  return place();
}

Answer ServedSession::twin(const Keys& keys) {
  if (recording()) throw RemoteError("twin: stop the recording before");
  if (loop_.device_in_place()) {
    throw RemoteError("twin: needs the virtual arm: one hand cannot hold two real devices");
  }
  const bool on = keys.flag_or("on", true);
  if (!on) {
    of_twin_.reset();
    controls_.twin = false;
    return json{{"on", false}};
  }
  Parameters p = of_twin_.value_or(controls_.parameters);
  if (keys.has("values")) set_values(p, keys, with_limits_of(world_.plan.arm, highest_));
  of_twin_ = p;
  controls_.twin = true;
  set(p, true);
  return json{{"on", true}};
}

Answer ServedSession::picture(const Keys& keys) {
  const fs::path file = keys.file_to_write(".png");
  if (newest_.empty()) throw RemoteError("picture: there is no row yet");
  std::vector<double> row(newest_.begin(),
                          newest_.begin() + static_cast<std::ptrdiff_t>(newest_.size() / 2));
  if (busy(drawing_)) throw RemoteError("picture: another one is being drawn");
  drawing_ = std::make_shared<std::future<bool>>(
      files_.run([draw = options_.draw, file, plan = world_.plan, row = std::move(row)] {
        draw(file, plan, row);
        return true;
      }));
  return Answer::Later([drawing = drawing_, file]() -> std::optional<json> {
    if (!ready(*drawing)) return std::nullopt;
    drawing->get();
    return json{{"file", file.string()}};
  });
}

}  // namespace limpid
