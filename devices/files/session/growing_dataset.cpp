#include "devices/files/session/growing_dataset.h"

#include <array>

namespace limpid::hdf5 {

Dataset create_growing(hid_t file, const char* path, hid_t type, int rank, hsize_t width,
                       hsize_t chunk, std::optional<double> fill) {
  const Properties creation(H5Pcreate(H5P_DATASET_CREATE));
  H5Pset_fill_time(creation.get(), fill ? H5D_FILL_TIME_ALLOC : H5D_FILL_TIME_NEVER);
  if (fill) H5Pset_fill_value(creation.get(), H5T_NATIVE_DOUBLE, &*fill);
  const std::array<hsize_t, 2> none{0, width};
  const std::array<hsize_t, 2> unlimited{H5S_UNLIMITED, width};
  const std::array<hsize_t, 2> chunks{chunk, width};
  const Dataspace space(H5Screate_simple(rank, none.data(), unlimited.data()));
  const Properties links(H5Pcreate(H5P_LINK_CREATE));
  H5Pset_create_intermediate_group(links.get(), 1);
  H5Pset_chunk(creation.get(), rank, chunks.data());
  return Dataset(
      H5Dcreate2(file, path, type, space.get(), links.get(), creation.get(), H5P_DEFAULT));
}

void append_to(const Dataset& dataset, hsize_t from, hsize_t count, hsize_t width, hid_t type,
               const void* data, const std::filesystem::path& file) {
  const std::array<hsize_t, 2> extent{from + count, width};
  const std::array<hsize_t, 2> start{from, 0};
  const std::array<hsize_t, 2> block{count, width};
  check(H5Dset_extent(dataset.get(), extent.data()) >= 0, file, "cannot write");
  if (data == nullptr) {
    check(H5Dflush(dataset.get()) >= 0, file, "cannot write");
    return;
  }
  const Dataspace in_file(H5Dget_space(dataset.get()));
  const int rank = H5Sget_simple_extent_ndims(in_file.get());
  const Dataspace in_memory(H5Screate_simple(rank, block.data(), nullptr));
  check(H5Sselect_hyperslab(in_file.get(), H5S_SELECT_SET, start.data(), nullptr, block.data(),
                            nullptr) >= 0 &&
            H5Dwrite(dataset.get(), type, in_memory.get(), in_file.get(), H5P_DEFAULT, data) >= 0 &&
            H5Dflush(dataset.get()) >= 0,
        file, "cannot write");
}

}  // namespace limpid::hdf5
