#include <fcntl.h>
#include <gtest/gtest.h>
#include <link.h>
#include <malloc.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "core/base/sanitized.h"
#include "core/realtime/realtime.h"
#include "tests/support/computer.h"

namespace limpid {
namespace {

const auto kPage = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));

enum Verdict : int { yes, no, skipped };

// Runs `work` in a child process, whose memory nothing has locked before. Pages of files that this
// process has used are not mapped there yet.
Verdict in_a_child(const std::function<Verdict()>& work) {
  const pid_t child = fork();
  if (child == 0) _exit(work());
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status));
  return static_cast<Verdict>(WEXITSTATUS(status));
}

// Number of pages that are not in memory; -1 if the kernel does not say.
int absent(std::uintptr_t from, std::uintptr_t to) {
  const int pagemap = open("/proc/self/pagemap", O_RDONLY | O_CLOEXEC);
  if (pagemap < 0) return -1;
  int count = 0;
  for (std::uintptr_t page = from / kPage; page * kPage < to; ++page) {
    std::uint64_t entry = 0;
    const auto at = static_cast<off_t>(page * sizeof entry);
    if (pread(pagemap, &entry, sizeof entry, at) != sizeof entry) return -1;
    if ((entry >> 63) == 0) ++count;
  }
  close(pagemap);
  return count;
}

int absent(const void* from, std::size_t bytes) {
  const auto at = reinterpret_cast<std::uintptr_t>(from);
  return absent(at, at + bytes);
}

struct Code {
  std::string_view library;  // beginning of its name; empty: the program
  int absent = 0, pages = 0;
};

// Adds up the code pages of one library.
int look(dl_phdr_info* object, std::size_t, void* into) {
  Code& code = *static_cast<Code*>(into);
  std::string_view name = object->dlpi_name;
  name.remove_prefix(name.rfind('/') + 1);
  if (code.library.empty() ? !name.empty() : !name.starts_with(code.library)) return 0;
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const ElfW(Phdr)& segment = object->dlpi_phdr[i];
    if (segment.p_type != PT_LOAD || (segment.p_flags & PF_X) == 0) continue;
    const std::uintptr_t from = object->dlpi_addr + segment.p_vaddr;
    code.absent += absent(from, from + segment.p_memsz);
    code.pages += static_cast<int>(segment.p_memsz / kPage);
  }
  return 0;
}

bool may_lock() { return !kSanitized && test::may_lock_memory(); }

class CodeOfTicks : public testing::TestWithParam<std::string_view> {};

TEST_P(CodeOfTicks, IsThereBeforeTheFirstOne) {
  const Verdict there = in_a_child([] {
    Code before{GetParam()}, after{GetParam()};
    dl_iterate_phdr(look, &before);
    if (!may_lock() || before.absent < 0) return skipped;
    if (!lock_memory()) return no;
    dl_iterate_phdr(look, &after);
    return after.pages > 0 && before.absent > 0 && after.absent == 0 ? yes : no;
  });
  if (there == skipped) GTEST_SKIP() << "memory cannot be locked here";
  EXPECT_EQ(there, yes);
}

INSTANTIATE_TEST_SUITE_P(LockMemory, CodeOfTicks, testing::Values("", "libc.so", "libstdc++.so"));

// Reserved memory, as of threads' stacks and malloc, is many times the used memory.
TEST(LockMemory, BringsInNothingThatNobodyUsesHoweverOften) {
  const Verdict left = in_a_child([] {
    constexpr std::size_t kBytes = 1 << 20;
    const void* reserved =
        mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (reserved == MAP_FAILED || !may_lock()) return skipped;
    if (!lock_memory() || !lock_memory()) return no;
    const int count = absent(reserved, kBytes);
    return count < 0 ? skipped : count == static_cast<int>(kBytes / kPage) ? yes : no;
  });
  if (left == skipped) GTEST_SKIP() << "memory cannot be locked here";
  EXPECT_EQ(left, yes);
}

TEST(LockMemory, KeepsWhatIsMappedLaterOnceItIsTouched) {
  const Verdict kept = in_a_child([] {
    if (!may_lock()) return skipped;
    if (!lock_memory()) return no;
    void* later = mmap(nullptr, kPage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (later == MAP_FAILED) return skipped;
    *static_cast<volatile char*>(later) = 1;
    // Locked memory cannot be given up.
    return madvise(later, kPage, MADV_DONTNEED) != 0 && absent(later, kPage) == 0 ? yes : no;
  });
  if (kept == skipped) GTEST_SKIP() << "memory cannot be locked here";
  EXPECT_EQ(kept, yes);
}

// Freed large blocks make malloc keep others of their size.
TEST(GiveBackWhatIsFreed, GivesBackLargeBlocksThatLieUnderSmallOnes) {
  const Verdict given_back = in_a_child([] {
    give_back_what_is_freed();
    lock_memory();
    constexpr std::size_t kBytes = 1 << 20;
    const auto taken = [] { return mallinfo2().arena; };  // size of the heap
    const auto fill = [](std::size_t bytes) {
      auto block = std::make_unique<std::vector<char>>(bytes, 'x');
      return block;
    };
    fill(20 * kBytes).reset();
    const std::size_t before = taken();
    std::vector<std::unique_ptr<std::vector<char>>> large, small;
    for (int i = 0; i < 20; ++i) {
      large.push_back(fill(kBytes));
      small.push_back(fill(100));
    }
    large.clear();
    return taken() < before + kBytes ? yes : no;
  });
  EXPECT_EQ(given_back, yes);
}

}  // namespace
}  // namespace limpid
