// Boxes on a floor: what a tick of bodies takes.
#pragma once

#include <string>

#include "tests/bench/bench.h"

namespace limpid::bench {

// What they do.
enum class Boxes {
  rest,    // awake
  slide,   // all of them
  asleep,  // all of them
};

// What a line of them is called: "bodies/10/rest".
std::string id_of(int count, Boxes what);
// So many of them, 3 cm and 50 g each, one beside the other. Times of a tick without an arm [us].
Line boxes(const Wishes& wishes, const Line& unit, int count, Boxes what);

}  // namespace limpid::bench
