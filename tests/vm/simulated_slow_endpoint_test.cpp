// Devices whose endpoint takes its time for each report, as full-speed USB (1 ms) and slower ones
// do: time to zero force after the loop stands still, or wants no force any more.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/vm/models.h"
#include "tests/vm/simulated_desk.h"

namespace limpid::test {
namespace {

using namespace std::chrono_literals;

// A transport that takes its time for each report it sends; readings and ticks go on meanwhile.
class SlowTransport final : public HidTransport {
 public:
  SlowTransport(ReferenceDevice& model, const Time& now, std::function<void(Time)> pass)
      : inner(model, now), pass_(std::move(pass)) {}

  int read(std::span<std::uint8_t> report, int) noexcept override { return inner.read(report, 0); }
  bool write(std::span<const std::uint8_t> report) noexcept override {
    pass_(takes);
    return inner.write(report);
  }
  int get_feature(std::span<std::uint8_t> report) noexcept override {
    return inner.get_feature(report);
  }
  void ask(std::span<const std::uint8_t> question) noexcept override { inner.ask(question); }
  bool set_feature(std::span<const std::uint8_t> report) noexcept override {
    return inner.set_feature(report);
  }
  const std::vector<std::uint8_t>& report_descriptor() const override {
    return inner.report_descriptor();
  }

  ModelTransport inner;
  Time takes{};  // for each report

 private:
  std::function<void(Time)> pass_;
};

// A device that pushes on both axes, with a loop that ticks every millisecond.
template <class Model>
struct SlowEndpoint : testing::Test {
  SlowEndpoint() {
    model->power(true, now);
    transport = std::make_unique<SlowTransport>(*model, now, [this](Time time) { pass(time); });
    if constexpr (SimulatedDesk<Model>::kPid) {
      protocol = std::make_unique<PidJoystick>(
          parse_report_descriptor(model->report_descriptor()),
          PidSettings{.range = kRange, .effort = kEffort, .reverse = Model::kReversed});
    } else {
      protocol = std::make_unique<RawProtocol>();
    }
    protocol->open(*transport);
    exchange = std::make_unique<HidExchange>(*transport, *protocol, [this] { return now; });
  }

  void pass(Time time) {
    for (const Time end = now + time; now < end;) {
      now += std::min<Time>(50us, end - now);
      if (exchange == nullptr || now < next_) continue;
      next_ = now + 1ms;
      transport->inner.arrive(model->input(now));
      DeviceReading reading;
      exchange->read(reading);
      if (ticking) exchange->write(wanted);
    }
  }
  void run(Time time) {
    for (const Time end = now + time; now < end;) {
      exchange->step();
      pass(50us);
    }
  }
  // Makes the device push, and go on, with reports that take so long.
  void push(Time takes) {
    transport->takes = takes;
    wanted = {0.3, -0.2};
    ticking = true;
    const Time from = now;
    run(300ms);
    ASSERT_GT(model->forces().largest(from + 200ms), 0.15);
  }
  // The longest time to zero force after `what`, over several moments within a round of reports.
  Time zero_after(Time takes, const std::function<void()>& what) {
    Time worst{};
    for (int i = 0; i < 25; ++i) {
      push(takes);
      run(i * 730us);
      const Time moment = now;
      what();
      run(100ms);
      const auto zero = model->forces().zero_after(moment);
      EXPECT_TRUE(zero) << "it pushes on";
      worst = std::max(worst, zero.value_or(Time(1h)));
    }
    return worst;
  }

  Time now = std::chrono::hours(1), next_{};
  bool ticking = true;
  std::vector<double> wanted{0, 0};
  std::unique_ptr<Model> model = SimulatedDesk<Model>::make_model();
  std::unique_ptr<SlowTransport> transport;
  std::unique_ptr<HidProtocol> protocol;
  std::unique_ptr<HidExchange> exchange;
};
TYPED_TEST_SUITE(SlowEndpoint, Models);

constexpr std::array<Time, 4> kTakes{200us, 1ms, 2ms, 4500us};

void print(const char* device, const char* what, Time takes, Time zero, Time limit) {
  const auto in_ms = [](Time time) {
    return std::chrono::duration<double, std::milli>(time).count();
  };
  std::printf("| %-12s | report of %.1f ms, %-22s | %7.2f ms | %5.1f ms |\n", device, in_ms(takes),
              what, in_ms(zero), in_ms(limit));
}

// A report is on its way, and zero takes another one for each of two axes.
constexpr Time kTurn = 1ms;

TYPED_TEST(SlowEndpoint, HasNoForceSoonAfterTheLoopStandsStillHoweverLongItsReportsTake) {
  for (const Time takes : kTakes) {
    const Time zero = this->zero_after(takes, [this] { this->ticking = false; });
    const Time limit = HidExchange::kTorqueLife + kTurn + 3 * takes;
    print(kName<TypeParam>, "the loop stands still", takes, zero, limit);
    EXPECT_LE(zero, limit) << takes.count();
  }
}

TYPED_TEST(SlowEndpoint, HasNoForceAtOnceWhereTheLoopWantsNoneHoweverLongItsReportsTake) {
  for (const Time takes : kTakes) {
    const Time zero = this->zero_after(takes, [this] { this->wanted = {0, 0}; });
    const Time limit = 2 * kTurn + 3 * takes;  // the next tick asks for zero
    print(kName<TypeParam>, "force is cut", takes, zero, limit);
    EXPECT_LE(zero, limit) << takes.count();
  }
}

}  // namespace
}  // namespace limpid::test
