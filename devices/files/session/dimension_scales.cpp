#include "devices/files/session/dimension_scales.h"

#include <hdf5_hl.h>

#include <algorithm>
#include <string>
#include <vector>

namespace limpid::hdf5 {
namespace {

Dataset create_names(hid_t root, const char* name, const std::vector<std::string>& names,
                     const std::filesystem::path& file) {
  std::size_t length = 1;
  for (const std::string& each : names) length = std::max(length, each.size());
  std::string bytes;
  for (const std::string& each : names) bytes += each + std::string(length - each.size(), '\0');
  const Datatype type(H5Tcopy(H5T_C_S1));
  H5Tset_size(type.get(), length);
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  const hsize_t count = names.size();
  const Dataspace space(H5Screate_simple(1, &count, nullptr));
  Dataset dataset(
      H5Dcreate2(root, name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  check(dataset &&
            H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) >= 0,
        file, "cannot write");
  make_scale(dataset, name, file);
  return dataset;
}

}  // namespace

Scales create_scales(hid_t root, const ArmDescription& arm, const std::filesystem::path& file) {
  std::vector<std::string> joints;
  for (const Joint& joint : arm.joints) joints.push_back(joint.name);
  return {create_names(root, "joint", joints, file),
          create_names(root, "axis", {"x", "y", "z"}, file)};
}

void make_scale(const Dataset& dataset, const char* name, const std::filesystem::path& file) {
  check(H5DSset_scale(dataset.get(), name) >= 0, file, "cannot write");
}

void attach_scale(const Dataset& dataset, const Dataset& scale, unsigned dimension,
                  const std::filesystem::path& file) {
  check(H5DSattach_scale(dataset.get(), scale.get(), dimension) >= 0, file, "cannot write");
}

}  // namespace limpid::hdf5
