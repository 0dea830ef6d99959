#include "devices/files/session/hdf5_reading.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>

#include "devices/files/text_file.h"

namespace limpid::hdf5 {
namespace {

constexpr std::size_t kLongestText = std::size_t{64} << 20;  // [bytes]

struct Reasons {
  std::string system;
  std::string innermost;
};

// Collects reasons. HDF5 hides errno in its text: "file write failed: ..., errno = 28, error
// message = ...".
herr_t collect(unsigned, const H5E_error2_t* error, void* data) {
  auto& reasons = *static_cast<Reasons*>(data);
  const std::string text = error->desc ? error->desc : "";
  if (reasons.innermost.empty()) reasons.innermost = text;
  const auto at = text.find("errno = ");
  if (reasons.system.empty() && at != std::string::npos) {
    const int code = std::atoi(text.c_str() + at + std::strlen("errno = "));
    if (code != 0) reasons.system = std::strerror(code);
  }
  return 0;
}

[[noreturn]] void refuse(const std::filesystem::path& file, const char* name, const char* found,
                         const char* allowed) {
  throw FileError(
      fmt::format("{}: attribute {}: {}; needed: {}", file.string(), name, found, allowed));
}

// Opens a scalar attribute of one class of type.
Attribute open_scalar(hid_t object, const char* name, H5T_class_t wanted, const char* allowed,
                      const std::filesystem::path& file) {
  if (H5Aexists(object, name) <= 0) refuse(file, name, "missing", allowed);
  Attribute attribute(H5Aopen(object, name, H5P_DEFAULT));
  const Datatype type(H5Aget_type(attribute.get()));
  const Dataspace space(H5Aget_space(attribute.get()));
  if (!attribute || !type || !space) refuse(file, name, "unreadable", allowed);
  if (H5Sget_simple_extent_npoints(space.get()) != 1) {
    refuse(file, name, "not a single value", allowed);
  }
  if (H5Tget_class(type.get()) != wanted) refuse(file, name, "of another type", allowed);
  return attribute;
}

Datatype text_type() {
  Datatype type(H5Tcopy(H5T_C_S1));
  H5Tset_size(type.get(), H5T_VARIABLE);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  return type;
}

using namespace std::string_view_literals;

constexpr std::string_view kSignature = "GCOL\1\0\0\0"sv;  // with version 1
constexpr std::uint64_t kHeader = 16;                      // of a heap, and of each object in it
constexpr std::size_t kBlock = 1 << 20;

// `size` bytes at `at`; fewer at the end of the file.
std::string bytes_at(std::ifstream& in, std::uint64_t at, std::uint64_t size) {
  std::string bytes(size, '\0');
  in.clear();
  in.seekg(static_cast<std::streamoff>(at));
  in.read(bytes.data(), static_cast<std::streamsize>(size));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

template <class T>
T number_at(std::string_view bytes, std::uint64_t at) {
  T x;
  std::memcpy(&x, bytes.data() + at, sizeof x);
  return x;
}

// Returns whether objects fill a heap, by the "HDF5 File Format Specification", III.E, Disk Format:
// Level 1E - Global Heap. Each has number, count, reserved, size; then that many bytes, padded to
// 8. Object 0 is free space, with its header in its size.
bool whole(std::string_view heap) {
  std::bitset<65536> seen;
  std::uint64_t at = kHeader;
  while (heap.size() - at >= kHeader) {
    const auto number = number_at<std::uint16_t>(heap, at);
    const auto size = number_at<std::uint64_t>(heap, at + 8);
    const std::uint64_t room = heap.size() - at;
    if (size > room || seen[number]) return false;
    seen.set(number);
    const std::uint64_t taken = number == 0 ? size : kHeader + (size + 7) / 8 * 8;
    if (taken < kHeader || taken > room) return false;
    at += taken;
  }
  return true;
}

// Returns how much there is of a file that is shorter than it says; empty if it is not. The
// superblock has the length of the whole at a place of its own in each version.
std::string cut_off(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::array<char, 52> head{};
  if (!in.read(head.data(), head.size())) return {};
  std::uint64_t promised = 0;
  std::memcpy(&promised,
              head.data() + (head[8] == 0   ? 40
                             : head[8] == 1 ? 44
                                            : 28),
              sizeof promised);
  std::error_code none;
  const std::uint64_t there = std::filesystem::file_size(file, none);
  if (none || there >= promised) return {};
  return fmt::format("the file ends after {:.3g} of {:.3g} MB; was the file copied completely?",
                     1e-6 * static_cast<double>(there), 1e-6 * static_cast<double>(promised));
}

void check_heap(std::ifstream& in, std::uint64_t at, std::uint64_t file_size,
                const std::filesystem::path& file) {
  const std::string header = bytes_at(in, at, kHeader);
  if (header.size() == kHeader) {
    const auto size = number_at<std::uint64_t>(header, 8);
    if (size >= kHeader && size <= file_size - at && whole(bytes_at(in, at, size))) return;
  }
  const std::string cut = cut_off(file);
  throw FileError(fmt::format("{}: damaged ({})", file.string(),
                              cut.empty() ? fmt::format("text at byte {}", at) : cut));
}

namespace fs = std::filesystem;

constexpr H5Z_filter_t kLastOwnFilter = 255;           // filters above are loaded as plugins
constexpr std::uint64_t kLargestChunk = 256ULL << 20;  // [bytes] that HDF5 unpacks at once
constexpr std::uint64_t kMostPerByte = 1100;           // deflate packs 1032 bytes into one

[[noreturn]] void refuse(const fs::path& file, const std::string& path, const std::string& why) {
  throw FileError(fmt::format("{}: {}: {}", file.string(), path, why));
}

const char* kind_of_link(H5L_type_t type) {
  switch (type) {
    case H5L_TYPE_SOFT: return "a soft link";
    case H5L_TYPE_EXTERNAL: return "a link to another file";
    default: return "an HDF5 link of a type that another program defined";
  }
}

// Returns whether `path` exists. Follows links one by one: HDF5 would open what they name.
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
           fmt::format("is compressed by filter {} (\"{}\"); allowed: the filters that come with "
                       "HDF5, for example gzip",
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
    refuse(file, path, "is stored in other files; allowed: data in this file");
  }
  const H5D_layout_t layout = H5Pget_layout(creation.get());
  if (layout != H5D_COMPACT && layout != H5D_CONTIGUOUS && layout != H5D_CHUNKED) {
    refuse(file, path,
           "is put together from other datasets; needed: data that are stored in this file");
  }
  check_filters(creation.get(), path, file);
  if (layout == H5D_CHUNKED) check_chunks(creation.get(), dataset.get(), path, file);
}

}  // namespace

std::string last_error() {
  Reasons reasons;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, &collect, &reasons);
  if (!reasons.system.empty()) return reasons.system;
  return reasons.innermost.empty() ? "HDF5 gives no reason" : reasons.innermost;
}

std::string why_not_opened(const fs::path& file) {
  const std::string cut = cut_off(file);
  return cut.empty() ? last_error() : cut;
}

void check(bool ok, const std::filesystem::path& file, const char* what) {
  if (!ok) throw FileError(fmt::format("{}: {}: {}", file.string(), what, last_error()));
}

void write_texts(hid_t object, const char* name, const std::vector<std::string>& texts,
                 const std::filesystem::path& file) {
  const Datatype type = text_type();
  std::vector<const char*> pointers;
  for (const std::string& text : texts) pointers.push_back(text.c_str());
  const hsize_t count = pointers.size();
  const Dataspace space(H5Screate_simple(1, &count, nullptr));
  const Attribute attribute(
      H5Acreate2(object, name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT));
  check(attribute && H5Awrite(attribute.get(), type.get(), pointers.data()) >= 0, file,
        "cannot write");
}

void write_text(hid_t object, const char* name, const std::string& text,
                const std::filesystem::path& file) {
  const Datatype type = text_type();
  const char* pointer = text.c_str();
  write_scalar(object, name, type.get(), type.get(), &pointer, file);
}

void write_scalar(hid_t object, const char* name, hid_t stored_as, hid_t held_as, const void* value,
                  const std::filesystem::path& file) {
  const Dataspace space(H5Screate(H5S_SCALAR));
  const Attribute attribute(
      H5Acreate2(object, name, stored_as, space.get(), H5P_DEFAULT, H5P_DEFAULT));
  check(attribute && H5Awrite(attribute.get(), held_as, value) >= 0, file, "cannot write");
}

std::string read_text(hid_t object, const char* name, const std::filesystem::path& file) {
  const Attribute attribute = open_scalar(object, name, H5T_STRING, "text", file);
  const Datatype type(H5Aget_type(attribute.get()));
  if (H5Tis_variable_str(type.get()) > 0) {
    char* text = nullptr;
    if (H5Aread(attribute.get(), type.get(), &text) < 0) {
      refuse(file, name, "unreadable", "text");
    }
    const std::string copy = text ? text : "";
    H5free_memory(text);
    return copy;
  }
  if (H5Tget_size(type.get()) > kLongestText) refuse(file, name, "too long", "at most 64 MiB");
  std::string text(H5Tget_size(type.get()), '\0');
  if (H5Aread(attribute.get(), type.get(), text.data()) < 0) {
    refuse(file, name, "unreadable", "text");
  }
  text.resize(std::strlen(text.c_str()));
  return text;
}

std::vector<std::string> read_texts(hid_t object, const char* name, std::size_t most,
                                    const std::filesystem::path& file) {
  constexpr const char* kNeeded = "a list of texts";
  const Attribute attribute(H5Aopen(object, name, H5P_DEFAULT));
  const Datatype type(attribute ? H5Aget_type(attribute.get()) : H5I_INVALID_HID);
  const Dataspace space(attribute ? H5Aget_space(attribute.get()) : H5I_INVALID_HID);
  if (!type || !space) refuse(file, name, "unreadable", kNeeded);
  if (H5Tget_class(type.get()) != H5T_STRING) refuse(file, name, "of another type", kNeeded);
  const hssize_t count = H5Sget_simple_extent_npoints(space.get());
  if (count < 0 || static_cast<std::size_t>(count) > most) {
    refuse(file, name, "too many", kNeeded);
  }
  const auto texts = static_cast<std::size_t>(count);
  std::vector<std::string> all;
  if (H5Tis_variable_str(type.get()) > 0) {
    std::vector<char*> pointers(texts, nullptr);
    if (H5Aread(attribute.get(), type.get(), pointers.data()) < 0) {
      refuse(file, name, "unreadable", kNeeded);
    }
    for (char* text : pointers) {
      all.emplace_back(text ? text : "");
      H5free_memory(text);
    }
    return all;
  }
  const std::size_t length = H5Tget_size(type.get());
  std::string bytes(texts * length, '\0');
  if (H5Aread(attribute.get(), type.get(), bytes.data()) < 0) {
    refuse(file, name, "unreadable", kNeeded);
  }
  for (std::size_t at = 0; at < bytes.size(); at += length) {
    all.emplace_back(bytes.substr(at, length).c_str());
  }
  return all;
}

double read_number(hid_t object, const char* name, const std::filesystem::path& file) {
  const Attribute attribute = open_scalar(object, name, H5T_FLOAT, "a number", file);
  double value = 0;
  if (H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, &value) < 0) {
    refuse(file, name, "unreadable", "a number");
  }
  return value;
}

unsigned long long read_count(hid_t object, const char* name, const std::filesystem::path& file) {
  const Attribute attribute = open_scalar(object, name, H5T_INTEGER, "a whole number", file);
  unsigned long long value = 0;
  if (H5Aread(attribute.get(), H5T_NATIVE_ULLONG, &value) < 0) {
    refuse(file, name, "unreadable", "a whole number");
  }
  return value;
}

void check_heaps(const std::filesystem::path& file) {
  const std::uint64_t size = std::filesystem::file_size(file);
  std::ifstream in(file, std::ios::binary);
  // Blocks overlap, so that no signature is cut in two.
  for (std::uint64_t from = 0; from < size; from += kBlock) {
    const std::string block = bytes_at(in, from, kBlock + kSignature.size() - 1);
    // find() looks for the first letter, which numbers seldom have; memmem() looks at every byte.
    for (auto at = block.find(kSignature); at != std::string::npos;
         at = block.find(kSignature, at + 1)) {
      check_heap(in, from + at, size, file);
    }
  }
}

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
    throw FileError(fmt::format("{}: not an HDF5 file, or its end is missing", file.string()));
  }
  check_heaps(file);
}

File open_to_read(const fs::path& file) {
  check_before_opening(file);
  File opened(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
  if (!opened) {
    throw FileError(fmt::format("{}: cannot open: {}", file.string(), why_not_opened(file)));
  }
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

Claims::Claims(fs::path file, std::uint64_t most)
    : file_(std::move(file)), file_size_(fs::file_size(file_)), most_(most) {}

// Adds a dataset's size. Several datasets may claim the same bytes, but all of them lie in the
// file.
void Claims::stored(const Dataset& dataset) {
  H5G_stat_t object{};
  if (H5Gget_objinfo(dataset.get(), ".", true, &object) < 0) return;
  if (!counted_.emplace(object.objno[0], object.objno[1]).second) return;
  const std::uint64_t size = H5Dget_storage_size(dataset.get());
  stored_ = std::min(file_size_, stored_ + std::min(size, file_size_));
}

void Claims::pass(std::uint64_t count, std::uint64_t size, const std::string& what) {
  constexpr std::uint64_t kEndless = std::numeric_limits<std::uint64_t>::max() / 4;
  const std::uint64_t bytes = count > kEndless / size ? kEndless : count * size;
  passed_ = std::min(kEndless, passed_ + bytes);
  if (passed_ / kMostPerByte <= stored_) return;
  refuse(file_, what,
         fmt::format("says that it has {} values, more than a file of its size can have", count));
}

void Claims::take(std::uint64_t count, std::uint64_t size, const std::string& what) {
  pass(count, size, what);
  taken_ += count * size;
  if (taken_ > most_) {
    refuse(file_, what,
           fmt::format("larger than this computer's memory: {} MiB; allowed: {}", taken_ >> 20,
                       most_ >> 20));
  }
}

}  // namespace limpid::hdf5
