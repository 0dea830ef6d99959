#include "app/sweep/file_image.h"

#include <algorithm>
#include <array>
#include <vector>

#include "devices/files/atomic_file.h"

namespace limpid {

using hdf5::check;

namespace {

constexpr std::size_t kGrowth = 1 << 18;  // [bytes]
constexpr hsize_t kChunk = 1 << 14;       // values

}  // namespace

FileImage::FileImage(std::filesystem::path file) : path_(std::move(file)) {
  const hdf5::Properties access(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_fapl_core(access.get(), kGrowth, false);
  file_ = hdf5::File(H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()));
  check(bool(file_), path_, "cannot be made");
}

hdf5::Dataset FileImage::add(const std::string& path, hid_t stored_as, hid_t held_as, hsize_t rows,
                             hsize_t width, const void* data) {
  const std::array<hsize_t, 2> size{rows, width};
  const int rank = width == 1 ? 1 : 2;
  const std::array<hsize_t, 2> chunk{std::clamp<hsize_t>(kChunk / width, 1, rows), width};
  const hdf5::Properties creation(H5Pcreate(H5P_DATASET_CREATE));
  H5Pset_obj_track_times(creation.get(), false);
  H5Pset_chunk(creation.get(), rank, chunk.data());
  H5Pset_fletcher32(creation.get());
  const hdf5::Properties links(H5Pcreate(H5P_LINK_CREATE));
  H5Pset_create_intermediate_group(links.get(), 1);
  const hdf5::Dataspace space(H5Screate_simple(rank, size.data(), nullptr));
  hdf5::Dataset dataset(H5Dcreate2(file_.get(), path.c_str(), stored_as, space.get(), links.get(),
                                   creation.get(), H5P_DEFAULT));
  check(dataset && H5Dwrite(dataset.get(), held_as, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0,
        path_, "cannot be made");
  return dataset;
}

void FileImage::number(hid_t object, const char* name, std::uint64_t value) {
  hdf5::write_scalar(object, name, H5T_STD_U64LE, H5T_NATIVE_UINT64, &value, path_);
}

void FileImage::text(hid_t object, const char* name, const std::string& value) {
  hdf5::write_text(object, name, value, path_);
}

void FileImage::write() {
  check(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL) >= 0, path_, "cannot be made");
  const ssize_t size = H5Fget_file_image(file_.get(), nullptr, 0);
  check(size > 0, path_, "cannot be made");
  std::vector<unsigned char> bytes(static_cast<std::size_t>(size));
  check(H5Fget_file_image(file_.get(), bytes.data(), bytes.size()) == size, path_,
        "cannot be made");
  write_atomically(path_, bytes);
}

}  // namespace limpid
