// Laws compared on the same recorded readings: how far the proxy left the device, and what each law
// gave.
//
//     compare_laws [READINGS.csv]     rows of three joint angles [rad], one each millisecond
//
// The readings are what they are: a law that pushes harder does not move them.
#include <limpid/limpid.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace {

using Angles = std::array<double, 3>;

std::vector<Angles> read(const char* file) {
  std::vector<Angles> rows;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    Angles x;
    char comma = ',';
    if (words >> x[0] >> comma >> x[1] >> comma >> x[2]) rows.push_back(x);
  }
  return rows;
}

// A slow press into the table and back, where nobody names a file.
std::vector<Angles> made() {
  std::vector<Angles> rows;
  for (int k = 0; k < 3000; ++k) {
    const double s = std::sin(1e-3 * k);
    rows.push_back({0, -0.8 + 0.3 * s * s, 1.5});
  }
  return rows;
}

}  // namespace

int main(int count, char** words) {
  const std::vector<Angles> readings = count > 1 ? read(words[1]) : made();
  if (readings.empty()) {
    std::fprintf(stderr, "no rows of three angles\n");
    return 1;
  }
  std::printf("law        largest error [rad] largest torque [N m]   E_c [mJ]\n");
  for (const char* law : {"standard", "proposed", "predictive", "direct"}) {
    limpid::LoopOptions options;
    options.settings = {std::string("coupling.kind=") + law};
    options.motors = limpid::Motors::simulated;
    limpid::DeviceLoop loop(options, readings[0]);
    double error = 0, torque = 0;
    for (const Angles& x : readings) {
      limpid::DeviceLoop::Reading reading;
      reading.position = x;
      for (const double each : loop.tick(reading)) torque = std::fmax(torque, std::fabs(each));
      const auto proxy = loop.row("/proxy/position");
      for (int i = 0; i < 3; ++i) error = std::fmax(error, std::fabs(proxy[i] - x[i]));
    }
    std::printf("%-12s %17.2e %20.3f %10.3f\n", law, error, torque, 1e3 * loop.energy().controller);
  }
}
