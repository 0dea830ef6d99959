#include "devices/hid/socket_transport.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "devices/hid/hid_error.h"

namespace limpid {
namespace {

constexpr int kFirstPacket = 500;  // longest wait for it [ms]

int connect_to(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof(address.sun_path)) {
    throw HidError(fmt::format("{}: a socket's path has at most {} characters", path,
                               sizeof(address.sun_path) - 1));
  }
  path.copy(address.sun_path, path.size());
  const int file = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (file >= 0 &&
      connect(file, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0) {
    return file;
  }
  const int error = errno;
  if (file >= 0) close(file);
  const bool busy = error == EAGAIN;
  throw HidError(fmt::format("{}: {}", path,
                             busy ? "another program uses this device" : std::strerror(error)));
}

class SocketTransport final : public HidTransport {
 public:
  explicit SocketTransport(const std::string& path) : file_(connect_to(path)) {
    std::array<std::uint8_t, kMaxReport> first{};
    const int size = read(first, kFirstPacket);
    if (size < 0) {
      close(file_);
      throw HidError(path + ": it hangs up; another program may use it");
    }
    feature_.assign(first.begin(), first.begin() + size);
  }
  SocketTransport(const SocketTransport&) = delete;
  SocketTransport& operator=(const SocketTransport&) = delete;
  ~SocketTransport() override { close(file_); }

  int read(std::span<std::uint8_t> report, int timeout_ms) noexcept override {
    if (report.size() < 2) return 0;
    ssize_t size = receive(report);
    if (size < 0 && errno == EAGAIN && timeout_ms > 0) {
      pollfd ready{file_, POLLIN, 0};
      poll(&ready, 1, timeout_ms);
      size = receive(report);
    }
    if (size > 0) return static_cast<int>(size) + 1;
    // An empty packet is no report; none can be told from the end.
    return size < 0 && (errno == EAGAIN || errno == EINTR) ? 0 : -1;
  }

  bool write(std::span<const std::uint8_t> report) noexcept override {
    const auto packet = report.subspan(1);
    return send(file_, packet.data(), packet.size(), MSG_NOSIGNAL) ==
           static_cast<ssize_t>(packet.size());
  }

  int get_feature(std::span<std::uint8_t> report) noexcept override {
    if (feature_.empty() || feature_.size() > report.size()) return -1;
    std::copy(feature_.begin(), feature_.end(), report.begin());
    return static_cast<int>(feature_.size());
  }

  bool set_feature(std::span<const std::uint8_t>) noexcept override { return false; }
  void ask(std::span<const std::uint8_t>) noexcept override {}
  const std::vector<std::uint8_t>& report_descriptor() const override { return no_descriptor_; }

 private:
  // Behind the id, which is 0: nobody numbers packets.
  ssize_t receive(std::span<std::uint8_t> report) const noexcept {
    report[0] = 0;
    return recv(file_, report.data() + 1, report.size() - 1, 0);
  }

  int file_;
  std::vector<std::uint8_t> feature_, no_descriptor_;
};

}  // namespace

std::unique_ptr<HidTransport> open_socket(const std::string& path) {
  return std::make_unique<SocketTransport>(path);
}

}  // namespace limpid
