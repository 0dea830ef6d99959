// Which of many like processes this one is, as mpirun or srun tell by the environment: what needs
// no messages needs no MPI.
#pragma once

#include <cstdint>
#include <optional>

namespace limpid {

struct Rank {
  std::uint64_t rank = 0, size = 1;
};
std::optional<Rank> own_rank();

}  // namespace limpid
