#include "app/run/program_build.h"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <string_view>
#ifdef __x86_64__
#ifdef __clang__
#define _Bool bool  // NOLINT: the header is for C, and clang knows no _Bool in C++
#endif
#include <sys/platform/x86.h>
#endif

#include "app/base/version.h"
#include "app/run/run_key.h"

namespace limpid {
namespace {

constexpr std::string_view kBetween = "; ";

#ifdef __clang__
constexpr const char* kCompiler = "clang " __clang_version__;
#else
constexpr const char* kCompiler = "GCC " __VERSION__;
#endif

std::string processor() {
  utsname system{};
  uname(&system);
  std::string kind = system.machine;
#ifdef __x86_64__
  // Names what the C library chooses its sine by, and Embree its loops.
  if (CPU_FEATURE_ACTIVE(AVX)) kind += " AVX";
  if (CPU_FEATURE_ACTIVE(AVX2)) kind += " AVX2";
  if (CPU_FEATURE_ACTIVE(FMA)) kind += " FMA";
  if (CPU_FEATURE_ACTIVE(AVX512F)) kind += " AVX512F";
#endif
  return kind;
}

}  // namespace

const std::string& program_build() {
  static const std::string digest =
      program_digest() == 0 ? "unknown" : fmt::format("{:016x}", program_digest());
  static const std::string text = fmt::format("limpid {}, {}, build {}{}{}", program_version(),
                                              kCompiler, digest, kBetween, processor());
  return text;
}

std::string other_build(const std::string& recorded_by, const std::string& where) {
  const std::string& own = program_build();
  if (recorded_by == own && program_digest() != 0) return {};
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
