#include "devices/files/session/session_models.h"

#include <fmt/format.h>

#include "devices/files/session/session_source.h"

namespace limpid {
namespace {

constexpr const char* kGroup = "/models";
constexpr std::size_t kMostModels = 64;

std::string dataset_path(std::size_t i) { return fmt::format("{}/{}", kGroup, i); }

}  // namespace

void write_models(hid_t root, const SceneFiles& models, const std::filesystem::path& file) {
  const hdf5::Properties links(H5Pcreate(H5P_LINK_CREATE));
  H5Pset_create_intermediate_group(links.get(), 1);
  std::size_t i = 0;
  for (const auto& [name, bytes] : models) {
    const hsize_t size = bytes->size();
    const hdf5::Dataspace space(H5Screate_simple(1, &size, nullptr));
    const hdf5::Dataset dataset(H5Dcreate2(root, dataset_path(i++).c_str(), H5T_STD_U8LE,
                                           space.get(), links.get(), H5P_DEFAULT, H5P_DEFAULT));
    hdf5::check(dataset && H5Dwrite(dataset.get(), H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                                    bytes->data()) >= 0,
                file, "cannot write");
    hdf5::write_text(dataset.get(), "name", name, file);
  }
}

SceneFiles read_models(hid_t root, const std::filesystem::path& file, hdf5::Claims& claims) {
  std::vector<Source> sources;
  for (std::size_t i = 0; i < kMostModels && hdf5::has(root, dataset_path(i), file); ++i) {
    const Source& source =
        sources.emplace_back(open_source(root, dataset_path(i).c_str(), 1, file));
    claims.stored(source.dataset);
    claims.take(source.rows, 1, source.path);
  }
  SceneFiles models;
  for (const Source& source : sources) {
    const std::string& path = source.path;
    const hdf5::Datatype type(H5Dget_type(source.dataset.get()));
    std::vector<unsigned char> bytes(source.rows);
    if (H5Tget_class(type.get()) != H5T_INTEGER || H5Tget_size(type.get()) != 1 ||
        (!bytes.empty() && H5Dread(source.dataset.get(), H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL,
                                   H5P_DEFAULT, bytes.data()) < 0)) {
      refuse(file, path + ": cannot be read as bytes");
    }
    const std::string name = hdf5::read_text(source.dataset.get(), "name", file);
    models[name] = std::make_shared<const std::vector<unsigned char>>(std::move(bytes));
  }
  return models;
}

}  // namespace limpid
