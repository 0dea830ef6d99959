// Places of the names of a band's stretches, the same in the window and in pictures.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "app/plot/plot_spec.h"

namespace limpid {

// A stretch in which a band says the same, with the width of that name; 0 where it has none.
struct NamedStretch {
  int said;
  double left, right;  // [px]
  double width;        // [px]
};

// A line for names.
struct NameLine {
  double left, right;  // [px]
  double gap;          // between names [px]
  bool may_stick_out;  // of its stretch, where a name is said for the first time
};

struct PlacedName {
  std::size_t stretch;
  double left;  // [px]
};

// Returns where names begin, from left to right: each at its stretch's left end, or where the name
// before ends. A name without room waits for the next stretch that says the same.
std::vector<PlacedName> place_names(std::span<const NamedStretch> stretches, const NameLine& line);

// Returns how many edges of laws lie below one another at the top of a plot, at least one.
int law_edges(std::span<const Band> bands);

}  // namespace limpid
