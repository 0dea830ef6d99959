// Tables of sweeps: numbers in columns, all of one length.
#include <fmt/format.h>

#include "devices/files/session/hdf5_reading.h"
#include "devices/files/session/session_reader.h"
#include "devices/files/session/session_source.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDone = "done";
constexpr const char* kMeasures = "measure";

std::vector<std::string> attributes_of(hid_t root) {
  std::vector<std::string> names;
  const auto add = [](hid_t, const char* name, const H5A_info_t*, void* into) -> herr_t {
    static_cast<std::vector<std::string>*>(into)->emplace_back(name);
    return 0;
  };
  H5Aiterate2(root, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, add, &names);
  return names;
}

std::vector<std::string> links_of(hid_t group) {
  std::vector<std::string> names;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* into) -> herr_t {
    static_cast<std::vector<std::string>*>(into)->emplace_back(name);
    return 0;
  };
  H5Literate(group, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, add, &names);
  return names;
}

std::vector<double> column(hid_t root, const std::string& path, const fs::path& file,
                           hdf5::Claims& claims) {
  const hdf5::Dataset dataset = hdf5::open_dataset(root, path, file);
  const hdf5::Dataspace space(H5Dget_space(dataset.get()));
  const hssize_t count = H5Sget_simple_extent_npoints(space.get());
  if (count < 0) refuse(file, fmt::format("damaged: {}: no list of numbers", path));
  claims.stored(dataset);
  claims.take(static_cast<std::uint64_t>(count), sizeof(double), path);
  std::vector<double> values(static_cast<std::size_t>(count));
  const bool read = values.empty() || H5Dread(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL,
                                              H5P_DEFAULT, values.data()) >= 0;
  hdf5::check(read, file, ("damaged: " + path).c_str());
  return values;
}

}  // namespace

wire::Table read_table_here(const fs::path& file) {
  const hdf5::Quiet quiet;
  hdf5::check_regular_file(file);
  // Recordings may be large, and are told from tables without looking through all of them.
  {
    const hdf5::File looked_at(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
    if (!looked_at || H5Lexists(looked_at.get(), kMeasures, H5P_DEFAULT) <= 0) {
      refuse(file, "damaged, or no table of a sweep");
    }
  }
  const hdf5::File opened = hdf5::open_to_read(file);
  const hid_t root = opened.get();
  wire::Table table;
  for (const std::string& name : attributes_of(root)) {
    const hdf5::Attribute attribute(H5Aopen(root, name.c_str(), H5P_DEFAULT));
    const hdf5::Datatype type(H5Aget_type(attribute.get()));
    const H5T_class_t kind = H5Tget_class(type.get());
    if (kind == H5T_STRING) table.texts[name] = hdf5::read_text(root, name.c_str(), file);
    if (kind == H5T_INTEGER) table.counts[name] = hdf5::read_count(root, name.c_str(), file);
  }
  hdf5::Claims claims(file);
  const auto take = [&](const std::string& path) {
    table.columns[path] = column(root, path, file, claims);
  };
  if (hdf5::has(root, kDone, file)) take(fmt::format("/{}", kDone));
  const hdf5::Group measures = hdf5::open_group(root, kMeasures, file);
  for (const std::string& name : links_of(measures.get())) {
    take(fmt::format("/{}/{}", kMeasures, name));
  }
  return table;
}

}  // namespace limpid
