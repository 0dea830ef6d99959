#include "core/touch/mesh_edges.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace limpid {
namespace {

std::size_t hash_of(const Eigen::Vector3f& place) {
  std::uint64_t h = 0;
  for (const float x : place) {
    h = (h ^ std::bit_cast<std::uint32_t>(x == 0 ? 0.0f : x)) * 0x9e37'79b9'7f4a'7c15;  // 0 is -0
    h ^= h >> 32;
  }
  return h;
}

}  // namespace

std::vector<std::uint32_t> names_of(const std::vector<Eigen::Vector3f>& places) {
  constexpr std::uint32_t kFree = ~std::uint32_t{0};
  const std::size_t slots = std::bit_ceil(2 * places.size() + 1);
  std::vector<std::uint32_t> table(slots, kFree), names(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    names[i] = static_cast<std::uint32_t>(i);
    if (!places[i].allFinite()) continue;
    std::size_t slot = hash_of(places[i]) & (slots - 1);
    while (table[slot] != kFree && places[table[slot]] != places[i])
      slot = (slot + 1) & (slots - 1);
    if (table[slot] == kFree) table[slot] = names[i];
    names[i] = table[slot];
  }
  return names;
}

// Sorted into one list for each lower end, which are short: several times faster than sorting all.
EdgeCount count_edges(std::span<const std::uint32_t> corners, std::size_t names) {
  const auto to_corner = [](std::size_t i) { return i % 3 == 2 ? i - 2 : i + 1; };
  std::vector<std::size_t> end(names + 1);  // of each list; while they fill: where it goes on
  for (std::size_t i = 0; i < corners.size(); ++i) {
    ++end[std::min(corners[i], corners[to_corner(i)]) + std::size_t{1}];
  }
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<std::uint64_t> edges(corners.size());  // the higher end; the last bit: which way
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::uint64_t from = corners[i], to = corners[to_corner(i)];
    edges[end[std::min(from, to)]++] = std::max(from, to) << 1 | (from < to ? 1 : 0);
  }
  EdgeCount count;
  for (std::size_t list = 0, i = 0; list < names; ++list) {
    std::sort(edges.begin() + static_cast<std::ptrdiff_t>(i),
              edges.begin() + static_cast<std::ptrdiff_t>(end[list]));
    while (i < end[list]) {
      std::size_t next = i + 1;
      while (next < end[list] && edges[next] >> 1 == edges[i] >> 1) ++next;
      if (next - i == 1) ++count.open;
      if (next - i > 2 || (next - i == 2 && edges[i] == edges[i + 1])) ++count.odd;
      i = next;
    }
  }
  return count;
}

}  // namespace limpid
