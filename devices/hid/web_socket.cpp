#include "devices/hid/web_socket.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cstring>
#include <functional>
#include <utility>

#include "devices/hid/hid_transport.h"

namespace limpid {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kWriteTime{2};    // longest time for a message to leave
constexpr std::chrono::milliseconds kCloseTime{100};  // longest time for the other side's goodbye

// A whole message as a client sends it, its mask 0: for a guardian, which has only the descriptor.
Report text_frame(std::span<const std::uint8_t> text) {
  constexpr std::uint8_t kTextAndLast = 0x81, kMasked = 0x80, kTwoBytes = 126;
  Report frame{kTextAndLast};
  if (text.size() < kTwoBytes) {
    frame.push_back(static_cast<std::uint8_t>(kMasked | text.size()));
  } else {
    frame.push_back(kMasked | kTwoBytes);
    frame.push_back(static_cast<std::uint8_t>(text.size() >> 8));
    frame.push_back(static_cast<std::uint8_t>(text.size()));
  }
  frame.insert(frame.end(), 4, 0);
  frame.insert(frame.end(), text.begin(), text.end());
  return frame;
}

// Returns whether an address is this computer's: only such a one can be bound.
bool is_here(const addrinfo& place) {
  const int file = socket(place.ai_family, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (file < 0) return false;
  sockaddr_storage any_port{};
  std::memcpy(&any_port, place.ai_addr, place.ai_addrlen);
  // Both kinds of addresses have the port at the same place.
  reinterpret_cast<sockaddr_in&>(any_port).sin_port = 0;
  const bool here = bind(file, reinterpret_cast<const sockaddr*>(&any_port), place.ai_addrlen) == 0;
  close(file);
  return here;
}

// Transport whose work all happens in the calls below, on the calling thread.
class WebSocketTransport final : public HidTransport {
 public:
  WebSocketTransport(const ServiceAddress& address, std::chrono::milliseconds time) {
    const auto end = Clock::now() + time;
    const auto within = [&](const char* what, bool& done, error_code& error) {
      run_until(end, [&] { return done; });
      if (done && !error) return;
      throw HidError(
          fmt::format("{}: {}{}", address.text(), what, done ? error.message() : "no answer"));
    };
    error_code error;
    asio::ip::tcp::resolver resolver(context_);
    const auto places = resolver.resolve(address.host, address.port, error);
    if (error) throw HidError(fmt::format("{}: {}", address.text(), error.message()));
    bool done = false;
    const auto finish = [&](error_code e, auto&&...) {
      error = e;
      done = true;
    };
    try {
      stream_.next_layer().async_connect(places, finish);
      within("", done, error);
      stream_.next_layer().socket().set_option(asio::ip::tcp::no_delay(true));
      stream_.read_message_max(kMaxMessage - 1);
      done = false;
      stream_.async_handshake(address.text(), "/", finish);
      within("it is no WebSocket: ", done, error);
    } catch (...) {
      abandon();
      throw;
    }
    stream_.text(true);
    listen();
  }
  WebSocketTransport(const WebSocketTransport&) = delete;
  WebSocketTransport& operator=(const WebSocketTransport&) = delete;
  ~WebSocketTransport() override {
    bool closed = lost_ || writing_;
    if (!closed) {
      stream_.async_close(websocket::close_code::normal, [&](error_code) { closed = true; });
    }
    run_until(Clock::now() + kCloseTime, [&] { return closed; });
    abandon();
  }

  int read(std::span<std::uint8_t> report, int timeout_ms) noexcept override {
    if (report.size() < 2) return 0;
    if (!arrived_) {
      run_until(Clock::now() + std::chrono::milliseconds(timeout_ms),
                [this] { return arrived_ || lost_; });
    }
    if (!arrived_) return lost_ ? -1 : 0;
    const auto bytes = incoming_.cdata();
    const std::size_t size = std::min(bytes.size(), report.size() - 1);
    report[0] = 0;
    std::copy_n(static_cast<const std::uint8_t*>(bytes.data()), size, report.begin() + 1);
    incoming_.clear();
    listen();
    return static_cast<int>(size) + 1;
  }

  bool write(std::span<const std::uint8_t> report) noexcept override {
    if (lost_ || writing_) return false;  // the message before has not left yet
    outgoing_.assign(report.begin() + 1, report.end());
    writing_ = true;
    stream_.async_write(asio::buffer(outgoing_), [this](error_code error, std::size_t) {
      writing_ = false;
      lost_ = lost_ || error;
    });
    run_until(Clock::now() + kWriteTime, [this] { return !writing_; });
    return !writing_ && !lost_;
  }

  LastWords last_words(std::span<const Report> reports) override {
    LastWords words{fcntl(stream_.next_layer().socket().native_handle(), F_DUPFD_CLOEXEC, 0), {}};
    for (const Report& report : reports) {
      words.bytes.push_back(text_frame(std::span(report).subspan(1)));
    }
    return words;
  }

  int get_feature(std::span<std::uint8_t>) noexcept override { return -1; }
  bool set_feature(std::span<const std::uint8_t>) noexcept override { return false; }
  void ask(std::span<const std::uint8_t>) noexcept override {}
  const std::vector<std::uint8_t>& report_descriptor() const override { return no_descriptor_; }

 private:
  // Runs handlers until the condition holds or the time is up; at least once.
  template <class Condition>
  void run_until(Clock::time_point end, const Condition& condition) noexcept {
    context_.restart();
    context_.poll();
    while (!condition()) {
      context_.restart();
      if (Clock::now() >= end || context_.run_one_until(end) == 0) return;
    }
  }

  void listen() {
    arrived_ = false;
    stream_.async_read(incoming_, [this](error_code error, std::size_t) {
      arrived_ = !error;
      lost_ = lost_ || error;
    });
  }

  // Runs the handlers that are left while what they refer to still exists.
  void abandon() noexcept {
    error_code ignored;
    stream_.next_layer().socket().close(ignored);
    context_.restart();
    context_.run();
  }

  asio::io_context context_{1};
  websocket::stream<beast::tcp_stream> stream_{context_};
  beast::flat_buffer incoming_;
  std::vector<std::uint8_t> outgoing_, no_descriptor_;
  bool arrived_ = false;
  bool writing_ = false;
  bool lost_ = false;
};

}  // namespace

std::string resolved(const ServiceAddress& address) {
  addrinfo wanted{};
  wanted.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (getaddrinfo(address.host.c_str(), address.port.c_str(), &wanted, &found) != 0) {
    return address.text();
  }
  // The least of several addresses, since their order changes.
  std::string least;
  for (const addrinfo* place = found; place != nullptr; place = place->ai_next) {
    std::array<char, NI_MAXHOST> text{};
    if (getnameinfo(place->ai_addr, place->ai_addrlen, text.data(), text.size(), nullptr, 0,
                    NI_NUMERICHOST) != 0) {
      continue;
    }
    if (is_here(*place)) {
      least = "here";
      break;
    }
    if (least.empty() || text.data() < least) least = text.data();
  }
  freeaddrinfo(found);
  return fmt::format("{}:{}", least.empty() ? address.host : least, address.port);
}

std::unique_ptr<HidTransport> open_web_socket(const ServiceAddress& address, int timeout_ms) {
  return std::make_unique<WebSocketTransport>(address, std::chrono::milliseconds(timeout_ms));
}

}  // namespace limpid
