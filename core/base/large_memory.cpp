#include "core/base/large_memory.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cstdlib>
#include <map>
#include <mutex>

#include "core/base/descriptor.h"

namespace limpid {

namespace {

// All large blocks of this process.
struct Blocks {
  std::mutex mutex;
  std::map<void*, std::size_t> on_disk;  // bytes of each
  std::size_t plain = 0, disk = 0;       // bytes of all
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

std::size_t physical_memory() {
  return static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) *
         static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

// Opens a file without a name; -1: the folder has none, or does not let this user write.
int nameless_file() {
  const std::string in = folder();
  const int file = ::open(in.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file >= 0) return file;
  std::string name = in + "/limpid-XXXXXX";
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

// Maps a nameless file. All its room on the disk is taken now: a full disk would end the program at
// a later write.
void* map_file(std::size_t bytes) {
  const Descriptor file(nameless_file());
  if (*file < 0 || ::fallocate(*file, 0, 0, static_cast<off_t>(bytes)) != 0) return nullptr;
  void* block = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, *file, 0);
  if (block == MAP_FAILED) return nullptr;
  ::munlock(block, bytes);
  return block;
}

void* map_plain(std::size_t bytes) {
  void* block = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  return block == MAP_FAILED ? nullptr : block;
}

[[noreturn]] void refuse(std::size_t bytes) {
  const std::string in = folder();
  struct statvfs disk {};
  const std::size_t free =
      ::statvfs(in.c_str(), &disk) == 0 ? disk.f_bavail * std::size_t{disk.f_frsize} : 0;
  throw NoRoom(
      fmt::format("{} MiB are needed, this computer's memory is {} MiB, and {} has {} MiB free; "
                  "TMPDIR names another folder",
                  bytes >> 20, physical_memory() >> 20, in, free >> 20));
}

}  // namespace

void* take_large_block(std::size_t bytes) {
  Blocks& all = blocks();
  const std::lock_guard lock(all.mutex);
  if (all.plain + bytes > kPlainBudget) {
    if (void* block = map_file(bytes)) {
      all.on_disk.emplace(block, bytes);
      all.disk += bytes;
      return block;
    }
    if (bytes > physical_memory() / 4) refuse(bytes);
  }
  void* block = map_plain(bytes);
  if (block == nullptr) refuse(bytes);
  all.plain += bytes;
  return block;
}

void give_back_large_block(void* block, std::size_t bytes) noexcept {
  Blocks& all = blocks();
  const std::lock_guard lock(all.mutex);
  ::munmap(block, bytes);
  (all.on_disk.erase(block) > 0 ? all.disk : all.plain) -= bytes;
}

std::size_t large_bytes_on_disk() {
  Blocks& all = blocks();
  const std::lock_guard lock(all.mutex);
  return all.disk;
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
