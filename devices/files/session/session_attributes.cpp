#include "devices/files/session/session_attributes.h"

#include <array>
#include <ctime>

#include "core/dynamics/arm_description.h"
#include "devices/files/session/hdf5_handles.h"
#include "devices/files/session/session_names.h"

namespace limpid {
namespace {

std::string now() {
  const std::time_t t = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&t, &utc);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

constexpr const char* kConventions =
    "Row k is the state at /time[k] and the torques held from then to the next row. Units are SI: "
    "rad, rad/s and N m of joints that turn, m, m/s and N of joints that slide; the attribute unit "
    "of a dataset says which, once for all of its columns or once for each joint. Places, "
    "velocities and forces at the tip are x, y, z in the frame of the root link of device_urdf. "
    "The device is the arm in the hand, the proxy its image in the simulated world; contact forces "
    "act on the proxy. Where nothing touches, /contact/force and /contact/total_force are 0 and "
    "/contact/point is not a number. /check is for the program: sums that show damage, and what "
    "the units' rounding took. Whoever changes a dataset deletes /check.";

void write_arm(hid_t root, const SessionInfo& info, const std::filesystem::path& file) {
  std::vector<std::string> types;
  for (const bool slide : info.slides) types.emplace_back(slide ? kSlidingType : kTurningType);
  if (!types.empty()) hdf5::write_texts(root, kJointTypes, types, file);
  if (!info.arm) return;
  std::vector<std::string> names;
  for (const Joint& joint : info.arm->joints) names.push_back(joint.name);
  hdf5::write_texts(root, "joints", names, file);
  hdf5::write_text(root, "tip", info.arm->tip_link, file);
}

}  // namespace

void write_attributes(hid_t root, const SessionInfo& info, const std::filesystem::path& file) {
  const std::int64_t version = kSessionVersion;
  const std::int64_t dof = info.dof;
  hdf5::write_text(root, "format", kSessionFormat, file);
  hdf5::write_scalar(root, "version", H5T_STD_I64LE, H5T_NATIVE_INT64, &version, file);
  hdf5::write_scalar(root, "tick", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &info.tick, file);
  hdf5::write_scalar(root, "dof", H5T_STD_I64LE, H5T_NATIVE_INT64, &dof, file);
  hdf5::write_scalar(root, "seed", H5T_STD_U64LE, H5T_NATIVE_UINT64, &info.seed, file);
  hdf5::write_text(root, "created", info.created.empty() ? now() : info.created, file);
  hdf5::write_text(root, "app_version", info.app_version, file);
  hdf5::write_text(root, "build", info.build, file);
  hdf5::write_text(root, "conventions", kConventions, file);
  hdf5::write_text(root, "source", info.source, file);
  hdf5::write_text(root, "config", info.config, file);
  hdf5::write_text(root, "device_urdf", info.device_urdf, file);
  hdf5::write_text(root, "scene", info.scene, file);
  hdf5::write_text(root, "safety_limits", info.safety, file);
  write_arm(root, info, file);
}

}  // namespace limpid
