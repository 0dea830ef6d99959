// Boxes on a floor: what a tick of bodies takes.
#pragma once

#include <string>

#include "tests/bench/bench.h"

namespace limpid::bench {

// Motion of all boxes.
enum class Boxes {
  rest,  // awake
  slide,
  asleep,
};

// Id of their line: "bodies/10/rest".
std::string id_of(int count, Boxes what);
// Measures a tick of `count` boxes side by side, 3 cm and 50 g each, without an arm [us].
Line boxes(const Wishes& wishes, const Line& unit, int count, Boxes what);

}  // namespace limpid::bench
