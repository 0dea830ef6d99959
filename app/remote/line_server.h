// Lines of text from and to the programs that are connected to a socket of this computer, on a
// thread of its own.
//
// Whatever a program on the other side does or fails to do costs its own connection and nothing
// else: all that waits for it is bounded, and nothing here ever waits for it. The haptic thread has
// no part in any of this.
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

// A socket that cannot be had; what() says why, for people.
struct ListenError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// $XDG_RUNTIME_DIR/limpid/NAME.control. Errors: ListenError for a name of other characters than
// letters, digits, - and _, of more than 64, or where that folder is not set.
std::filesystem::path control_path(const std::string& name);

// A socket that listens there, and the lock that says so: one program has a name at a time, and
// what one that was killed left behind is taken over.
class ControlSocket {
 public:
  // The folder gets mode 0700, the socket 0600. Errors: ListenError; it says who has the name.
  explicit ControlSocket(const std::filesystem::path& path);
  ~ControlSocket();
  ControlSocket(const ControlSocket&) = delete;
  ControlSocket& operator=(const ControlSocket&) = delete;

  int file() const { return file_; }
  const std::filesystem::path& path() const { return path_; }

 private:
  void listen_at();

  std::filesystem::path path_;
  int lock_ = -1, file_ = -1;
};

class LineServer {
 public:
  using Client = std::uint64_t;  // its number, which no other one gets

  static constexpr std::size_t kMostClients = 16;
  static constexpr std::size_t kLongestLine = std::size_t{64} << 10;  // [bytes]
  static constexpr std::size_t kMostUnanswered = 16;                  // lines of one client
  // Then no further line of the client is taken [bytes].
  static constexpr std::size_t kMostUnsent = std::size_t{256} << 10;
  // Room for lines that wait to be taken; lines beyond it are dropped, and the client is told how
  // many [bytes].
  static constexpr std::size_t kMostWaiting = std::size_t{256} << 10;
  static constexpr std::chrono::milliseconds kParting{1000};  // to take what is left

  // Something that happened: a line came, or the client went.
  struct Event {
    Client from = 0;
    std::optional<std::string> line;  // none: it is gone
  };

  // `at_once` hears of every line on the server's thread as soon as it arrives, also of one that
  // waits or is dropped. Errors: as ControlSocket.
  explicit LineServer(const std::filesystem::path& path,
                      std::function<void(std::string_view line)> at_once = {});
  ~LineServer();
  LineServer(const LineServer&) = delete;
  LineServer& operator=(const LineServer&) = delete;

  const std::filesystem::path& path() const { return socket_.path(); }
  std::size_t clients() const;

  // The owner's. The oldest event, if there is one.
  std::optional<Event> take();
  // Returns when there is one, or at that time.
  void wait_until(std::chrono::steady_clock::time_point end);
  // The answer to a line that was taken; each has to get one, as further lines wait for it.
  void answer(Client to, std::string_view line);
  // What nobody has asked for at this moment. False where too much waits for the client already.
  bool offer(Client to, std::string_view line);
  // Once it has taken what is on its way to it.
  void part_from(Client client);

 private:
  struct Connection {
    int file = -1;
    std::string in, out;
    std::size_t looked = 0;  // so much of `in` is whole lines, of which at_once_ has heard
    std::size_t unanswered = 0;
    std::size_t dropped = 0;  // lines, of which the client was not told yet
    bool too_long = false;    // a line was; nothing after it is read
    bool ended = false;       // says nothing more, but may listen
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
