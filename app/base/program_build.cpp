#include "app/base/program_build.h"

#include <elf.h>
#include <fmt/format.h>
#include <link.h>
#include <sys/utsname.h>

#include <cstring>
#include <string_view>
#ifdef __x86_64__
#include <sys/platform/x86.h>
#endif

#include "app/base/version.h"

namespace limpid {
namespace {

constexpr std::size_t kDigits = 12;  // of the linker's number, which tell one build from another
constexpr std::string_view kBetween = "; ";

#ifdef __clang__
constexpr const char* kCompiler = "clang " __clang_version__;
#else
constexpr const char* kCompiler = "GCC " __VERSION__;
#endif

// Returns the number in a segment of notes; empty if it has none.
std::string number_in(const char* notes, std::size_t size) {
  const auto padded = [](std::size_t n) { return (n + 3) / 4 * 4; };
  for (std::size_t at = 0; at + sizeof(ElfW(Nhdr)) <= size;) {
    ElfW(Nhdr) head;
    std::memcpy(&head, notes + at, sizeof head);
    const std::size_t name = at + sizeof head, bytes = name + padded(head.n_namesz);
    if (bytes + head.n_descsz > size) break;
    if (head.n_type == NT_GNU_BUILD_ID && std::string_view(notes + name, 3) == "GNU") {
      std::string digits;
      for (std::size_t i = 0; i < head.n_descsz && digits.size() < kDigits; ++i) {
        digits += fmt::format("{:02x}", static_cast<unsigned char>(notes[bytes + i]));
      }
      return digits;
    }
    at = bytes + padded(head.n_descsz);
  }
  return {};
}

// Takes the number of the first object, which is the program.
int take_number(dl_phdr_info* object, std::size_t, void* into) {
  auto& number = *static_cast<std::string*>(into);
  for (int i = 0; i < object->dlpi_phnum && number.empty(); ++i) {
    const ElfW(Phdr)& segment = object->dlpi_phdr[i];
    if (segment.p_type != PT_NOTE) continue;
    number = number_in(reinterpret_cast<const char*>(object->dlpi_addr + segment.p_vaddr),
                       segment.p_memsz);
  }
  return 1;
}

std::string linked() {
  std::string number;
  dl_iterate_phdr(&take_number, &number);
  return number.empty() ? "unknown" : number;
}

std::string processor() {
  utsname system{};
  uname(&system);
  std::string kind = system.machine;
#ifdef __x86_64__
  // Features count that the C library may use: it chooses its sine by them, Embree its loops.
  if (CPU_FEATURE_ACTIVE(AVX)) kind += " AVX";
  if (CPU_FEATURE_ACTIVE(AVX2)) kind += " AVX2";
  if (CPU_FEATURE_ACTIVE(FMA)) kind += " FMA";
  if (CPU_FEATURE_ACTIVE(AVX512F)) kind += " AVX512F";
#endif
  return kind;
}

}  // namespace

const std::string& program_build() {
  static const std::string text = fmt::format("limpid {}, {}, build {}{}{}", program_version(),
                                              kCompiler, linked(), kBetween, processor());
  return text;
}

std::string other_build(const std::string& recorded_by, const std::string& where) {
  const std::string& own = program_build();
  if (recorded_by == own) return {};
  if (recorded_by.empty()) {
    return fmt::format(
        "{} does not say which build recorded it; the numbers of this re-run can differ in their "
        "last digits",
        where);
  }
  const std::string program = own.substr(0, own.find(kBetween));
  const bool same_program = recorded_by.starts_with(program + std::string(kBetween));
  return fmt::format(
      "{} was recorded {} ({:.200}) than this one ({}); the numbers of this re-run can differ in "
      "their last digits",
      where, same_program ? "on another kind of processor" : "by another build", recorded_by, own);
}

}  // namespace limpid
