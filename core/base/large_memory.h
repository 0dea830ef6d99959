// Memory for whole recordings, which may be larger than the computer's.
#pragma once

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace limpid {

// Error: neither memory nor disk has room. what() says how much was wanted, and where.
class NoRoom : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Blocks below this size are plain memory [bytes].
inline constexpr std::size_t kLargeBlock = std::size_t{1} << 20;
// Large blocks are plain memory as long as all of them together take at most this [bytes].
inline constexpr std::size_t kPlainBudget = std::size_t{512} << 20;

// Takes a block of at least kLargeBlock bytes, aligned to a page. Beyond kPlainBudget the block is
// a mapped file without a name, in $TMPDIR or else in /var/tmp: the kernel writes its pages there
// and drops them when memory is short. Where the disk has no such room, or less than 1 GiB would be
// left on it, the block is plain memory, up to a quarter of the computer's for all of them. Errors:
// NoRoom. Not for the haptic thread.
void* take_large_block(std::size_t bytes);
void give_back_large_block(void* block, std::size_t bytes) noexcept;
// Bytes of the large blocks that are files now.
std::size_t large_bytes_on_disk();
// Lets the kernel drop pages whose content the file has; a later access reads them again. Plain
// blocks stay.
void forget_large_blocks();

// Forgetting for code that fills or reads blocks from end to end: every 64 MiB.
class ForgetBehind {
 public:
  void passed(std::size_t bytes) {
    since_ += bytes;
    if (since_ < kAfter) return;
    since_ = 0;
    forget_large_blocks();
  }

 private:
  static constexpr std::size_t kAfter = std::size_t{64} << 20;
  std::size_t since_ = 0;
};

std::size_t physical_memory();  // of this computer [bytes]
// Undoes mlockall() for blocks that are files.
void unlock_large_blocks();

template <class T>
struct LargeAllocator {
  using value_type = T;

  LargeAllocator() = default;
  template <class Other>
  explicit(false) LargeAllocator(const LargeAllocator<Other>&) {}

  T* allocate(std::size_t count) {
    if (count * sizeof(T) < kLargeBlock) return std::allocator<T>().allocate(count);
    return static_cast<T*>(take_large_block(count * sizeof(T)));
  }
  void deallocate(T* block, std::size_t count) noexcept {
    if (count * sizeof(T) < kLargeBlock) return std::allocator<T>().deallocate(block, count);
    give_back_large_block(block, count * sizeof(T));
  }
  friend bool operator==(const LargeAllocator&, const LargeAllocator&) { return true; }
};

template <class T>
using LargeVector = std::vector<T, LargeAllocator<T>>;

}  // namespace limpid
