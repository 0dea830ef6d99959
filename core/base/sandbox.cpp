// The sandbox by Landlock, see landlock(7), and a filter of system calls in classic BPF, see
// seccomp(2).
#include "core/base/sandbox.h"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <stdexcept>
#include <vector>

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr int kFirstToClose = 4;  // stdin, stdout, stderr and one more stay

[[noreturn]] void refuse() {
  throw std::runtime_error(
      "cannot be read: the kernel does not allow the sandbox that the reading program needs");
}

// Restricts files by Landlock. Has no effect where the kernel has none; the filter of calls still
// forbids all writing.
void restrict_files(const fs::path& place) {
  const long version =
      ::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
  if (version < 1) return;
  landlock_ruleset_attr rules{};
  rules.handled_access_fs = (LANDLOCK_ACCESS_FS_MAKE_SYM << 1) - 1;  // all of version 1
  if (version >= 2) rules.handled_access_fs |= LANDLOCK_ACCESS_FS_REFER;
  const int set = static_cast<int>(::syscall(SYS_landlock_create_ruleset, &rules, sizeof rules, 0));
  if (set < 0) refuse();
  if (const int opened = place.empty() ? -1 : ::open(place.c_str(), O_PATH | O_CLOEXEC);
      opened >= 0) {
    std::error_code none;
    landlock_path_beneath_attr rule{};
    rule.allowed_access = LANDLOCK_ACCESS_FS_READ_FILE;
    if (fs::is_directory(place, none)) rule.allowed_access |= LANDLOCK_ACCESS_FS_READ_DIR;
    rule.parent_fd = opened;
    ::syscall(SYS_landlock_add_rule, set, LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
    ::close(opened);
  }
  const bool done = ::syscall(SYS_landlock_restrict_self, set, 0) == 0;
  ::close(set);
  if (!done) refuse();
}

#if defined(__x86_64__) || defined(__aarch64__)

#ifdef __x86_64__
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_X86_64;
#else
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_AARCH64;
#endif

// Calls for reading a file, for memory, and for an orderly end. None of these has another use;
// calls that have one are allowed by their arguments, below. Writing needs a descriptor that is
// open for it.
constexpr int kAllowed[] = {
    SYS_read,
    SYS_pread64,
    SYS_readv,
    SYS_write,
    SYS_pwrite64,
    SYS_writev,
    SYS_ftruncate,
    SYS_close,
    SYS_lseek,
    SYS_fstat,
    SYS_newfstatat,
    SYS_statx,
    SYS_readlinkat,
    SYS_faccessat,
    SYS_faccessat2,
    SYS_getcwd,
    SYS_munmap,
    SYS_mremap,
    SYS_brk,
    SYS_futex,
    SYS_exit,
    SYS_exit_group,
    SYS_rt_sigreturn,
    SYS_rt_sigaction,
    SYS_rt_sigprocmask,
    SYS_getpid,
    SYS_gettid,
    SYS_getrandom,
    SYS_clock_gettime,
    SYS_gettimeofday,
    SYS_restart_syscall,
    SYS_sched_yield,
    SYS_clock_nanosleep,
    SYS_sysinfo,
#ifdef __x86_64__
    SYS_stat,
    SYS_lstat,
    SYS_access,
    SYS_readlink,
    SYS_time,
#endif
};

// Offset of an argument's lower half, which both kinds of processor have first; no flag and no
// process id needs more.
constexpr std::uint32_t argument(unsigned i) {
  return static_cast<std::uint32_t>(offsetof(seccomp_data, args) + i * sizeof(std::uint64_t));
}

class Filter {
 public:
  Filter() {
    load(offsetof(seccomp_data, arch));
    add(BPF_JMP | BPF_JEQ | BPF_K, kArchitecture, 1, 0);
    answer(SECCOMP_RET_KILL_PROCESS);
    load(offsetof(seccomp_data, nr));
  }

  void allow(int call) { when(call, 1), answer(SECCOMP_RET_ALLOW); }
  // Allows the call where none of these bits is set in the argument.
  void allow_without(int call, unsigned which, std::uint32_t flags) {
    when(call, 4);
    load(argument(which));
    add(BPF_JMP | BPF_JSET | BPF_K, flags, 1, 0);
    answer(SECCOMP_RET_ALLOW);
    answer(SECCOMP_RET_ERRNO | EACCES);
  }
  // Allows the call where the argument is one of these.
  void allow_with(int call, unsigned which, std::initializer_list<std::uint32_t> values) {
    const auto count = static_cast<std::uint8_t>(values.size());
    when(call, static_cast<std::uint8_t>(count + 3));
    load(argument(which));
    std::uint8_t left = count;
    for (const std::uint32_t value : values) add(BPF_JMP | BPF_JEQ | BPF_K, value, left--, 0);
    answer(SECCOMP_RET_ERRNO | EPERM);
    answer(SECCOMP_RET_ALLOW);
  }
  // Allows the call where its first argument is 0 and the pointer is null.
  void allow_asking(int call, unsigned pointer) {
    when(call, 8);
    load(argument(0));
    add(BPF_JMP | BPF_JEQ | BPF_K, 0, 0, 5);
    load(argument(pointer));
    add(BPF_JMP | BPF_JEQ | BPF_K, 0, 0, 3);
    load(argument(pointer) + sizeof(std::uint32_t));
    add(BPF_JMP | BPF_JEQ | BPF_K, 0, 0, 1);
    answer(SECCOMP_RET_ALLOW);
    answer(SECCOMP_RET_ERRNO | EPERM);
  }
  bool install() {
    answer(SECCOMP_RET_ERRNO | EPERM);
    const sock_fprog program{static_cast<unsigned short>(code_.size()), code_.data()};
    return ::syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, 0, &program) == 0;
  }

 private:
  void add(int what, std::uint32_t k, std::uint8_t if_so = 0, std::uint8_t if_not = 0) {
    code_.push_back({static_cast<std::uint16_t>(what), if_so, if_not, k});
  }
  void load(std::size_t at) { add(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(at)); }
  void answer(std::uint32_t what) { add(BPF_RET | BPF_K, what); }
  // Skips the next `length` instructions unless the loaded number is that of `call`.
  void when(int call, std::uint8_t length) {
    add(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(call), 0, length);
  }

  std::vector<sock_filter> code_;
};

void restrict_calls() {
  Filter filter;
  for (const int call : kAllowed) filter.allow(call);
  constexpr std::uint32_t kWrites = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC;
  filter.allow_without(SYS_openat, 2, kWrites);
  filter.allow_without(SYS_mmap, 2, PROT_EXEC);
  filter.allow_without(SYS_mprotect, 2, PROT_EXEC);
#ifdef __x86_64__
  filter.allow_without(SYS_open, 1, kWrites);
#endif
  // Other uses of fcntl send signals: F_SETOWN, F_SETSIG, F_NOTIFY, O_ASYNC by F_SETFL.
  filter.allow_with(SYS_fcntl, 1, {F_GETFD, F_SETFD, F_GETFL, F_DUPFD_CLOEXEC});
  filter.allow_with(SYS_madvise, 2, {MADV_DONTNEED, MADV_FREE});               // free()
  filter.allow_with(SYS_tgkill, 0, {static_cast<std::uint32_t>(::getpid())});  // abort()
  filter.allow_asking(SYS_prlimit64, 2);  // the process's own limits, which it cannot change
  if (!filter.install()) refuse();
}

#else

void restrict_calls() {}

#endif

}  // namespace

void enter_sandbox(const fs::path& place) {
  if (kSanitized) return;
  ::closefrom(kFirstToClose);
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) refuse();
  restrict_files(place);
  restrict_calls();
}

}  // namespace limpid
