#include "app/sweep/ranks.h"

#include <charconv>
#include <cstdlib>
#include <cstring>

namespace limpid {
namespace {

std::optional<std::uint64_t> number_in(const char* variable) {
  const char* text = std::getenv(variable);
  if (text == nullptr) return std::nullopt;
  std::uint64_t n = 0;
  const char* end = text + std::strlen(text);
  const auto result = std::from_chars(text, end, n);
  if (result.ec != std::errc{} || result.ptr != end) return std::nullopt;
  return n;
}

}  // namespace

std::optional<Rank> own_rank() {
  struct Variables {
    const char *rank, *size;
  };
  for (const auto& [rank, size] :
       {Variables{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
        Variables{"PMI_RANK", "PMI_SIZE"}, Variables{"SLURM_PROCID", "SLURM_NTASKS"}}) {
    const auto r = number_in(rank), n = number_in(size);
    if (r && n && *r < *n) return Rank{*r, *n};
  }
  return std::nullopt;
}

}  // namespace limpid
