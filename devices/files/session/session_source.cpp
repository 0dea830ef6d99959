#include "devices/files/session/session_source.h"

#include <fmt/format.h>

#include <array>

#include "devices/files/file_error.h"
#include "devices/files/session/hdf5_reading.h"

namespace limpid {

void refuse(const std::filesystem::path& file, const std::string& why) {
  throw FileError(fmt::format("{}: {}", file.string(), why));
}

Source open_source(hid_t root, const char* path, hsize_t width, const std::filesystem::path& file) {
  Source source{hdf5::open_dataset(root, path, file), path, 0, width};
  const hdf5::Dataspace space(H5Dget_space(source.dataset.get()));
  const int rank = H5Sget_simple_extent_ndims(space.get());
  const bool table = rank == 2;
  std::array<hsize_t, 2> extent{0, 1};
  if (rank >= 1 && rank <= 2) H5Sget_simple_extent_dims(space.get(), extent.data(), nullptr);
  if (!(table || (rank == 1 && width == 1)) || extent[1] != width) {
    refuse(file, fmt::format("{}: {} dimensions, {} wide; needed: N x {}", path, rank,
                             table ? extent[1] : 1, width));
  }
  source.rows = extent[0];
  return source;
}

Source open_column(hid_t root, const ColumnInfo& column, const RowLayout& layout,
                   const std::filesystem::path& file) {
  Source source =
      open_source(root, column.path, static_cast<hsize_t>(layout.width(column.column)), file);
  const hdf5::Datatype type(H5Dget_type(source.dataset.get()));
  const std::size_t size = H5Tget_size(type.get());
  const bool number = H5Tget_class(type.get()) == H5T_FLOAT && (size == 8 || size == 4);
  const bool byte = H5Tget_class(type.get()) == H5T_INTEGER && H5Tget_size(type.get()) == 1;
  if (column.byte ? !byte : !number) {
    refuse(file, fmt::format("{}: of another type; needed: {}", column.path,
                             column.byte ? "uint8" : "float64 or float32"));
  }
  return source;
}

namespace {

bool read_as(const Source& source, hsize_t from, hsize_t count, hid_t type, void* out) {
  const hdf5::Dataspace in_file(H5Dget_space(source.dataset.get()));
  const std::array<hsize_t, 2> start{from, 0};
  const std::array<hsize_t, 2> block{count, source.width};
  // Of the file's rank: HDF5 goes through other shapes number by number.
  const int rank = H5Sget_simple_extent_ndims(in_file.get());
  const hdf5::Dataspace in_memory(H5Screate_simple(rank, block.data(), nullptr));
  return H5Sselect_hyperslab(in_file.get(), H5S_SELECT_SET, start.data(), nullptr, block.data(),
                             nullptr) >= 0 &&
         H5Dread(source.dataset.get(), type, in_memory.get(), in_file.get(), H5P_DEFAULT, out) >= 0;
}

}  // namespace

bool read_block(const Source& source, hsize_t from, hsize_t count, double* out) {
  return read_as(source, from, count, H5T_NATIVE_DOUBLE, out);
}

bool read_block(const Source& source, hsize_t from, hsize_t count, std::int8_t* out) {
  return read_as(source, from, count, H5T_NATIVE_INT8, out);
}

bool read_row(const Source& source, hsize_t row, std::uint64_t* out) {
  return read_as(source, row, 1, H5T_NATIVE_UINT64, out);
}

}  // namespace limpid
