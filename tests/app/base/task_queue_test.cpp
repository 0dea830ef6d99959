#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <stdexcept>
#include <string>

#include "app/base/tasks.h"
#include "devices/hid/hid_device.h"
#include "devices/hid/hid_transport.h"
#include "devices/hid/raw_protocol.h"
#include "tests/support/fake_hid.h"
#include "tests/support/raw_reports.h"

namespace limpid {
namespace {

using namespace std::chrono_literals;

TEST(TasksOfAQueue, AreDoneInTheirOrder) {
  TaskQueue tasks;
  std::string done;
  for (const char* step : {"a", "b", "c"}) {
    tasks.run([&done, step] { done += step; });
  }
  tasks.run([] {}).get();
  EXPECT_EQ(done, "abc");
}

TEST(TasksOfAQueue, BringBackWhatCameOfThem) {
  TaskQueue tasks;
  std::future<int> number = tasks.run([] { return 7; });
  std::optional<int> got;
  while (!got) got = take_ready(number);
  EXPECT_EQ(got, 7);
  EXPECT_FALSE(number.valid());
  EXPECT_FALSE(take_ready(number)) << "once";
  std::future<int> failing = tasks.run([]() -> int { throw std::runtime_error("no"); });
  failing.wait();
  EXPECT_THROW(take_ready(failing), std::runtime_error);
}

TEST(TasksOfAQueue, AreAllDoneBeforeTheEnd) {
  std::atomic<int> done = 0;
  {
    TaskQueue tasks;
    for (int i = 0; i < 20; ++i) {
      tasks.run([&done] {
        std::this_thread::sleep_for(1ms);
        ++done;
      });
    }
  }
  EXPECT_EQ(done, 20);
}

TEST(TasksOfAQueue, LetGoOfWhatTheyHeldWhenTheyAreDone) {
  TaskQueue tasks;
  const auto thing = std::make_shared<int>(1);
  tasks.run([thing] {});
  tasks.run([] {}).get();
  EXPECT_EQ(thing.use_count(), 1);
}

// Exit status of `life` in a process without privileges, as most processes are.
int without_privileges(int (*life)()) {
  const pid_t child = fork();
  if (child == 0) {
    const rlimit none{};
    setrlimit(RLIMIT_RTPRIO, &none);
    setrlimit(RLIMIT_NICE, &none);
    if (geteuid() == 0 && setresuid(65534, 65534, 65534) != 0) _exit(99);
    _exit(life());
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// Notes the scheduling of the thread that reads it.
struct WatchedTransport final : HidTransport {
  explicit WatchedTransport(std::shared_ptr<test::FakeHid> hid) : under(std::move(hid), true) {}
  int read(std::span<std::uint8_t> report, int timeout_ms) noexcept override {
    policy = sched_getscheduler(0);
    return under.read(report, timeout_ms);
  }
  bool write(std::span<const std::uint8_t> report) noexcept override { return under.write(report); }
  int get_feature(std::span<std::uint8_t> report) noexcept override {
    return under.get_feature(report);
  }
  bool set_feature(std::span<const std::uint8_t> report) noexcept override {
    return under.set_feature(report);
  }
  void ask(std::span<const std::uint8_t> question) noexcept override { under.ask(question); }
  const std::vector<std::uint8_t>& report_descriptor() const override {
    return under.report_descriptor();
  }
  test::FakeTransport under;
  static inline std::atomic<int> policy{-1};
};

std::unique_ptr<HidDevice> connect() {
  auto hid = std::make_shared<test::FakeHid>();
  hid->features[0] = test::sealed(test::raw_feature(2));
  return std::make_unique<HidDevice>(std::make_unique<WatchedTransport>(hid),
                                     std::make_unique<RawProtocol>(),
                                     HidPlace{"A device", "1209:4c50:1", ""});
}

// The window lowers its own priority before any device is opened.
TEST(TasksOfAQueue, GiveDevicesAThreadThatIsNotBehindAllOthers) {
  EXPECT_EQ(without_privileges([] {
              TaskQueue tasks;
              tasks.run([] {}).get();
              if (!yield_to_haptics()) return 90;
              auto opening = tasks.run(connect);
              const auto device = opening.get();
              while (WatchedTransport::policy < 0) std::this_thread::sleep_for(1ms);
              return WatchedTransport::policy.load();
            }),
            SCHED_OTHER);
}

TEST(HidDevice, RefusesToRunBehindAllOthers) {
  EXPECT_EQ(without_privileges([] {
              if (!yield_to_haptics()) return 90;
              try {
                connect();
              } catch (const HidError&) {
                return 42;
              }
              return 91;
            }),
            42);
}

}  // namespace
}  // namespace limpid
