// The format: "HDF5 File Format Specification", III.E, Disk Format: Level 1E - Global Heap.
#include "devices/files/session/hdf5_heaps.h"

#include <fmt/format.h>

#include <bitset>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>

#include "devices/files/file_error.h"

namespace limpid::hdf5 {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kSignature = "GCOL\1\0\0\0"sv;  // and version 1
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

// Objects follow each other to the end of the heap: number, count, reserved, size; then that many
// bytes, padded to 8. Object 0 is free space, with its header in its size.
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

void check_heap(std::ifstream& in, std::uint64_t at, std::uint64_t file_size,
                const std::filesystem::path& file) {
  const std::string header = bytes_at(in, at, kHeader);
  if (header.size() == kHeader) {
    const auto size = number_at<std::uint64_t>(header, 8);
    if (size >= kHeader && size <= file_size - at && whole(bytes_at(in, at, size))) return;
  }
  throw FileError(fmt::format("{}: damaged (text at byte {})", file.string(), at));
}

}  // namespace

void check_heaps(const std::filesystem::path& file) {
  const std::uint64_t size = std::filesystem::file_size(file);
  std::ifstream in(file, std::ios::binary);
  // Blocks overlap, so that no signature is cut in two.
  for (std::uint64_t from = 0; from < size; from += kBlock) {
    const std::string block = bytes_at(in, from, kBlock + kSignature.size() - 1);
    // By its first letter, which numbers seldom have: memmem() looks at every byte of them.
    for (auto at = block.find(kSignature); at != std::string::npos;
         at = block.find(kSignature, at + 1)) {
      check_heap(in, from + at, size, file);
    }
  }
}

}  // namespace limpid::hdf5
