#include "devices/files/session/hdf5_reading.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <limits>

#include "devices/files/file_error.h"
#include "devices/files/session/hdf5_heaps.h"

namespace limpid::hdf5 {
namespace {

namespace fs = std::filesystem;

constexpr H5Z_filter_t kLastOwnFilter = 255;           // those above are loaded as plugins
constexpr std::uint64_t kLargestChunk = 256ULL << 20;  // [bytes] that HDF5 unpacks at once
constexpr std::uint64_t kMostPerByte = 1100;           // deflate packs 1032 bytes into one

[[noreturn]] void refuse(const fs::path& file, const std::string& path, const std::string& why) {
  throw FileError(fmt::format("{}: {}: {}", file.string(), path, why));
}

const char* kind_of_link(H5L_type_t type) {
  switch (type) {
    case H5L_TYPE_SOFT: return "a soft link";
    case H5L_TYPE_EXTERNAL: return "a link to another file";
    default: return "a link that another program defined";
  }
}

// Links are followed one by one: HDF5 itself would open what they name.
bool reached(hid_t root, const std::string& path, const fs::path& file) {
  std::size_t end = 0;
  const std::string inside = path.starts_with('/') ? path.substr(1) : path;
  do {
    end = std::min(inside.find('/', end + 1), inside.size());
    const std::string way = inside.substr(0, end);
    H5L_info_t link{};
    if (H5Lexists(root, way.c_str(), H5P_DEFAULT) <= 0) return false;
    if (H5Lget_info(root, way.c_str(), &link, H5P_DEFAULT) < 0) return false;
    if (link.type != H5L_TYPE_HARD) {
      refuse(file, "/" + way,
             fmt::format("is {}; allowed: hard links only", kind_of_link(link.type)));
    }
  } while (end < inside.size());
  return true;
}

void check_filters(hid_t creation, const std::string& path, const fs::path& file) {
  const int filters = H5Pget_nfilters(creation);
  for (int i = 0; i < filters; ++i) {
    unsigned flags = 0, configuration = 0;
    std::size_t values = 0;
    std::array<char, 64> name{};
    const H5Z_filter_t id = H5Pget_filter2(creation, static_cast<unsigned>(i), &flags, &values,
                                           nullptr, name.size(), name.data(), &configuration);
    if (id >= 0 && id <= kLastOwnFilter) continue;
    name.back() = '\0';
    refuse(file, path,
           fmt::format("is packed by filter {} (\"{}\"); allowed: those of HDF5 itself, as gzip",
                       id, name.data()));
  }
}

void check_chunks(hid_t creation, hid_t dataset, const std::string& path, const fs::path& file) {
  if (H5Pget_nfilters(creation) <= 0) return;
  std::array<hsize_t, H5S_MAX_RANK> extent{};
  const int rank = H5Pget_chunk(creation, H5S_MAX_RANK, extent.data());
  const Datatype type(H5Dget_type(dataset));
  auto bytes = static_cast<double>(H5Tget_size(type.get()));
  for (int i = 0; i < rank; ++i) {
    bytes *= static_cast<double>(extent[static_cast<std::size_t>(i)]);
  }
  if (bytes > static_cast<double>(kLargestChunk)) {
    refuse(file, path,
           fmt::format("is packed in chunks of {:.0f} MiB; allowed: at most {}", bytes / 0x1p20,
                       kLargestChunk >> 20));
  }
}

void check_storage(const Dataset& dataset, const std::string& path, const fs::path& file) {
  const Properties creation(H5Dget_create_plist(dataset.get()));
  if (!creation) refuse(file, path, "not a dataset that can be read");
  if (H5Pget_external_count(creation.get()) != 0) {
    refuse(file, path, "is stored in other files; allowed: in this file");
  }
  const H5D_layout_t layout = H5Pget_layout(creation.get());
  if (layout != H5D_COMPACT && layout != H5D_CONTIGUOUS && layout != H5D_CHUNKED) {
    refuse(file, path, "is put together from other datasets; allowed: stored in this file");
  }
  check_filters(creation.get(), path, file);
  if (layout == H5D_CHUNKED) check_chunks(creation.get(), dataset.get(), path, file);
}

}  // namespace

void check_regular_file(const fs::path& file) {
  if (const std::string why = why_not_found(file, "no such file"); !why.empty()) {
    throw FileError(fmt::format("{}: {}", file.string(), why));
  }
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    throw FileError(fmt::format("{}: not a file that can be read", file.string()));
  }
}

void check_before_opening(const fs::path& file) {
  check_regular_file(file);
  if (H5Fis_hdf5(file.c_str()) <= 0) {
    throw FileError(fmt::format("{}: not an HDF5 file, or cut off", file.string()));
  }
  check_heaps(file);
}

File open_to_read(const fs::path& file) {
  check_before_opening(file);
  File opened(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
  check(static_cast<bool>(opened), file, "cannot open");
  return opened;
}

bool has(hid_t root, const std::string& path, const fs::path& file) {
  return reached(root, path, file);
}

Dataset open_dataset(hid_t root, const std::string& path, const fs::path& file) {
  const char* const inside = path.c_str() + (path.starts_with('/') ? 1 : 0);
  Dataset dataset(reached(root, path, file) ? H5Dopen2(root, inside, H5P_DEFAULT)
                                            : H5I_INVALID_HID);
  if (!dataset) refuse(file, path, "not a dataset that can be read");
  check_storage(dataset, path, file);
  return dataset;
}

Group open_group(hid_t root, const std::string& path, const fs::path& file) {
  const char* const inside = path.c_str() + (path.starts_with('/') ? 1 : 0);
  Group group(reached(root, path, file) ? H5Gopen2(root, inside, H5P_DEFAULT) : H5I_INVALID_HID);
  if (!group) refuse(file, path, "not a group that can be read");
  return group;
}

std::uint64_t physical_memory() {
  return static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
         static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

Claims::Claims(fs::path file, std::uint64_t most)
    : file_(std::move(file)), file_size_(fs::file_size(file_)), most_(most) {}

// Several datasets may claim the same bytes, but all of them together lie in the file.
void Claims::stored(const Dataset& dataset) {
  H5G_stat_t object{};
  if (H5Gget_objinfo(dataset.get(), ".", true, &object) < 0) return;
  if (!counted_.emplace(object.objno[0], object.objno[1]).second) return;
  const std::uint64_t size = H5Dget_storage_size(dataset.get());
  stored_ = std::min(file_size_, stored_ + std::min(size, file_size_));
}

void Claims::take(std::uint64_t count, std::uint64_t size, const std::string& what) {
  constexpr std::uint64_t kEndless = std::numeric_limits<std::uint64_t>::max() / 4;
  const std::uint64_t bytes = count > kEndless / size ? kEndless : count * size;
  taken_ = std::min(kEndless, taken_ + bytes);
  if (taken_ / kMostPerByte > stored_) {
    refuse(file_, what,
           fmt::format("claims {} values, more than a file of its size can hold", count));
  }
  if (taken_ > most_) {
    refuse(
        file_, what,
        fmt::format("larger than this computer's memory: {} MiB of {}", taken_ >> 20, most_ >> 20));
  }
}

}  // namespace limpid::hdf5
