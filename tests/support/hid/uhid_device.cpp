#include "tests/support/hid/uhid_device.h"

#include <fcntl.h>
#include <linux/uhid.h>
#include <poll.h>
#include <pthread.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <system_error>

namespace limpid::test {

namespace {

namespace fs = std::filesystem;

// Higher than every thread of the program under test: a real device does not wait for the host.
constexpr int kPriority = 95;
constexpr auto kKernelAnswers = std::chrono::seconds(2);

bool write_event(int file, const uhid_event& event) {
  return write(file, &event, sizeof event) == static_cast<ssize_t>(sizeof event);
}

template <std::size_t N>
void copy_text(const std::string& text, std::uint8_t (&field)[N]) {
  std::snprintf(reinterpret_cast<char*>(field), N, "%s", text.c_str());
}

uhid_event creation(const ReferenceDevice& model) {
  uhid_event event{};
  event.type = UHID_CREATE2;
  uhid_create2_req& create = event.u.create2;
  copy_text(model.identity().name, create.name);
  copy_text(model.identity().serial, create.uniq);
  create.bus = BUS_USB;
  create.vendor = model.identity().vendor;
  create.product = model.identity().product;
  create.rd_size = static_cast<std::uint16_t>(model.report_descriptor().size());
  std::copy(model.report_descriptor().begin(), model.report_descriptor().end(), create.rd_data);
  return event;
}

uhid_event answer_to(const uhid_get_report_req& request, const std::optional<Report>& report) {
  uhid_event event{};
  event.type = UHID_GET_REPORT_REPLY;
  uhid_get_report_reply_req& reply = event.u.get_report_reply;
  reply.id = request.id;
  reply.err = report ? 0 : EIO;
  if (!report) return event;
  reply.size = static_cast<std::uint16_t>(report->size());
  std::copy(report->begin(), report->end(), reply.data);
  return event;
}

}  // namespace

Time steady_now() {
  return std::chrono::duration_cast<Time>(std::chrono::steady_clock::now().time_since_epoch());
}

UhidDevice::UhidDevice(ReferenceDevice& model) : model_(model) {
  file_ = open("/dev/uhid", O_RDWR | O_CLOEXEC | O_NONBLOCK);
  if (file_ < 0) throw std::system_error(errno, std::generic_category(), "/dev/uhid");
  plug();
  thread_ = std::thread([this] { play(); });
  wait_for_path();
}

UhidDevice::~UhidDevice() {
  stop_ = true;
  thread_.join();
  close(file_);
}

void UhidDevice::plug() {
  const std::lock_guard lock(mutex_);
  if (!write_event(file_, creation(model_))) {
    throw std::system_error(errno, std::generic_category(), "the kernel refuses the device");
  }
  model_.power(true, steady_now());
}

void UhidDevice::replug() {
  plug();
  wait_for_path();
}

void UhidDevice::unplug() {
  const std::lock_guard lock(mutex_);
  uhid_event event{};
  event.type = UHID_DESTROY;
  write_event(file_, event);
  model_.power(false, steady_now());
}

void UhidDevice::play() {
  prctl(PR_SET_TIMERSLACK, 1);
  const sched_param priority{kPriority};
  pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority);
  Time deadline = steady_now() + model_.period();
  while (!stop_) {
    const Time left = std::max(deadline - steady_now(), Time::zero());
    const timespec wait{left.count() / 1'000'000'000, left.count() % 1'000'000'000};
    pollfd watched{file_, POLLIN, 0};
    if (ppoll(&watched, 1, &wait, nullptr) > 0) handle_event();
    if (steady_now() < deadline) continue;
    send_reports(deadline);
    deadline += model_.period();
    for (; steady_now() >= deadline; deadline += model_.period()) {
      const std::lock_guard lock(mutex_);
      ++counts_.missed;
    }
  }
}

void UhidDevice::send_reports(Time deadline) {
  const std::lock_guard lock(mutex_);
  for (const Report& report : model_.input(deadline)) {
    uhid_event event{};
    event.type = UHID_INPUT2;
    event.u.input2.size = static_cast<std::uint16_t>(report.size());
    std::copy(report.begin(), report.end(), event.u.input2.data);
    if (write_event(file_, event)) ++counts_.sent;
  }
  counts_.latest = std::max(counts_.latest, steady_now() - deadline);
}

void UhidDevice::handle_event() {
  uhid_event event{};
  if (read(file_, &event, sizeof event) <= 0) return;
  const std::lock_guard lock(mutex_);
  const Time now = steady_now();
  if (event.type == UHID_OPEN) ++counts_.opened;
  if (event.type == UHID_OUTPUT) {
    model_.output({event.u.output.data, event.u.output.size}, now);
  }
  if (event.type == UHID_GET_REPORT) {
    const uhid_get_report_req& request = event.u.get_report;
    const bool input = request.rtype == UHID_INPUT_REPORT;
    const auto answer = input ? model_.ask(request.rnum, now) : model_.feature(request.rnum, now);
    if (model_.answers()) write_event(file_, answer_to(request, answer));
  }
  if (event.type == UHID_SET_REPORT && model_.answers()) {
    const uhid_set_report_req& request = event.u.set_report;
    const bool good = model_.set_feature({request.data, request.size}, now);
    uhid_event answer{};
    answer.type = UHID_SET_REPORT_REPLY;
    answer.u.set_report_reply.id = request.id;
    answer.u.set_report_reply.err = good ? 0 : EIO;
    write_event(file_, answer);
  }
}

std::filesystem::path UhidDevice::path() const {
  std::error_code none;
  for (const auto& entry : fs::directory_iterator("/sys/class/hidraw", none)) {
    std::ifstream file(entry.path() / "device/uevent");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const bool ours = text.find("HID_UNIQ=" + model_.identity().serial + "\n") != text.npos;
    if (ours) return "/dev" / entry.path().filename();
  }
  return {};
}

void UhidDevice::wait_for_path() const {
  const Time end = steady_now() + kKernelAnswers;
  while (path().empty() && steady_now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace limpid::test
