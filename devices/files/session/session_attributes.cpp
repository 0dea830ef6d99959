#include "devices/files/session/session_attributes.h"

#include <array>
#include <ctime>

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
  hdf5::write_text(root, "source", info.source, file);
  hdf5::write_text(root, "config", info.config, file);
  hdf5::write_text(root, "device_urdf", info.device_urdf, file);
  hdf5::write_text(root, "scene", info.scene, file);
  hdf5::write_text(root, "safety_limits", info.safety, file);
}

}  // namespace limpid
