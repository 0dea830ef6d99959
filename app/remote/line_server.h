// Lines of text between this program and clients on a local socket, on a thread of its own.
// Whatever a client does or fails to do costs only its own connection: its queues are bounded, and
// nothing here waits for it. The haptic thread has no part in this.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>

namespace limpid {

// Thrown if a socket cannot be opened; what() says why, for people.
struct ListenError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// $XDG_RUNTIME_DIR/limpid/NAME.control. Errors: ListenError if the name has other characters than
// letters, digits, - and _, or more than 64; or if that folder is not set.
std::filesystem::path control_path(const std::string& name);

// A listening socket and its lock. One program has a name at a time; the socket of a killed program
// is taken over.
class ControlSocket {
 public:
  // Gives the folder mode 0700, the socket 0600. Errors: ListenError; it names the program that has
  // the name.
  explicit ControlSocket(const std::filesystem::path& path);
  ~ControlSocket();
  ControlSocket(const ControlSocket&) = delete;
  ControlSocket& operator=(const ControlSocket&) = delete;

  int file() const { return file_; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int lock_ = -1, file_ = -1;
};

class LineServer {
 public:
  using Client = std::uint64_t;  // number of a client, never used again

  static constexpr std::size_t kMostClients = 16;
  static constexpr std::size_t kLongestLine = std::size_t{64} << 10;  // [bytes]
  static constexpr std::size_t kMostUnanswered = 16;                  // lines of one client
  // No further line of a client is taken while more than this is unsent [bytes].
  static constexpr std::size_t kMostUnsent = std::size_t{256} << 10;
  // Room for lines that wait to be taken; further lines are dropped, and the client learns their
  // number [bytes].
  static constexpr std::size_t kMostWaiting = std::size_t{256} << 10;
  static constexpr std::chrono::milliseconds kParting{1000};  // time for a client to take the rest

  // A line of a client, or the end of its connection.
  struct Event {
    Client from = 0;
    std::optional<std::string> line;  // none: the client is gone
  };

  // `at_once` receives every line on the server's thread as soon as it arrives, also lines that
  // wait or are dropped. Errors: as ControlSocket.
  explicit LineServer(const std::filesystem::path& path,
                      std::function<void(std::string_view line)> at_once = {});
  ~LineServer();
  LineServer(const LineServer&) = delete;
  LineServer& operator=(const LineServer&) = delete;

  const std::filesystem::path& path() const { return socket_.path(); }
  std::size_t clients() const;

  // For the owner's thread, like all below. The oldest event, if any.
  std::optional<Event> take();
  // Returns at the next event, or at `end`.
  void wait_until(std::chrono::steady_clock::time_point end);
  // Answers a line that was taken. Every line needs an answer; further lines wait for it.
  void answer(Client to, std::string_view line);
  // Sends a line without a request. False if too much is unsent already.
  bool offer(Client to, std::string_view line);
  // Ends the connection once the client has taken what is unsent.
  void part_from(Client client);

 private:
  struct Connection {
    int file = -1;
    std::string in, out;
    std::size_t looked = 0;  // length of the whole lines in `in`, passed to at_once_
    std::size_t unanswered = 0;
    std::size_t dropped = 0;  // lines dropped since the client was last told
    bool too_long = false;    // a line was too long; nothing after it is read
    bool ended = false;       // the client sends nothing more, but may listen
    bool parting = false;
    std::chrono::steady_clock::time_point until{};  // while parting
  };
  using Connections = std::map<Client, Connection>;

  void live();
  void wake() const;
  void greet();
  void serve(Connection& c, Client id, short happened);
  bool read(Connection& c);
  void look(Connection& c);
  void split(Connection& c, Client id);
  void write(Connection& c);
  void part(Connection& c);
  static bool has_room(const Connection& c);
  static bool done(const Connection& c);
  void let_go(Connections::iterator which);

  ControlSocket socket_;
  std::function<void(std::string_view)> at_once_;
  int wake_ = -1;
  mutable std::mutex mutex_;  // guards all below; never held while anybody waits
  std::condition_variable happened_;
  Connections connections_;
  std::deque<Event> events_;
  Client next_ = 1;
  bool quit_ = false;
  std::thread thread_;
};

}  // namespace limpid
