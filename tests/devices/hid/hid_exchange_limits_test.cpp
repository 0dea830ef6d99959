// Limits of the exchange's patience with a failing device.
#include <gtest/gtest.h>

#include <array>

#include "devices/hid/hid_exchange.h"

namespace limpid {
namespace {

using std::chrono::milliseconds;

// A protocol of one joint and one byte a report.
class OneByte final : public HidProtocol {
 public:
  OneByte() {
    traits_.dof = 1;
    traits_.pushes = true;
    traits_.effort = {1};
  }
  void open(HidTransport&) override {}
  const DeviceTraits& traits() const override { return traits_; }
  nanoseconds stale_after() const override { return milliseconds(5); }
  Decoded decode(std::span<const std::uint8_t> report, DeviceReading& reading) noexcept override {
    reading.x[0] = report[0];
    return Decoded::reading;
  }
  void encode(std::span<const double> torque, nanoseconds,
              const SendReport& send) noexcept override {
    const std::array<std::uint8_t, 1> report{static_cast<std::uint8_t>(torque[0] > 0 ? 1 : 0)};
    send(report);
  }
  void undelivered() noexcept override { ++lost; }
  const std::vector<Report>& stop_reports() const override { return stops; }

  std::vector<Report> stops;
  int lost = 0;

 private:
  DeviceTraits traits_;
};

// Sends endless reports if it `floods`; takes writes if it `accepts`.
class Endless final : public HidTransport {
 public:
  int read(std::span<std::uint8_t> report, int) noexcept override {
    if (!floods && reads > 0) return 0;
    report[0] = 7;
    ++reads;
    return 1;
  }
  bool write(std::span<const std::uint8_t> report) noexcept override {
    ++writes;
    newest = report[0];
    return accepts;
  }
  int get_feature(std::span<std::uint8_t>) noexcept override { return -1; }
  bool set_feature(std::span<const std::uint8_t>) noexcept override { return false; }
  void ask(std::span<const std::uint8_t>) noexcept override {}
  const std::vector<std::uint8_t>& report_descriptor() const override { return none_; }

  bool floods = false, accepts = true;
  int reads = 0, writes = 0, newest = -1;

 private:
  std::vector<std::uint8_t> none_;
};

struct ExchangeLimits : testing::Test {
  bool step() {
    now += milliseconds(1);
    return exchange.step();
  }
  void fail(int times) {
    transport.accepts = false;
    for (int i = 0; i < times; ++i) step();
    transport.accepts = true;
  }

  nanoseconds now{1};
  OneByte protocol;
  Endless transport;
  HidExchange exchange{transport, protocol, [this] { return now; }};
};

TEST_F(ExchangeLimits, ForgivesFailuresOnceAWriteGetsThrough) {
  for (int i = 0; i < 5; ++i) {
    fail(9);
    EXPECT_FALSE(exchange.lost()) << i;
    EXPECT_TRUE(step());
  }
  fail(10);
  EXPECT_TRUE(exchange.lost());
}

// A device that does not understand the first report may understand another.
TEST_F(ExchangeLimits, EndsWithEveryStopReportWhicheverFails) {
  protocol.stops = {{0}, {1}, {2}};
  transport.accepts = false;
  EXPECT_FALSE(exchange.finish());
  EXPECT_EQ(transport.writes, 3);
  EXPECT_EQ(transport.newest, 2);
}

// Otherwise a flood on the bus would keep the force on for ever.
TEST_F(ExchangeLimits, SendsInTheMidstOfAnEndlessFlood) {
  transport.floods = true;
  const std::array<double, 1> torque{0.5};
  exchange.write(torque);
  step();
  EXPECT_EQ(transport.newest, 1);
  EXPECT_LE(transport.reads, 200);
  exchange.stop();
  step();
  EXPECT_EQ(transport.newest, 0);
  EXPECT_EQ(transport.writes, 2);
}

TEST_F(ExchangeLimits, TellsTheProtocolWhatDidNotGetThrough) {
  step();
  EXPECT_EQ(protocol.lost, 0);
  transport.accepts = false;
  step();
  step();
  EXPECT_EQ(protocol.lost, 2);
  transport.accepts = true;
  step();
  EXPECT_EQ(protocol.lost, 2);
}

}  // namespace
}  // namespace limpid
