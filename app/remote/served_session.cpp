#include "app/remote/served_session.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <span>
#include <stdexcept>
#include <utility>

#include "app/base/dated_file.h"
#include "app/device/device_store.h"
#include "app/remote/remote_settings.h"
#include "app/run/replay.h"

namespace limpid {
namespace {

constexpr double kLeastTick = 1e-4;  // of a live loop, unless a person chooses the tick [s]

namespace fs = std::filesystem;
using nlohmann::json;
using namespace std::chrono_literals;

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

std::string refused_tick(const RunPlan& plan, double chosen) {
  const double tick = plan.parameters.tick;
  if (tick >= kLeastTick || tick == chosen) return {};
  return fmt::format("a tick of {} s is too short for the live loop; allowed: {} to 0.1", tick,
                     kLeastTick);
}

ServedSession::ServedSession(World world, std::unique_ptr<Device> device,
                             const SafetyLimits& limits, Options options)
    : options_(std::move(options)),
      world_(std::move(world)),
      highest_(world_.plan.parameters),
      channels_(channels_of(world_.plan)),
      session_(options_.ask) {
  controls().limits = limits;
  if (!device) {
    begin(std::move(world_), false);
    return;
  }
  world_.led = false;
  session_.open(world_.plan.arm, world_.plan.document.scene, world_.plan.parameters,
                std::move(device));
}

ServedSession::~ServedSession() = default;

// Opens the virtual arm in `world`; the last world goes on if that fails.
void ServedSession::begin(World world, bool hand_waits) {
  RunPlan& plan = world.plan;
  hold_limits(plan.parameters, highest_, plan.arm);
  const Vec3 home = world.led ? plan.hand.position.front() : rest_tip(plan.arm);
  session_.open(plan.arm, plan.document.scene, plan.parameters, home);
  auto path = std::make_unique<LedPath>();
  if (world.led) path->hand = plan.hand;
  path->waits = hand_waits;
  loop().lead(std::move(path));
  channels_ = channels_of(plan);
  reopened_ = true;
  world_ = std::move(world);
}

RemoteHost ServedSession::host() {
  RemoteHost host;
  host.kind = "serve";
  host.state = [this] { return state(); };
  host.lanes = [this] { return controls().lane_count; };
  host.parameters = [this](std::size_t lane) -> const Parameters& {
    return controls().lanes[lane];
  };
  host.highest = [this] { return with_limits_of(world_.plan.arm, highest_); };
  host.usual = [this] {
    return usual_settings(controls().parameters(), highest_, world_.plan.arm,
                          loop().device_in_place());
  };
  host.set = [this](const Parameters& p, std::size_t lane) { session_.set(lane, p); };
  host.channels = [this]() -> const TraceChannels& { return channels_; };
  host.rows = [this] {
    return session_.ticked() ? session_.rows() : std::vector<std::span<const double>>();
  };
  host.tick = [this] { return session_.tick(); };
  host.trouble = [this] { return session_.last_recording().trouble; };
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
    loop().cut();
    return json::object();
  });
  return host;
}

void ServedSession::turn(Remote& remote) {
  if (std::exchange(reopened_, false)) remote.reopened();
  const RecordingNews news =
      session_.turn([&](LaneRows rows, std::uint64_t tick) { remote.row(rows, tick); });
  if (!news.note.empty()) fmt::print(stderr, "limpid: note: {}\n", news.note);
  if (const LoopStatus status = loop().status(); !status.running) {
    throw std::runtime_error("the loop has ended: " + status.failure);
  }
  watch_buttons();
}

// Lets the device's second button arm it, and cut its force; nothing else here arms it.
void ServedSession::watch_buttons() {
  if (!loop().device_in_place()) return;
  // A button held while the device comes back asks for nothing.
  if (!loop().snapshot().connected) return buttons_.forget();
  const std::uint32_t pressed = buttons_.take(loop().snapshot().reading);
  if ((pressed & 2) == 0 || loop().toggle_force()) return;
  fmt::print(stderr,
             "limpid: note: the force switched itself off a moment ago; wait a second, then press "
             "the button to arm it\n");
}

json ServedSession::state() const {
  const std::string& trouble = session_.last_recording().trouble;
  json state = loop_state(loop(), world_.plan.arm);
  state.update({{"scene", world_.plan.document.title},
                {"objects", world_.plan.document.scene.objects.size()},
                {"recording", session_.recording()},
                {"trouble", trouble.empty() ? json() : json(trouble)},
                {"twin", controls().lane_count > 1},
                {"lanes", controls().lane_count},
                {"hand", nullptr}});
  if (world_.led) {
    state["hand"] = {{"source", world_.plan.hand.source},
                     {"time", loop().snapshot().led},
                     {"duration", world_.plan.hand.duration()}};
  }
  return state;
}

// Opens other files; what is open goes on until they are read.
Answer ServedSession::open(const Keys& keys) {
  const auto text = [&](const char* key) { return keys.text_if(key).value_or(""); };
  const OpenRequest asked{text("scene"), text("arm"), text("tip"), text("session"), text("hand")};
  const bool waits = keys.flag_or("wait", false);
  if (session_.recording()) {
    throw RemoteError("open: not while a recording runs; stop the recording first");
  }
  if (loop().device_in_place() &&
      (!asked.arm.empty() || !asked.session.empty() || !asked.hand.empty())) {
    throw RemoteError(
        "open: a person's hand moves a real device, so arm, session and hand cannot be opened; "
        "allowed: scene");
  }
  if (asked.scene.empty() && asked.arm.empty() && asked.session.empty() && asked.hand.empty()) {
    throw RemoteError("open: nothing to open; allowed: scene, arm, session, hand");
  }
  if (busy(opening_)) throw RemoteError("open: another file is being opened; try again");
  opening_ = std::make_shared<std::future<World>>(files_.run(
      [open = options_.open, asked, now = controls().parameters()] { return open(asked, now); }));
  return Answer::Later([this, loading = opening_, waits,
                        key = asked.session.empty() ? "hand" : "session",
                        begun = false]() mutable -> std::optional<json> {
    // Whoever is told that a world is open finds its first row there.
    if (begun) return session_.ticked() ? std::optional(state()) : std::nullopt;
    if (!ready(*loading)) return std::nullopt;
    World world = loading->get();
    if (const std::string wrong = refused_tick(world.plan, controls().parameters().tick);
        !wrong.empty()) {
      throw RemoteError(fmt::format("open: {}: {}", key, wrong));
    }
    if (session_.recording()) {
      throw RemoteError("open: a recording has begun in the meantime; stop the recording first");
    }
    if (!loop().device_in_place()) {
      begin(std::move(world), waits);
      begun = true;
      return std::nullopt;
    }
    if (count_bodies(world.plan.document.scene) != loop().layout().bodies()) {
      throw RemoteError(
          "open: scene: has a different number of objects that move; needed: the same number as "
          "now, because a real device is in use");
    }
    loop().cut();
    session_.touch(world_.plan.arm, world.plan.document.scene);
    world_.plan.document = std::move(world.plan.document);
    return state();
  });
}

std::string ServedSession::source() const {
  if (loop().device_in_place()) return loop().device_source();
  return world_.led ? world_.plan.hand.source : "nobody";
}

Answer ServedSession::record(const Keys& keys) {
  if (session_.recording()) {
    throw RemoteError("record: a recording runs already; stop that recording first");
  }
  if (session_.closing())
    throw RemoteError(
        "record: the previous recording is still being written; try again in a moment");
  fs::path file;
  if (keys.has("file")) {
    file = keys.file(".h5");
  } else {
    fs::create_directories(options_.folder);
    file = dated_file(options_.folder, "session", "h5");
  }
  RunPlan plan;
  plan.arm = world_.plan.arm;
  plan.document = world_.plan.document;
  plan.seed = world_.plan.seed;
  plan.hand.source = source();
  plan.parameters = loop().taken(controls().parameters());
  for (std::size_t i = 1; i < controls().lane_count; ++i) {
    plan.beside.push_back({controls().lanes[i], {}});
  }
  SessionInfo about = session_info(plan);
  if (loop().device_in_place()) about.safety = limits_text(controls().limits);
  told_ = false;
  session_.record(about, plan.settings(), file, keys.flag_or("force", false));
  return Answer::Later([this, file]() -> std::optional<json> {
    const std::string& failure = session_.last_recording().failure;
    if (!failure.empty()) throw RemoteError("record: " + failure);
    if (!loop().recording() || !loop().snapshot().recording) return std::nullopt;
    return json{{"file", file.string()}};
  });
}

Answer ServedSession::stop() {
  const Recorded& last = session_.last_recording();
  if (!session_.recording() && !session_.closing()) {
    // A recording that ended by itself says why, once.
    const bool told = last.failure.empty() || std::exchange(told_, true);
    throw RemoteError("stop: " + (told ? "nothing is being recorded" : last.failure));
  }
  return Answer::Later([this, &last]() -> std::optional<json> {
    if (session_.opening_recording()) return std::nullopt;  // stopped once it is open
    session_.stop_recording();
    if (!last.failure.empty()) throw RemoteError("stop: " + last.failure);
    if (!last.complete) return std::nullopt;
    return json{{"file", last.file.string()}, {"rows", last.rows}, {"dropped", last.dropped}};
  });
}

Answer ServedSession::start_over() {
  if (session_.recording()) {
    throw RemoteError("start_over: not while a recording runs; stop the recording first");
  }
  if (!loop().device_in_place()) loop().arm();
  ++controls().resets;
  return place();
}

json ServedSession::place() const {
  json at{{"tick", session_.tick()}, {"time", nullptr}};
  if (session_.ticked()) at["time"] = loop().layout().in(session_.rows()[0], Column::time)[0];
  return at;
}

Answer ServedSession::mark(const Keys& keys) {
  const std::string text = noted(keys);
  if (loop().recording()) loop().mark({loop().recorded_row(session_.tick()), text});
  return place();
}

Answer ServedSession::twin(const Keys& keys) {
  if (session_.recording()) {
    throw RemoteError("twin: not while a recording runs; stop the recording first");
  }
  if (loop().device_in_place()) {
    throw RemoteError("twin: needs the virtual arm: one hand cannot hold two real devices");
  }
  const std::size_t lane = asked_lane(keys, kTwinLane);
  check_beside(keys, lane, controls().lane_count);
  const bool on = keys.flag_or("on", true);
  if (!on) {
    session_.run_lanes(std::min(controls().lane_count, lane));
    return json{{"on", false}};
  }
  const bool runs = lane < controls().lane_count;
  Parameters p = runs ? controls().lanes[lane] : controls().parameters();
  if (keys.has("values")) set_values(p, keys, lane, with_limits_of(world_.plan.arm, highest_));
  session_.set(lane, p);
  session_.run_lanes(std::max(controls().lane_count, lane + 1));
  return json{{"on", true}};
}

Answer ServedSession::picture(const Keys& keys) {
  const fs::path file = keys.file_to_write(".png");
  if (!session_.ticked()) throw RemoteError("picture: the loop has not run a tick yet");
  std::vector<double> row(session_.rows()[0].begin(), session_.rows()[0].end());
  if (busy(drawing_)) throw RemoteError("picture: another picture is being drawn; try again");
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
