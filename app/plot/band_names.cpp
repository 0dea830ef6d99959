#include "app/plot/band_names.h"

#include <algorithm>

namespace limpid {

std::vector<PlacedName> place_names(std::span<const NamedStretch> stretches, const NameLine& line) {
  std::vector<PlacedName> placed;
  double free_from = line.left;
  int now = -1;   // what has its name, until another value comes
  int last = -1;  // what was named last
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    const NamedStretch& each = stretches[i];
    if (each.said != now) now = -1;
    if (each.said == now || each.width <= 0) continue;
    const double from = std::max(each.left, line.left), begins = std::max(from, free_from);
    const double left = std::max(line.left, std::min(begins, line.right - each.width));
    const bool fits = begins + each.width <= each.right;
    const bool sticks_out = line.may_stick_out && from >= free_from && each.said != last;
    if (left < free_from || !(fits || sticks_out)) continue;
    placed.push_back({i, left});
    free_from = left + each.width + line.gap;
    now = last = each.said;
  }
  return placed;
}

int law_edges(std::span<const Band> bands) {
  int edges = 1;
  for (const Band& band : bands) edges = std::max(edges, band.lane + 1);
  return edges;
}

}  // namespace limpid
