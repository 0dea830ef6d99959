// Columns of a session file that are derived from the columns of the rows: positions and velocities
// of the tips, and the total force on the proxy.
#pragma once

#include <array>
#include <memory>
#include <span>

#include "core/dynamics/arm.h"
#include "core/tick/row.h"

namespace limpid {

struct SessionInfo;

struct DerivedInfo {
  const char* path;  // dataset in the session file: x, y, z in the frame of the arm's root
  const char* unit;
  const char* what;
};

inline constexpr std::array<DerivedInfo, 5> kDerivedInfo{{
    {"/device/tip", "m", "position of the device's tip"},
    {"/device/tip_velocity", "m/s", "velocity of the device's tip"},
    {"/proxy/tip", "m", "position of the proxy's tip"},
    {"/proxy/tip_velocity", "m/s", "velocity of the proxy's tip"},
    {"/contact/total_force", "N",
     "force on the proxy during the tick: the sum of all contacts in /contact/force"},
}};
inline constexpr std::size_t kDerived = kDerivedInfo.size();
inline constexpr std::size_t kTotalForce = 4;

class DerivedColumns {
 public:
  explicit DerivedColumns(const ArmDescription& arm) : arm_(arm) {}

  // The values of a row that the columns are derived from, as they are in memory.
  struct From {
    std::span<const double> x1, v1, x2, v2;  // of device and proxy
    std::span<const double> forces;          // of the contacts
  };
  static From from(const RowLayout& layout, std::span<const double> row);

  // Derived values in the order of kDerivedInfo.
  using Values = std::array<Vec3, kDerived>;
  Values of(const From& from) const;

 private:
  Arm<kAnyDof> arm_;
};

// The arm of a recording, read from its text if that is all there is; null if it cannot be read.
std::shared_ptr<const ArmDescription> recorded_arm(const SessionInfo& info);

}  // namespace limpid
