// A device behind callbacks: what a driver gives is read, what the loop answers is sent.
//
// The driver here is a stand-in that stands still; put your own into `Driver`.
#include <limpid/limpid.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <functional>
#include <thread>

namespace {

struct Driver {
  std::function<bool(std::array<double, 3>&)> read;   // false: no new reading
  std::function<void(std::span<const double>)> push;  // torque of each joint [N m]
  std::function<bool()> hand = [] { return true; };   // the dead-man switch is closed
};

// Runs the loop at 1 kHz until `stop`; the driver's motors end without force.
void run(limpid::DeviceLoop& loop, const Driver& driver, const std::atomic<bool>& stop) {
  using namespace std::chrono;
  std::array<double, 3> x{};
  auto next = steady_clock::now();
  while (!stop) {
    limpid::DeviceLoop::Reading reading;
    reading.fresh = driver.read(x);
    reading.position = x;
    reading.hand = driver.hand();
    driver.push(loop.tick(reading));
    next = std::max(next + milliseconds(1), steady_clock::now() - milliseconds(5));
    std::this_thread::sleep_until(next);  // of missed ticks only a few are made up for
  }
  const std::array<double, 3> nothing{};
  driver.push(nothing);
}

}  // namespace

int main() {
  const std::array<double, 3> start{0, -0.8, 1.5};
  Driver driver;
  int readings = 0;
  double most = 0;
  driver.read = [&](std::array<double, 3>& x) {
    x = start;
    x[0] += ++readings % 2 * 1e-6;  // an encoder's last digit
    return true;
  };
  driver.push = [&](std::span<const double> torque) {
    for (const double each : torque) most = std::max(most, std::abs(each));
  };

  limpid::LoopOptions options;
  options.arm = "omni.urdf";  // put your device's own here
  options.settings = {"coupling.kind=predictive"};
  options.limits.tip_force = 3;
  limpid::DeviceLoop loop(options, start);
  for (const std::string& note : loop.notes()) std::printf("note: %s\n", note.c_str());

  std::atomic<bool> stop{false};
  std::thread ticks([&] { run(loop, driver, stop); });
  loop.arm();  // a person holds the device
  std::this_thread::sleep_for(std::chrono::seconds(1));
  stop = true;
  ticks.join();
  std::printf("%d readings, force %s, at most %.3f N m\n", readings,
              loop.force_text().empty() ? "on" : loop.force_text().c_str(), most);
  return readings > 500 && loop.armed() ? 0 : 1;
}
