#include "devices/vendor/vendor_server.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "core/base/descriptor.h"
#include "core/base/listening_socket.h"
#include "core/realtime/realtime.h"
#include "devices/hid/raw_device.h"
#include "devices/vendor/servo.h"

namespace limpid {
namespace {

constexpr std::size_t kJoints = 3;
constexpr double kFastest = 5;                                    // of the tip along an axis [m/s]
constexpr nanoseconds kBetween = std::chrono::microseconds(700);  // least time between readings
constexpr nanoseconds kLastFrame = std::chrono::milliseconds(50);
constexpr unsigned kLongestClose = 2;  // [s]; then the process ends as it is
constexpr int kGlance = 5;             // [ms]
constexpr int kMostPackets = 64;       // taken in a turn
constexpr int kHangs = 3;              // status of a process whose library does not return

sigset_t ends() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int each : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&signals, each);
  return signals;
}

int listen_on(const std::string& path) {
  if (constexpr std::size_t kRoom = sizeof(sockaddr_un::sun_path); path.size() >= kRoom) {
    throw VendorError(
        fmt::format("{}: a socket's path has at most {} characters", path, kRoom - 1));
  }
  const int file = listen_under(path, SOCK_SEQPACKET, 1);
  if (file < 0) throw VendorError(fmt::format("{}: {}", path, std::strerror(errno)));
  return file;
}

RawDescription description_of(const VendorTraits& traits) {
  RawDescription description;
  description.name = traits.name;
  description.made_by = traits.made_by;
  description.pushes = true;
  description.watchdog = static_cast<std::uint16_t>(
      std::chrono::duration_cast<std::chrono::milliseconds>(Servo::kForceLife).count());
  for (std::size_t i = 0; i < kJoints; ++i) {
    description.joints.push_back({.slides = true,
                                  .lower = traits.lower[i],
                                  .upper = traits.upper[i],
                                  .resolution = traits.resolution,
                                  .effort = traits.force,
                                  .speed = kFastest});
  }
  return description;
}

class Server {
 public:
  Server(const VendorTraits& traits, const ServerPlace& place)
      : signals_([] {
          const sigset_t which = ends();
          return ::signalfd(-1, &which, SFD_CLOEXEC | SFD_NONBLOCK);
        }()),
        news_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
        listener_(place.socket.empty() ? -1 : listen_on(place.socket)),
        path_(place.socket),
        handed_over_(place.connection >= 0),
        connection_(-1),
        feature_(raw_feature(description_of(traits))),
        servo_(traits.force, *news_) {
    if (handed_over_) connect(place.connection);
  }
  ~Server() {
    hang_up();
    if (!path_.empty()) ::unlink(path_.c_str());
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  void run(VendorBackEnd& device) {
    device.begin(servo_);
    began_ = monotonic_now();
    while (!servo_.ended() && turn()) {
    }
    servo_.end();
    await_last_frame();
    ::alarm(kLongestClose);
    device.end();
    device.close();
    ::alarm(0);
    if (const std::string remark = device.remark(); !remark.empty()) {
      std::fputs(fmt::format("limpid-vendor: {}\n", remark).c_str(), stderr);
    }
    if (!servo_.error().empty()) throw VendorError(servo_.error());
  }

 private:
  // Waits for something to happen, and does it; false at the end.
  bool turn() {
    std::array<pollfd, 4> waits{{{*signals_, POLLIN, 0},
                                 {*news_, POLLIN, 0},
                                 {connection_, POLLIN, 0},
                                 {*listener_, POLLIN, 0}}};
    ::poll(waits.data(), waits.size(), kGlance);
    end_if_it_hangs();
    if ((waits[0].revents & POLLIN) != 0) return false;
    if (waits[2].revents != 0 && !take_commands()) {
      hang_up();
      if (handed_over_) return false;
    }
    if (waits[3].revents != 0) accept();
    std::uint64_t frames = 0;
    if (::read(*news_, &frames, sizeof frames) > 0) tell();
    return true;
  }

  // A library that does not return cannot be asked for anything: the end of the process closes the
  // device, whose own watchdog has to do the rest.
  void end_if_it_hangs() {
    if (monotonic_now() - std::max(servo_.last_frame(), began_) <= Servo::kHang) return;
    std::fputs("limpid-vendor: the maker's library does not return; limpid-vendor ends\n", stderr);
    ::_exit(kHangs);
  }

  void await_last_frame() {
    const nanoseconds until = monotonic_now() + kLastFrame;
    while (!servo_.ended()) {
      if (monotonic_now() > until) {
        std::fputs("limpid-vendor: the maker's library does not return while limpid-vendor ends\n",
                   stderr);
        ::_exit(kHangs);
      }
      pollfd news{*news_, POLLIN, 0};
      ::poll(&news, 1, 1);
    }
  }

  void connect(int file) {
    connection_ = file;
    last_order_ = 0;
    servo_.cut();
    if (::send(file, feature_.data(), feature_.size(), MSG_NOSIGNAL | MSG_DONTWAIT) < 0) hang_up();
  }

  void hang_up() {
    servo_.cut();
    if (connection_ >= 0) ::close(connection_);
    connection_ = -1;
  }

  void accept() {
    const int file = ::accept4(*listener_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (file < 0) return;
    if (connection_ >= 0) {  // one at a time
      ::close(file);
      return;
    }
    connect(file);
  }

  // Takes all commands that wait: after a pause only the newest one counts. False at the end of the
  // connection.
  bool take_commands() {
    std::optional<RawOrder> newest;
    bool stops = false;
    for (int i = 0; i < kMostPackets; ++i) {
      std::array<std::uint8_t, 2 * kRaw2.command> packet{};
      const ssize_t size = ::recv(connection_, packet.data(), packet.size(), MSG_DONTWAIT);
      if (size == 0 || (size < 0 && errno != EAGAIN && errno != EINTR)) return false;
      if (size < 0) break;
      const auto bytes = std::span(packet).first(static_cast<std::size_t>(size));
      const auto order = raw_order(bytes, kJoints, last_order_);
      if (!order) continue;
      last_order_ = order->sequence;
      newest = order;
      stops = stops || order->mode == RawMode::no_torque;
    }
    if (!newest) return true;
    if (stops) servo_.command({}, false);
    if (newest->mode == RawMode::torque) {
      servo_.command({newest->torque[0], newest->torque[1], newest->torque[2]}, true);
    }
    return true;
  }

  // Tells Limpid of the newest frame.
  void tell() {
    Servo::Frame frame;
    if (!servo_.take(frame) || connection_ < 0) return;
    no_force_ = frame.reading.no_force != NoForce::none ? frame.reading.no_force : no_force_;
    const nanoseconds now = monotonic_now();
    if (now - told_ < kBetween) return;
    told_ = now;
    const VendorReading& reading = frame.reading;
    RawState state{.sequence = ++readings_, .answered = last_order_};
    state.time_stamp = static_cast<std::uint64_t>(
        std::chrono::duration_cast<std::chrono::microseconds>(frame.moment).count());
    const auto flag = [&](bool set, std::uint8_t bit) {
      if (set) state.flags = static_cast<std::uint8_t>(state.flags | bit);
    };
    flag(true, RawFlag::power);
    flag(reading.hand, RawFlag::hand);
    flag(reading.calibrated, RawFlag::calibrated);
    flag(reading.fault, RawFlag::fault);
    flag(frame.cut, RawFlag::cut);
    std::copy(reading.x.begin(), reading.x.end(), state.x.begin());
    state.buttons = reading.buttons;
    state.no_force = std::exchange(no_force_, NoForce::none);
    state.warmth = reading.warmth;
    state.orientation = reading.orientation;
    const auto packet = raw_reading(state, kJoints);
    const ssize_t sent =
        ::send(connection_, packet.data(), packet.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && errno != EAGAIN && errno != EINTR) hang_up();
  }

  Descriptor signals_, news_, listener_;
  std::string path_;
  bool handed_over_;
  int connection_;
  std::array<std::uint8_t, kRaw2.feature> feature_;
  Servo servo_;
  nanoseconds began_{}, told_{};
  std::uint32_t last_order_ = 0, readings_ = 0;
  NoForce no_force_ = NoForce::none;  // since the last reading
};

}  // namespace

void hold_signals() {
  const sigset_t which = ends();
  ::pthread_sigmask(SIG_BLOCK, &which, nullptr);
}

void serve(VendorBackEnd& device, const VendorTraits& traits, const ServerPlace& place) {
  become_realtime({});
  Server(traits, place).run(device);
}

}  // namespace limpid
