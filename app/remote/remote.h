// Answers requests on the control socket, on the thread that owns the loop. The loop's owner, the
// window or `limpid serve`, carries out its own verbs as its menus and keys do. Here are the verbs
// common to both, and the rows that clients follow.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/live/live_loop.h"
#include "app/plot/trace_channels.h"
#include "app/remote/line_server.h"
#include "app/remote/live_channels.h"
#include "app/remote/protocol.h"
#include "core/tick/parameters.h"

namespace limpid {

// Answer of an action: at once, or later. `later` is called every turn until it returns an answer,
// or throws.
struct Answer {
  using Later = std::function<std::optional<nlohmann::json>()>;

  nlohmann::json now;
  Later later = nullptr;

  Answer(nlohmann::json at_once) : now(std::move(at_once)) {}  // NOLINT: that is what it is
  Answer(Later in_time) : later(std::move(in_time)) {}         // NOLINT
};

// The loop's owner: its state and actions. Errors of all functions: any std::exception; the client
// receives its what().
struct RemoteHost {
  using Action = std::function<Answer(const Keys& keys, LineServer::Client client)>;

  std::string kind;  // "window" or "serve"
  std::function<nlohmann::json()> state;
  std::function<std::size_t()> lanes;                             // that run
  std::function<const Parameters&(std::size_t lane)> parameters;  // of a lane that runs
  // Highest limits allowed to clients: a person's choice, by with_limits_of().
  std::function<Parameters()> highest;
  // Called before this client sets anything: ends a temporary replacement of the settings.
  std::function<void(LineServer::Client)> before_set = [](LineServer::Client) {};
  // The arm's usual settings, as far as they can change while the loop runs.
  std::function<Parameters()> usual = [] { return Parameters{}; };
  // Sets all settings of a lane that runs.
  std::function<void(const Parameters&, std::size_t lane)> set;
  std::function<const TraceChannels&()> channels;
  std::function<std::vector<std::span<const double>>()> rows;  // of the lanes that run; or none
  std::function<std::uint64_t()> tick;                         // of the newest rows
  // Actions by verb; missing verbs need a window.
  std::map<std::string, Action> actions;
  // A lasting trouble in words, such as a recording that ended on a full disk; empty: none. Every
  // client is told at once.
  std::function<std::string()> trouble = [] { return std::string(); };
  std::function<void(LineServer::Client)> gone = [](LineServer::Client) {};
};

// The loop's part of a state, the same for every owner.
nlohmann::json loop_state(const LiveLoop& loop, const ArmDescription& arm);

// Returns the lane that a request names. Errors: RemoteError for what is no lane's number.
std::size_t asked_lane(const Keys& keys, std::size_t usual);

// Refuses a lane for the verb "twin" that is the first, or not beside one of the `lanes` that run.
// Errors: RemoteError.
void check_beside(const Keys& keys, std::size_t lane, std::size_t lanes);

// Text of a mark. Errors: RemoteError if it is missing, or longer than sessions allow.
std::string noted(const Keys& keys);

class Remote {
 public:
  static constexpr std::size_t kMostChannels = 64;  // most channels a client follows
  static constexpr double kUsualRate = 100;         // [rows/s]

  Remote(const std::filesystem::path& path, RemoteHost host, std::function<void()> cut);

  // Answers requests, new ones and those answered later. Call it once a turn of the owner. True if
  // there were new requests.
  bool turn();
  // Passes on the rows of a tick, and its number. Rows of lanes that do not run are missing or
  // begin with NaN.
  void row(LaneRows rows, std::uint64_t tick);
  // From now on rows and channels are of another world.
  void reopened();
  // Returns at the next request, or at `end`.
  void wait_until(std::chrono::steady_clock::time_point end) { server_.wait_until(end); }
  const std::filesystem::path& path() const { return server_.path(); }
  std::size_t clients() const { return server_.clients(); }

 private:
  using Client = LineServer::Client;

  struct Wanted {
    LiveChannel channel;
    std::size_t lane = kMainLane;
  };
  struct Follower {
    std::vector<std::string> names;
    std::vector<Wanted> wanted;
    std::uint64_t every = 1;  // ticks
    std::optional<std::uint64_t> last;
    std::uint64_t dropped = 0;  // due rows that were dropped
    nlohmann::json rows = nlohmann::json::array();
  };
  struct Pending {
    Client client;
    nlohmann::json id;
    std::string verb;
    Answer::Later later;
  };

  void take(const LineServer::Event& event);
  Answer act(const Request& request, Client client);
  nlohmann::json hello() const;
  nlohmann::json get(const Keys& keys) const;
  nlohmann::json set(const Keys& keys, Client client);
  nlohmann::json newest(const Keys& keys) const;
  nlohmann::json follow(const Keys& keys, Client client);
  std::vector<Wanted> find(const std::vector<std::string>& names, const std::string& verb) const;
  void follow_up();
  void tell_trouble();
  void flush(Client client, Follower& follower);

  RemoteHost host_;
  std::map<Client, Follower> followers_;
  std::vector<Pending> pending_;
  std::set<Client> here_, untold_;  // all clients; those not told of trouble_
  std::string trouble_;
  LineServer server_;  // last, to be destroyed first
};

}  // namespace limpid
