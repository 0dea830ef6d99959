// A hand that taps an object and holds the tip against it, and the measured result.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "core/dynamics/arm.h"
#include "devices/simulated/rig.h"
#include "tests/support/rows.h"

namespace limpid::test {

// Place where the tip's centre meets the object, the outward direction there, and the depth of a
// centre [m].
struct Spot {
  Vec3 place, out;
  std::function<double(const Vec3&)> depth;
};

inline Spot flat_spot(const Vec3& place, const Vec3& out) {
  return {place, out, [=](const Vec3& tip) { return out.dot(place - tip); }};
}

struct Felt {
  double energy = 0;     // highest E_c [J]
  double port = 0;       // most energy that the hand was given [J]
  double chatter = 0;    // rms speed of the tip above 20 Hz while it is held [m/s]
  double stiffness = 0;  // wall's stiffness as the device meets it, over its setting [-]
  double torque = 0;     // largest contact torque on a joint [N m]
};

class Taps {
 public:
  double wall = 600;    // stiffness setting of the surface [N/m]
  double press = 4;     // force of the hand while it holds [N]
  double above = 0.02;  // start of the hand over the surface [m]
  int taps = 2;

  // Taps with the grip, mass and law of `p`. A run that diverged gives infinity, with no stiffness.
  Felt felt(const ArmDescription& arm, const Scene& scene, const Spot& spot,
            const Parameters& p) const {
    return felt(arm, scene, spot, p, rest_at(arm, spot.place + above * spot.out));
  }
  // The same from `start`, with the tip above the surface.
  Felt felt(const ArmDescription& arm, const Scene& scene, const Spot& spot, const Parameters& p,
            const RigStart& start) const {
    Rig rig(arm, scene);
    rig.start(p, start);
    Rows rows(rig.layout());
    const double down = above + press / p.hand_stiffness + press / wall;
    const double period = 2 * (kRest + down / kSpeed) + kHold;
    for (int k = 0; k < taps * period / p.tick; ++k) {
      const double in = std::fmod(k * p.tick, period);
      const double way = std::min(in - kRest, period - kRest - in) * kSpeed;
      rig.step(p, {{start.target - std::clamp(way, 0.0, down) * spot.out, 1}}, rows.add());
      if (rig.diverged()) return lost();
    }
    const double held = kRest + down / kSpeed + kSettle;  // start of the judged time
    return judge(arm, rows, spot, p.tick, [&](std::size_t k) {
      const double in = std::fmod(static_cast<double>(k) * p.tick, period) - held;
      return in >= 0 && in < kHold - kSettle - 0.5 / kFast;  // the mean must not reach the end
    });
  }

 private:
  static constexpr double kSpeed = 0.15;                            // [m/s]
  static constexpr double kRest = 0.1, kHold = 0.5, kSettle = 0.3;  // [s]
  static constexpr double kFast = 20;  // chatter is motion above it [Hz]

  static Felt lost() {
    constexpr double kLost = std::numeric_limits<double>::infinity();
    return {kLost, kLost, kLost, 0, kLost};
  }

  template <class Held>
  Felt judge(const ArmDescription& description, const Rows& rows, const Spot& spot, double T,
             Held&& held) const {
    const Arm<kAnyDof> arm(description);
    std::vector<Vec3> tips;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      tips.push_back(arm.tip_at(rows.vec(k, Column::device_position)));
    }
    // The slow motion is the mean over a period of 20 Hz.
    const auto half = static_cast<std::size_t>(std::lround(0.5 / (kFast * T)));
    Felt felt;
    double fast2 = 0, force = 0, depth = 0, ticks = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      felt.energy = std::max(felt.energy, rows.at(k, Column::energy_total));
      felt.port = std::max(felt.port, rows.at(k, Column::energy_port));
      felt.torque =
          std::max(felt.torque, rows.vec(k, Column::contact_torque).cwiseAbs().maxCoeff());
      if (!held(k)) continue;
      const Vec3 slow = (tips[k + half] - tips[k - half]) / (2 * static_cast<double>(half));
      fast2 += ((tips[k] - tips[k - 1] - slow) / T).squaredNorm();
      for (const Rows::Touch& touch : rows.touches(k)) force += touch.force.dot(spot.out);
      depth += spot.depth(tips[k]);
      ++ticks;
    }
    felt.chatter = std::sqrt(fast2 / ticks);
    felt.stiffness = force / depth / wall;
    return felt;
  }
};

}  // namespace limpid::test
