// Free places of the picture: where lens, cards and hints hide nothing that somebody looks at.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "app/plot/plot_frame.h"

namespace limpid {

// Places in the window that people look at.
struct Crowd {
  std::vector<ScreenRect> kept_free;    // tips, what is pulled or selected, words: never covered
  std::vector<ScreenRect> better_free;  // objects that move
};

// Chooses among places in order of preference the one that covers the least. It stays where it is
// as long as that covers nothing that is kept free, and little more than the best one.
class FreePlace {
 public:
  // Returns the place; nothing if there are none.
  std::optional<ScreenRect> choose(std::span<const ScreenRect> places, const Crowd& crowd);
  void forget() { last_.reset(); }

 private:
  std::optional<std::size_t> last_;
};

// Returns the area that two places share [px^2].
float shared_area(ScreenRect a, ScreenRect b);

}  // namespace limpid
