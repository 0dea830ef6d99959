// Answers what programs on the control socket ask for, on the thread that owns the loop.
//
// What a verb does is said by whoever has the loop, the window or `limpid serve`: there it is what
// menus and keys do. Here are the verbs that are the same everywhere, and the rows that clients
// follow.
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

// What an action answers: at once, or later. `later` is asked in every turn until it has something
// to say, or throws.
struct Answer {
  using Later = std::function<std::optional<nlohmann::json>()>;

  nlohmann::json now;
  Later later = nullptr;

  Answer(nlohmann::json at_once) : now(std::move(at_once)) {}  // NOLINT: that is what it is
  Answer(Later in_time) : later(std::move(in_time)) {}         // NOLINT
};

// What the loop's owner has and does. Errors of all of them: any std::exception, whose what() the
// client gets.
struct RemoteHost {
  using Action = std::function<Answer(const Keys& keys, LineServer::Client client)>;

  std::string kind;  // "window" or "serve"
  std::function<nlohmann::json()> state;
  std::function<const Parameters&()> parameters;
  std::function<const Parameters*()> twin;  // null: there is none
  // What a person has chosen, as with_limits_of() has it.
  std::function<Parameters()> highest;
  // Before this client sets anything: ends what has put other settings in their place for a while.
  std::function<void(LineServer::Client)> before_set = [](LineServer::Client) {};
  // All settings as they usually are for the arm, as far as they can be so while the loop runs.
  std::function<Parameters()> usual = [] { return Parameters{}; };
  // The whole of them; the second run's where `of_twin`.
  std::function<void(const Parameters&, bool of_twin)> set;
  std::function<const TraceChannels&()> channels;
  std::function<std::span<const double>()> row, twin_row;  // empty: none
  std::function<std::uint64_t()> tick;                     // of the newest row
  // By the names of their verbs; those that are missing need a window.
  std::map<std::string, Action> actions;
  // Trouble that came by itself and lasts, in words, as a recording that has ended on a full disk;
  // empty: none. Every client is told at once.
  std::function<std::string()> trouble = [] { return std::string(); };
  std::function<void(LineServer::Client)> gone = [](LineServer::Client) {};
};

// What a state says of the loop, whoever has it.
nlohmann::json loop_state(const LiveLoop& loop, const ArmDescription& arm);

// The text of a mark. Errors: RemoteError for one that is missing, or longer than sessions keep.
std::string noted(const Keys& keys);

class Remote {
 public:
  static constexpr std::size_t kMostChannels = 64;  // that a client follows
  static constexpr double kUsualRate = 100;         // [rows/s]

  Remote(const std::filesystem::path& path, RemoteHost host, std::function<void()> cut);

  // Once a turn of the owner: does what was asked for, and says what has come of what was asked
  // for before. True if anything was asked for.
  bool turn();
  // Another row, the twin's beside it (or empty), and which tick it is.
  void row(std::span<const double> row, std::span<const double> twin, std::uint64_t tick);
  // Rows are others from now on, with other channels.
  void reopened();
  // Returns when something was asked for, or at that time.
  void wait_until(std::chrono::steady_clock::time_point end) { server_.wait_until(end); }
  const std::filesystem::path& path() const { return server_.path(); }
  std::size_t clients() const { return server_.clients(); }

 private:
  using Client = LineServer::Client;

  struct Wanted {
    LiveChannel channel;
    bool of_twin = false;
  };
  struct Follower {
    std::vector<std::string> names;
    std::vector<Wanted> wanted;
    std::uint64_t every = 1;  // ticks
    std::optional<std::uint64_t> last;
    std::uint64_t dropped = 0;  // rows that were due
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
  std::set<Client> here_, untold_;  // who has asked for anything; who does not know `trouble_` yet
  std::string trouble_;
  std::vector<double> values_, twin_values_;
  LineServer server_;  // last: it goes first
};

}  // namespace limpid
