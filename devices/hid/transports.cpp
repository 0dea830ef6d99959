#include "devices/hid/transports.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <hidapi/hidapi.h>
#include <linux/hidraw.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <optional>
#include <thread>

#include "devices/hid/device_claim.h"
#include "devices/hid/hid_transport.h"
#include "devices/hid/report_descriptor.h"

namespace limpid {

namespace {

constexpr int kFirstPacket = 500;           // longest wait for the first packet [ms]
constexpr int kFirstOfProgram = 40 * 1000;  // of a program that has to open its device first [ms]
constexpr std::chrono::milliseconds kLongestEnd{3000};  // of a program, then it is killed
// Longest silence of a program whose readings had begun; one whose library hangs ends by itself
// before.
constexpr std::chrono::milliseconds kLongestSilence{200};

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

class SocketTransport : public HidTransport {
 public:
  explicit SocketTransport(const std::string& path) : file_(connect_to(path)) {
    if (!take_description(kFirstPacket)) {
      close(file_);
      throw HidError(
          path +
          ": the device's program closes the connection; another program may be using the device");
    }
  }
  SocketTransport(const SocketTransport&) = delete;
  SocketTransport& operator=(const SocketTransport&) = delete;
  ~SocketTransport() override { hang_up(); }

  int read(std::span<std::uint8_t> report, int timeout_ms) noexcept override {
    if (report.size() < 2) return 0;
    ssize_t size = receive(report);
    if (size < 0 && errno == EAGAIN && timeout_ms > 0) {
      pollfd ready{file_, POLLIN, 0};
      poll(&ready, 1, timeout_ms);
      size = receive(report);
    }
    if (size > 0) return static_cast<int>(size) + 1;
    // An empty packet is no report, and cannot be told from the end.
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

 protected:
  explicit SocketTransport(int file) : file_(file) {}

  bool take_description(int timeout_ms) {
    std::array<std::uint8_t, kMaxReport> first{};
    const int size = read(first, timeout_ms);
    if (size < 0) return false;
    feature_.assign(first.begin(), first.begin() + size);
    return true;
  }
  const std::vector<std::uint8_t>& description() const { return feature_; }
  void hang_up() {
    if (file_ >= 0) close(file_);
    file_ = -1;
  }

 private:
  // Receives behind the id, which is 0, as nobody numbers packets.
  ssize_t receive(std::span<std::uint8_t> report) const noexcept {
    report[0] = 0;
    return recv(file_, report.data() + 1, report.size() - 1, 0);
  }

  int file_;
  std::vector<std::uint8_t> feature_, no_descriptor_;
};

// A socket whose other end is a program of ours.
class ProgramTransport final : public SocketTransport {
 public:
  ProgramTransport(std::unique_ptr<Child> child, int file, char refusal)
      : SocketTransport(file), child_(std::move(child)) {
    const bool came = take_description(kFirstOfProgram);
    const std::vector<std::uint8_t>& first = description();
    if (came && first.size() > 2 && first[1] == static_cast<std::uint8_t>(refusal)) {
      throw HidError(std::string(first.begin() + 2, first.end()));
    }
    if (!came || first.empty()) {
      throw HidError("the program that controls the device does not answer");
    }
    described_ = true;
  }
  ~ProgramTransport() override {
    hang_up();
    child_->end_within(kLongestEnd);
  }

  // A program that was stopped leaves its motors at what they were last told. Its end closes the
  // device, which is then gone.
  int read(std::span<std::uint8_t> report, int timeout_ms) noexcept override {
    const int size = SocketTransport::read(report, timeout_ms);
    const auto now = std::chrono::steady_clock::now();
    if (size > 0 && described_) heard_ = now;
    if (size != 0 || !heard_ || now - *heard_ <= kLongestSilence) return size;
    child_->kill();
    return -1;
  }

 private:
  bool described_ = false;
  std::optional<std::chrono::steady_clock::time_point> heard_;  // a reading
  std::unique_ptr<Child> child_;
};

[[noreturn]] void refuse(const std::string& path) {
  throw HidError(fmt::format("{}: {}", path, std::strerror(errno)));
}

// Reads a report descriptor, for which hidapi 0.13 has no call.
std::vector<std::uint8_t> read_descriptor(const std::string& path) {
  const int file = open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (file < 0) refuse(path);
  int size = 0;
  hidraw_report_descriptor descriptor{};
  bool got = ioctl(file, HIDIOCGRDESCSIZE, &size) >= 0;
  if (got) {
    descriptor.size = static_cast<std::uint32_t>(std::clamp(size, 0, HID_MAX_DESCRIPTOR_SIZE));
    got = ioctl(file, HIDIOCGRDESC, &descriptor) >= 0;
  }
  const int error = errno;
  close(file);
  errno = error;
  if (!got) refuse(path);
  return {descriptor.value, descriptor.value + descriptor.size};
}

struct CloseHid {
  void operator()(hid_device* device) const { hid_close(device); }
};
using Handle = std::unique_ptr<hid_device, CloseHid>;

// hidapi keeps its errors in one place for all threads. Null: not opened.
Handle opened(const std::string& path) {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  return Handle(hid_open_path(path.c_str()));
}

constexpr auto kBeforeAnotherTry = std::chrono::milliseconds(100);

// Asks for input reports by a thread and a handle of its own, as a device that hangs lets a
// question wait for seconds. Nobody waits for that thread either: it shares what it needs and ends
// when the kernel has given up.
class Questions {
 public:
  explicit Questions(std::string path) : path_(std::move(path)) {}
  Questions(const Questions&) = delete;
  Questions& operator=(const Questions&) = delete;
  ~Questions() {
    if (!shared_) return;
    const std::lock_guard lock(shared_->mutex);
    shared_->quit = true;
    shared_->changed.notify_one();
  }

  void ask(std::span<const std::uint8_t> question) noexcept {
    if (!shared_ && !start()) return;
    const std::lock_guard lock(shared_->mutex);
    if (shared_->busy) return;
    shared_->busy = true;
    shared_->report.assign(question.begin(), question.end());
    shared_->changed.notify_one();
  }

  // Takes the answer. Returns its size, or 0 if it has not come.
  int take(std::span<std::uint8_t> report) noexcept {
    if (!shared_) return 0;
    const std::lock_guard lock(shared_->mutex);
    if (!shared_->answered) return 0;
    const std::size_t size = std::min(shared_->report.size(), report.size());
    std::copy_n(shared_->report.begin(), size, report.begin());
    shared_->busy = shared_->answered = false;
    return static_cast<int>(size);
  }

 private:
  struct Shared {
    std::mutex mutex;
    std::condition_variable changed;
    std::vector<std::uint8_t> report;  // the question, then its answer
    bool busy = false, answered = false, quit = false;
  };

  // Starts the thread from the thread that asks first, whose priority it takes over.
  bool start() noexcept {
    try {
      const auto shared = std::make_shared<Shared>();
      std::thread([shared, path = path_] { answer(*shared, path); }).detach();
      shared_ = shared;
    } catch (const std::exception&) {
      return false;
    }
    return true;
  }

  // Opens the device at a question, and again at the next one where that was refused.
  static void answer(Shared& shared, const std::string& path) {
    Handle device;
    std::unique_lock lock(shared.mutex);
    while (true) {
      shared.changed.wait(lock, [&] { return shared.quit || (shared.busy && !shared.answered); });
      if (shared.quit) return;
      std::vector<std::uint8_t> report = shared.report;
      lock.unlock();
      if (!device) device = opened(path);
      if (!device) std::this_thread::sleep_for(kBeforeAnotherTry);
      const int size =
          device ? hid_get_input_report(device.get(), report.data(), report.size()) : 0;
      lock.lock();
      shared.busy = shared.answered = size > 0;
      report.resize(std::min(static_cast<std::size_t>(std::max(size, 0)), report.size()));
      shared.report = std::move(report);
    }
  }

  std::string path_;
  std::shared_ptr<Shared> shared_;
};

class HidapiTransport final : public HidTransport {
 public:
  explicit HidapiTransport(const std::string& path)
      : claim_(DeviceClaim::on_node(path)),
        descriptor_(read_descriptor(path)),
        numbered_(parse_report_descriptor(descriptor_).numbered),
        device_(opened(path)),
        questions_(path) {
    if (!device_) refuse(path);
  }

  int read(std::span<std::uint8_t> report, int timeout_ms) noexcept override {
    // The kernel gives no id if the device numbers none.
    const std::size_t skipped = numbered_ ? 0 : 1;
    if (report.size() <= skipped) return 0;
    if (const int answer = questions_.take(report)) return answer;
    if (!numbered_) report[0] = 0;
    const int size = hid_read_timeout(device_.get(), report.data() + skipped,
                                      report.size() - skipped, timeout_ms);
    return size > 0 ? size + static_cast<int>(skipped) : size;
  }

  bool write(std::span<const std::uint8_t> report) noexcept override {
    return hid_write(device_.get(), report.data(), report.size()) >= 0;
  }

  int get_feature(std::span<std::uint8_t> report) noexcept override {
    return hid_get_feature_report(device_.get(), report.data(), report.size());
  }

  void ask(std::span<const std::uint8_t> question) noexcept override { questions_.ask(question); }

  bool set_feature(std::span<const std::uint8_t> report) noexcept override {
    return hid_send_feature_report(device_.get(), report.data(), report.size()) >= 0;
  }

  const std::vector<std::uint8_t>& report_descriptor() const override { return descriptor_; }

  std::uint16_t vendor() const override {
    const hid_device_info* info = hid_get_device_info(device_.get());
    return info != nullptr ? info->vendor_id : std::uint16_t{0};
  }

  std::string id() const override {
    const hid_device_info* info = hid_get_device_info(device_.get());
    if (info == nullptr) return {};
    const std::wstring serial = info->serial_number != nullptr ? info->serial_number : L"";
    std::string id = fmt::format("{:04x}:{:04x}{}", info->vendor_id, info->product_id,
                                 serial.empty() ? "" : ":");
    for (const wchar_t c : serial) {
      if (c < 0 || c > 127) return {};  // else its meaning depends on the locale
      id.push_back(static_cast<char>(c));
    }
    return id;
  }

 private:
  DeviceClaim claim_;
  std::vector<std::uint8_t> descriptor_;
  bool numbered_;
  Handle device_;
  Questions questions_;
};

}  // namespace

std::unique_ptr<HidTransport> open_socket(const std::string& path) {
  return std::make_unique<SocketTransport>(path);
}

std::unique_ptr<HidTransport> open_socket_of(std::unique_ptr<Child> child, int file, char refusal) {
  return std::make_unique<ProgramTransport>(std::move(child), file, refusal);
}

std::unique_ptr<HidTransport> open_hidraw(const std::string& path) {
  return std::make_unique<HidapiTransport>(path);
}

}  // namespace limpid
