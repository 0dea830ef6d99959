#include "app/remote/remote.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "app/base/version.h"
#include "app/device/device_store.h"
#include "app/plot/channel_names.h"
#include "app/remote/live_channels.h"
#include "app/remote/remote_settings.h"
#include "app/run/fitted_gains.h"

namespace limpid {
namespace {

using nlohmann::json;

constexpr std::size_t kRowsInALine = 128;

// Returns the lane of a channel's name, and takes the lane's beginning off: "twin/".
std::size_t lane_in(std::string& name) {
  for (std::size_t i = 1; i < kMostLanes; ++i) {
    const std::string begins = lane_name(i) + "/";
    if (!name.starts_with(begins)) continue;
    name.erase(0, begins.size());
    return i;
  }
  return kMainLane;
}

bool runs(LaneRows rows, std::size_t lane) {
  return lane < rows.size() && !rows[lane].empty() && !std::isnan(rows[lane][0]);
}

// Returns which channel was meant, or where all of them are listed.
std::string channel_hint(const TraceChannels& channels, const std::string& name) {
  if (const auto meant = meant_channel(channels, name)) {
    return fmt::format("did you mean {}?", *meant);
  }
  return "allowed: the channels of sessions, for example hand/torque, and the channels that `row` "
         "without channels lists";
}

}  // namespace

std::size_t asked_lane(const Keys& keys, std::size_t usual) {
  constexpr double kLast = kMostLanes - 1;
  const double lane = keys.number_or("lane", static_cast<double>(usual), 0, kLast);
  if (lane == std::floor(lane)) return static_cast<std::size_t>(lane);
  throw keys.error("lane", fmt::format("{} is not allowed; allowed: whole numbers", lane));
}

void check_beside(const Keys& keys, std::size_t lane, std::size_t lanes) {
  if (lane == kMainLane) throw keys.error("lane", "0 is the first run, which always runs");
  if (keys.flag_or("on", true) && lane > lanes) {
    throw keys.error("lane", fmt::format("{} needs {} as well", lane, lane - 1));
  }
}

std::string noted(const Keys& keys) {
  const json& text = keys.of("text");
  const std::size_t bytes = text.is_string() ? text.get_ref<const std::string&>().size() : 1;
  if (bytes >= 1 && bytes <= kMarkLength) return keys.text("text");
  throw keys.error("text", fmt::format("{} bytes in UTF-8; allowed: 1 to {}", bytes, kMarkLength));
}

Parameters usual_settings(const Parameters& now, const Parameters& chosen,
                          const ArmDescription& arm, bool with_device) {
  Parameters p = fitted(arm);
  for (const ParameterInfo& info : parameter_table()) {
    if (!info.live) set_parameter_number(p, info, parameter_number(now, info));
  }
  if (with_device) {
    OwnForces::of(now).give(p);
    p.encoder_step = now.encoder_step;
  }
  hold_limits(p, chosen, arm);
  return p;
}

json loop_state(const LiveLoop& loop, const ArmDescription& arm) {
  const Snapshot& now = loop.snapshot();
  const LoopStatus status = loop.status();
  const auto warmth = loop.layout().in(std::span<const double>(now.row), Column::motor_warmth);
  return {{"arm", arm.name},
          {"joints", arm.dof()},
          {"device", loop.device_in_place()},
          {"force", now.armed()},
          {"why_no_force", explain(now.force_state)},
          {"warmth", std::ranges::max(warmth)},
          {"unstable", now.diverged},
          {"ticks", status.ticks},
          {"late", status.late},
          {"missed", status.missed},
          {"slipped", status.slipped},
          {"rate", status.rate}};
}

Remote::Remote(const std::filesystem::path& path, RemoteHost host, std::function<void()> cut)
    : host_(std::move(host)), server_(path, [cut = std::move(cut)](std::string_view line) {
        if (asks_for_cut(line)) cut();
      }) {}

bool Remote::turn() {
  bool any = false;
  // Events that come meanwhile wait for the next turn.
  constexpr std::size_t kMost = LineServer::kMostClients * LineServer::kMostUnanswered;
  for (std::size_t i = 0; i < kMost; ++i) {
    const auto event = server_.take();
    if (!event) break;
    take(*event);
    any = true;
  }
  follow_up();
  tell_trouble();
  for (auto& [client, follower] : followers_) flush(client, follower);
  return any;
}

void Remote::take(const LineServer::Event& event) {
  if (!event.line) {
    followers_.erase(event.from);
    here_.erase(event.from), untold_.erase(event.from);
    std::erase_if(pending_, [&](const Pending& p) { return p.client == event.from; });
    host_.gone(event.from);
    return;
  }
  here_.insert(event.from);
  json id;
  try {
    const Request request = read_request(*event.line, id);
    Answer answer = act(request, event.from);
    if (answer.later) {
      pending_.push_back({event.from, id, request.verb->name, std::move(answer.later)});
      return;
    }
    server_.answer(event.from, answer_line(id, answer.now));
    if (request.verb->name == std::string_view("bye")) server_.part_from(event.from);
  } catch (const std::exception& e) {
    server_.answer(event.from, error_line(id, e.what()));
  }
}

Answer Remote::act(const Request& request, Client client) {
  const std::string_view verb = request.verb->name;
  const Keys keys(request);
  if (verb == "hello") return hello();
  if (verb == "get") return get(keys);
  if (verb == "set") return set(keys, client);
  if (verb == "row") return newest(keys);
  if (verb == "follow") return follow(keys, client);
  if (verb == "bye") return json::object();
  const auto found = host_.actions.find(std::string(verb));
  if (found != host_.actions.end()) return found->second(keys, client);
  throw RemoteError(fmt::format("{}: needs a window; `limpid --listen` opens a window", verb));
}

// Answers earlier requests that are done, or have failed, by now.
void Remote::follow_up() {
  std::vector<Pending> left;
  for (Pending& p : std::exchange(pending_, {})) {
    try {
      if (const auto done = p.later()) {
        server_.answer(p.client, answer_line(p.id, *done));
      } else {
        left.push_back(std::move(p));
      }
    } catch (const std::exception& e) {
      server_.answer(p.client, error_line(p.id, e.what()));
    }
  }
  pending_.insert(pending_.begin(), std::make_move_iterator(left.begin()),
                  std::make_move_iterator(left.end()));
}

// Tells the trouble to each client once; clients without room are told later.
void Remote::tell_trouble() {
  if (std::string now = host_.trouble(); now != trouble_) {
    trouble_ = std::move(now);
    untold_ = trouble_.empty() ? std::set<Client>() : here_;
  }
  if (untold_.empty()) return;
  const std::string line = json_line({{"event", "trouble"}, {"error", trouble_}});
  std::erase_if(untold_, [&](Client client) { return server_.offer(client, line); });
}

json Remote::hello() const {
  json all = json::object();
  for (const Verb& verb : verbs()) {
    const bool own = host_.actions.contains(verb.name);
    const bool here = std::ranges::count(
        std::array<std::string_view, 6>{"hello", "get", "set", "row", "follow", "bye"}, verb.name);
    if (own || here) all[verb.name] = verb.help;
  }
  return {{"program", "limpid"},
          {"version", program_version()},
          {"protocol", kProtocol},
          {"kind", host_.kind},
          {"verbs", all}};
}

json Remote::get(const Keys& keys) const {
  const auto wanted = keys.texts_if("keys", kMostSettings);
  std::vector<json> lanes(host_.lanes(), json::object());
  const auto add = [&](const ParameterInfo& info) {
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      lanes[i][info.key] = json_of(value_of(info, host_.parameters(i)));
    }
  };
  if (wanted) {
    for (const std::string& key : *wanted) {
      const ParameterInfo* info = find_parameter(key);
      if (info == nullptr) throw keys.error("keys", shown(key) + " is not a setting");
      add(*info);
    }
  } else {
    for (const ParameterInfo& info : parameter_table()) add(info);
  }
  json answer{{"values", lanes[kMainLane]}, {"state", host_.state()}};
  for (std::size_t i = 1; i < lanes.size(); ++i) answer[lane_name(i)] = lanes[i];
  return answer;
}

json Remote::set(const Keys& keys, Client client) {
  const bool of_twin = keys.flag_or("twin", false);
  const std::size_t lane = asked_lane(keys, of_twin ? kTwinLane : kMainLane);
  if (of_twin && lane != kTwinLane) {
    throw keys.error("lane", "contradicts \"twin\": true; the twin is lane 1");
  }
  const bool reset = keys.flag_or("reset", false);
  if (lane >= host_.lanes()) {
    throw keys.error(keys.has("lane") ? "lane" : "twin", "there is no such run");
  }
  const auto changed = [&] {
    Parameters p = host_.parameters(lane);
    if (reset) p = host_.usual();
    set_values(p, keys, lane, host_.highest());
    return p;
  };
  changed();  // throws before anything changes
  host_.before_set(client);
  const Parameters p = changed();
  host_.set(p, lane);
  json now = json::object();
  for (const auto& [key, value] : keys.of("values").items()) {
    now[key] = json_of(value_of(*find_parameter(key), p));
  }
  return {{"values", now}};
}

std::vector<Remote::Wanted> Remote::find(const std::vector<std::string>& names,
                                         const std::string& verb) const {
  const TraceChannels& channels = host_.channels();
  std::vector<Wanted> found;
  for (const std::string& name : names) {
    std::string of_lane = name;
    const std::size_t lane = lane_in(of_lane);
    const auto channel = LiveChannel::find(channels, of_lane);
    if (!channel) {
      throw RemoteError(fmt::format("{}: channels: {} is no channel of this arm and scene; {}",
                                    verb, shown(name), channel_hint(channels, name)));
    }
    found.push_back({*channel, lane});
  }
  return found;
}

json Remote::newest(const Keys& keys) const {
  const TraceChannels& channels = host_.channels();
  const auto rows = host_.rows();
  if (rows.empty()) throw RemoteError("row: the loop has not run a tick yet");
  std::vector<LiveRow> lanes;
  for (std::size_t i = 0; i < rows.size(); ++i) lanes.emplace_back(channels, rows[i], i);
  json all = json::object();
  if (const auto names = keys.texts_if("channels", kMostSettings)) {
    const auto wanted = find(*names, "row");
    for (std::size_t i = 0; i < names->size(); ++i) {
      const std::size_t lane = wanted[i].lane;
      if (lane >= lanes.size()) {
        throw RemoteError(fmt::format("row: channels: {}: there is no {}", shown((*names)[i]),
                                      lane == kTwinLane ? "twin" : "third run"));
      }
      all[(*names)[i]] = wanted[i].channel.value(channels, lanes[lane]);
    }
  } else {
    const std::vector<double>& values = lanes[kMainLane].values;
    for (std::size_t i = 0; i < values.size(); ++i) {
      all[channels.infos()[i].key] = number(values[i]);
    }
  }
  const double time = channels.layout().in(rows[kMainLane], Column::time)[0];
  return {{"tick", host_.tick()}, {"time", time}, {"values", all}};
}

json Remote::follow(const Keys& keys, Client client) {
  const double tick = host_.parameters(kMainLane).tick;
  const auto names = keys.texts_if("channels", kMostChannels);
  const double rate = keys.number_or("rate", std::min(kUsualRate, 1 / tick), 0.1, 1 / tick);
  if (!names || names->empty()) {
    followers_.erase(client);
    return {{"channels", json::array()}};
  }
  Follower follower;
  follower.names = *names;
  follower.wanted = find(*names, "follow");
  follower.every = static_cast<std::uint64_t>(std::max(1LL, std::llround(1 / (rate * tick))));
  json units = json::array();
  for (const Wanted& w : follower.wanted) {
    units.push_back(w.channel.unit(host_.channels()));
  }
  json answer{{"channels", *names}, {"units", units}, {"every", follower.every}, {"tick", tick}};
  followers_[client] = std::move(follower);
  return answer;
}

void Remote::row(LaneRows rows, std::uint64_t tick) {
  const TraceChannels& channels = host_.channels();
  std::vector<std::optional<LiveRow>> lanes;  // worked out once somebody follows them
  for (auto& [client, f] : followers_) {
    if (tick % f.every != 0) continue;
    for (std::size_t i = lanes.size(); i < kMostLanes; ++i) {
      auto& lane = lanes.emplace_back();
      if (runs(rows, i)) lane.emplace(channels, rows[i], i);
    }
    if (f.last && tick > *f.last) f.dropped += (tick - *f.last) / f.every - 1;
    f.last = tick;
    json each = json::array({tick});
    for (const Wanted& w : f.wanted) {
      const auto& lane = lanes[w.lane];
      each.push_back(lane ? w.channel.value(channels, *lane) : json());
    }
    f.rows.push_back(std::move(each));
    if (f.rows.size() >= kRowsInALine) flush(client, f);
  }
}

void Remote::flush(Client client, Follower& f) {
  if (f.rows.empty()) return;
  const std::size_t count = f.rows.size();
  json message{{"rows", std::exchange(f.rows, json::array())}, {"dropped", f.dropped}};
  if (!server_.offer(client, json_line(message))) f.dropped += count;
}

void Remote::reopened() {
  for (auto each = followers_.begin(); each != followers_.end();) {
    Follower& f = each->second;
    f.last.reset();
    try {
      f.wanted = find(f.names, "follow");
      ++each;
    } catch (const std::exception& e) {
      server_.offer(each->first, error_line(nullptr, e.what()));
      each = followers_.erase(each);
    }
  }
}

}  // namespace limpid
