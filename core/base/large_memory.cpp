#include "core/base/large_memory.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/statfs.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>

#include "core/base/descriptor.h"

namespace limpid {

namespace {

// Recordings beside this program need the disk as well [bytes].
constexpr std::uint64_t kLeftOnDisk = std::uint64_t{1} << 30;

// Every large block of this process. Nothing slow happens under the mutex: threads that lock memory
// wait for it.
struct Blocks {
  std::mutex mutex;
  std::map<void*, std::size_t> on_disk;  // bytes of each
  std::size_t plain = 0;                 // bytes of all others
};

// Never destroyed: blocks may be given back after main() has returned.
Blocks& blocks() {
  static auto* const all = new Blocks;
  return *all;
}

std::string folder() {
  const char* wanted = std::getenv("TMPDIR");
  return wanted != nullptr && *wanted != '\0' ? wanted : "/var/tmp";
}

// A file without a name; -1: the folder has none, or does not let this user write.
int nameless_file(const std::string& in) {
  const int file = ::open(in.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file >= 0) return file;
  std::string name = in + "/limpid-XXXXXX";
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

// btrfs, ZFS and bcachefs write elsewhere what is written again: room that was taken is no promise.
// tmpfs and ramfs are memory themselves.
bool keeps_its_room(int file) {
  constexpr std::array<std::uint32_t, 5> kOthers{0x9123683e, 0x2fc12fc1, 0xca451a4e, 0x01021994,
                                                 0x858458f6};
  struct statfs about {};
  return ::fstatfs(file, &about) == 0 &&
         std::ranges::count(kOthers, static_cast<std::uint32_t>(about.f_type)) == 0;
}

// A mapped file, or why there is none. Its room on the disk is taken at once: a full disk would end
// the program at a later write. Children do not get it: they would keep the file.
struct Mapped {
  void* block = nullptr;
  std::string why;
};

Mapped map_file(std::size_t bytes) {
  const std::string in = folder();
  const auto failed = [&] { return Mapped{nullptr, in + ": " + std::strerror(errno)}; };
  const Descriptor file(nameless_file(in));
  if (*file < 0) return failed();
  if (!keeps_its_room(*file))
    return {nullptr,
            in + ": the file system is in main memory, or cannot reserve space for a file"};
  struct statvfs disk {};
  if (::fstatvfs(*file, &disk) != 0) return failed();
  const std::uint64_t free = std::uint64_t{disk.f_bavail} * disk.f_frsize;
  if (free < bytes + kLeftOnDisk) {
    return {nullptr,
            fmt::format("{}: {} MiB of the disk are free, and Limpid must leave {} MiB free", in,
                        free >> 20, kLeftOnDisk >> 20)};
  }
  if (::fallocate(*file, 0, 0, static_cast<off_t>(bytes)) != 0) return failed();
  void* block = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, *file, 0);
  if (block == MAP_FAILED) return failed();
  ::munlock(block, bytes);
  ::madvise(block, bytes, MADV_DONTFORK);
  return {block, ""};
}

// Takes note of so many bytes of plain memory, if there may be as many.
bool may_be_plain(std::size_t bytes, std::size_t most) {
  Blocks& all = blocks();
  const std::lock_guard lock(all.mutex);
  if (bytes > most || all.plain > most - bytes) return false;
  all.plain += bytes;
  return true;
}

void* map_plain(std::size_t bytes) {
  void* block = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (block != MAP_FAILED) return block;
  Blocks& all = blocks();
  const std::lock_guard lock(all.mutex);
  all.plain -= bytes;
  return nullptr;
}

}  // namespace

void* take_large_block(std::size_t bytes) {
  if (may_be_plain(bytes, kPlainBudget)) {
    if (void* block = map_plain(bytes)) return block;
  }
  const Mapped file = map_file(bytes);
  if (file.block != nullptr) {
    Blocks& all = blocks();
    const std::lock_guard lock(all.mutex);
    all.on_disk.emplace(file.block, bytes);
    return file.block;
  }
  const std::size_t memory = physical_memory();
  if (may_be_plain(bytes, std::max(kPlainBudget, memory / 4))) {
    if (void* block = map_plain(bytes)) return block;
  }
  throw NoRoom(
      fmt::format("{} MiB more main memory (RAM) are needed. This computer has {} MiB in total. A "
                  "file on the disk cannot be used instead: {}. Set TMPDIR to another folder",
                  bytes >> 20, memory >> 20, file.why));
}

void give_back_large_block(void* block, std::size_t bytes) noexcept {
  {
    Blocks& all = blocks();
    const std::lock_guard lock(all.mutex);
    if (all.on_disk.erase(block) == 0) all.plain -= bytes;
  }
  ::munmap(block, bytes);
}

std::size_t large_bytes_on_disk() {
  Blocks& all = blocks();
  const std::lock_guard lock(all.mutex);
  std::size_t sum = 0;
  for (const auto& [block, bytes] : all.on_disk) sum += bytes;
  return sum;
}

std::size_t physical_memory() {
  return static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) *
         static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

void forget_large_blocks() {
  Blocks& all = blocks();
  const std::lock_guard lock(all.mutex);
  for (const auto& [block, bytes] : all.on_disk) ::madvise(block, bytes, MADV_DONTNEED);
}

void unlock_large_blocks() {
  Blocks& all = blocks();
  const std::lock_guard lock(all.mutex);
  for (const auto& [block, bytes] : all.on_disk) ::munlock(block, bytes);
}

}  // namespace limpid
