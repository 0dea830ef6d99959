#include "devices/files/session/session_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <optional>

#include "devices/files/session/hdf5_reading.h"
#include "devices/files/text_file.h"

namespace limpid {

namespace {

constexpr hsize_t kMostColumns = 256;
constexpr unsigned long long kMostBlockRead = 1 << 20;

// The columns that the sums are over; nothing for one that this program does not know.
std::vector<std::optional<Column>> columns_in(const std::string& paths) {
  std::vector<std::optional<Column>> columns;
  for (std::size_t at = 0; at < paths.size();) {
    const std::size_t end = std::min(paths.find('\n', at), paths.size());
    const std::string path = paths.substr(at, end - at);
    const auto known =
        std::ranges::find_if(kColumnInfo, [&](const auto& c) { return c.path == path; });
    columns.push_back(known == kColumnInfo.end() ? std::nullopt : std::optional(known->column));
    at = end + 1;
  }
  return columns;
}

// Takes a value into a sum.
std::uint64_t stirred(std::uint64_t sum, double x) {
  sum = (sum ^ std::bit_cast<std::uint64_t>(x)) * 0x9e37'79b9'7f4a'7c15;
  return sum ^ sum >> 32;
}

bool read_as(const Source& source, hsize_t from, hsize_t count, hid_t type, void* out) {
  const hdf5::Dataspace in_file(H5Dget_space(source.dataset.get()));
  const hsize_t each = source.each_body;
  const std::array<hsize_t, 3> start{from, 0, 0};
  const std::array<hsize_t, 3> block{count, each > 0 ? source.width / each : source.width, each};
  // Has the file's rank, as HDF5 goes through other shapes number by number.
  const int rank = H5Sget_simple_extent_ndims(in_file.get());
  const hdf5::Dataspace in_memory(H5Screate_simple(rank, block.data(), nullptr));
  return H5Sselect_hyperslab(in_file.get(), H5S_SELECT_SET, start.data(), nullptr, block.data(),
                             nullptr) >= 0 &&
         H5Dread(source.dataset.get(), type, in_memory.get(), in_file.get(), H5P_DEFAULT, out) >= 0;
}

}  // namespace

AllColumns columns_of(const RowLayout& layout, std::span<const double> rows) {
  AllColumns columns;
  std::ranges::transform(kColumnInfo, columns.begin(), [&](const ColumnInfo& info) {
    return ColumnValues{rows.data() + layout.offset(info.column), layout.width(info.column),
                        layout.stride()};
  });
  return columns;
}

std::array<std::uint64_t, kColumns> column_sums(const AllColumns& columns, std::uint64_t from,
                                                std::uint64_t count) {
  std::array<std::uint64_t, kColumns> sums;
  sums.fill(count);
  for (std::uint64_t k = from; k < from + count; ++k) {
    for (std::size_t c = 0; c < kColumns; ++c) {
      const double* values = columns[c].first + k * static_cast<std::size_t>(columns[c].step);
      std::uint64_t sum = sums[c];
      for (int i = 0; i < columns[c].width; ++i) sum = stirred(sum, values[i]);
      sums[c] = sum;
    }
  }
  return sums;
}

std::size_t count_summed(const RowLayout& layout) {
  return static_cast<std::size_t>(std::ranges::count_if(
      kColumnInfo, [&](const ColumnInfo& column) { return summed(layout, column); }));
}

std::string check_columns(const RowLayout& layout) {
  std::string paths;
  for (const ColumnInfo& column : kColumnInfo) {
    if (summed(layout, column)) paths += std::string(column.path) + "\n";
  }
  return paths;
}

std::optional<CheckSums> CheckSums::open(hid_t root, const std::filesystem::path& file) {
  if (!hdf5::has(root, kCheckPath, file)) return std::nullopt;
  CheckSums sums;
  sums.root_ = root;
  sums.file_ = file;
  const hdf5::Dataset dataset = hdf5::open_dataset(root, kCheckPath, file);
  const std::uint64_t block = hdf5::read_count(dataset.get(), kCheckRows, file);
  sums.columns_ = columns_in(hdf5::read_text(dataset.get(), kCheckColumns, file));
  const std::size_t columns = sums.columns_.size();
  if (block < 1 || block > kMostBlockRead || columns == 0 || columns > kMostColumns) {
    refuse(file, fmt::format("{}: {} rows, {} columns; needed: at least one row and one column",
                             kCheckPath, block, columns));
  }
  sums.block_ = static_cast<std::size_t>(block);
  sums.source_ = open_source(root, kCheckPath, columns, file);
  const hdf5::Datatype type(H5Dget_type(sums.source_.dataset.get()));
  if (H5Tget_class(type.get()) != H5T_INTEGER || H5Tget_size(type.get()) != 8) {
    refuse(file, fmt::format("{}: of another type; needed: uint64", kCheckPath));
  }
  return sums;
}

CheckSums::Checked CheckSums::check(const RowLayout& layout, std::span<const double> rows,
                                    std::size_t from) const {
  const std::size_t size = rows.size() / static_cast<std::size_t>(layout.stride());
  const AllColumns in_memory = columns_of(layout, rows);
  std::vector<std::uint64_t> wanted(columns_.size());
  for (std::size_t at = 0; at < size; at += block_) {
    const std::size_t count = std::min(block_, size - at), which = (from + at) / block_;
    const std::string these = fmt::format("rows {} to {}", from + at, from + at + count - 1);
    if (which >= source_.rows || !read_row(source_, which, wanted.data())) {
      return {at, fmt::format("{} were never written", these)};
    }
    const auto found = column_sums(in_memory, at, count);
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (!columns_[i]) continue;
      const auto column = static_cast<std::size_t>(*columns_[i]);
      if (found[column] == wanted[i]) continue;
      const char* path = kColumnInfo[column].path;
      if (!hdf5::has(root_, path, file_)) continue;  // somebody left it out
      return {at,
              fmt::format(
                  "{}: {} differ from the recorded values: the file is damaged, or another program "
                  "changed the file (a program that changes values on purpose must delete /check)",
                  path, these)};
    }
  }
  return {size, ""};
}

void refuse(const std::filesystem::path& file, const std::string& why) {
  throw FileError(fmt::format("{}: {}", file.string(), why));
}

Source open_source(hid_t root, const char* path, hsize_t width, const std::filesystem::path& file,
                   hsize_t each_body) {
  Source source{hdf5::open_dataset(root, path, file), path, 0, width, each_body};
  const hdf5::Dataspace space(H5Dget_space(source.dataset.get()));
  const int rank = H5Sget_simple_extent_ndims(space.get());
  std::array<hsize_t, 3> extent{0, 1, 1};
  if (rank >= 1 && rank <= 3) H5Sget_simple_extent_dims(space.get(), extent.data(), nullptr);
  source.rows = extent[0];
  if (each_body > 0) {
    const hsize_t bodies = width / each_body;
    if (rank == 3 && extent[1] == bodies && extent[2] == each_body) return source;
    refuse(file, fmt::format("{}: {} dimensions, {} x {} wide; needed: N x {} x {}", path, rank,
                             extent[1], extent[2], bodies, each_body));
  }
  const bool table = rank == 2;
  if (!(table || (rank == 1 && width == 1)) || extent[1] != width) {
    refuse(file, fmt::format("{}: {} dimensions, {} wide; needed: N x {}", path, rank,
                             table ? extent[1] : 1, width));
  }
  return source;
}

Source open_column(hid_t root, const ColumnInfo& column, const RowLayout& layout,
                   const std::filesystem::path& file) {
  Source source = open_source(root, column.path, static_cast<hsize_t>(layout.width(column.column)),
                              file, of_each_body(column));
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

bool read_block(const Source& source, hsize_t from, hsize_t count, double* out) {
  return read_as(source, from, count, H5T_NATIVE_DOUBLE, out);
}

bool read_block(const Source& source, hsize_t from, hsize_t count, std::int8_t* out) {
  return read_as(source, from, count, H5T_NATIVE_INT8, out);
}

bool read_row(const Source& source, hsize_t row, std::uint64_t* out) {
  return read_as(source, row, 1, H5T_NATIVE_UINT64, out);
}

std::vector<std::uint64_t> read_row_numbers(const Source& source,
                                            const std::filesystem::path& file) {
  const hdf5::Datatype type(H5Dget_type(source.dataset.get()));
  std::vector<std::uint64_t> rows(source.rows);
  if (H5Tget_class(type.get()) != H5T_INTEGER ||
      (!rows.empty() && H5Dread(source.dataset.get(), H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL,
                                H5P_DEFAULT, rows.data()) < 0)) {
    refuse(file, fmt::format("{}: cannot be read as row numbers", source.path));
  }
  return rows;
}

std::vector<std::string> read_texts(const Source& source, std::size_t most,
                                    const std::filesystem::path& file) {
  const hdf5::Datatype type(H5Dget_type(source.dataset.get()));
  const std::size_t length = H5Tget_size(type.get());
  if (H5Tget_class(type.get()) != H5T_STRING || H5Tis_variable_str(type.get()) > 0 ||
      length > most) {
    refuse(file, fmt::format("{}: not text of at most {} bytes", source.path, most));
  }
  std::string all(source.rows * length, '\0');
  if (!all.empty() &&
      H5Dread(source.dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()) < 0) {
    refuse(file, fmt::format("{}: cannot be read", source.path));
  }
  std::vector<std::string> texts;
  for (std::size_t at = 0; at < all.size(); at += length) {
    const std::string text = all.substr(at, length);
    texts.emplace_back(text.c_str(), std::min(text.find('\0'), length));
  }
  return texts;
}

}  // namespace limpid
