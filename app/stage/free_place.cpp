#include "app/stage/free_place.h"

#include <algorithm>

namespace limpid {
namespace {

constexpr float kMoves = 0.1f;  // part of a place by which another one has to be better

float covered_area(ScreenRect place, std::span<const ScreenRect> of) {
  float area = 0;
  for (const ScreenRect& each : of) area += shared_area(place, each);
  return area;
}

}  // namespace

float shared_area(ScreenRect a, ScreenRect b) {
  const float wide = std::min(a.max.x, b.max.x) - std::max(a.min.x, b.min.x);
  const float high = std::min(a.max.y, b.max.y) - std::max(a.min.y, b.min.y);
  return wide > 0 && high > 0 ? wide * high : 0;
}

std::optional<ScreenRect> FreePlace::choose(std::span<const ScreenRect> places,
                                            const Crowd& crowd) {
  struct Cost {
    float kept, better;
    bool below(const Cost& other) const {
      return kept != other.kept ? kept < other.kept : better < other.better;
    }
  };
  const auto cost = [&](std::size_t i) {
    return Cost{covered_area(places[i], crowd.kept_free),
                covered_area(places[i], crowd.better_free)};
  };
  if (places.empty()) return std::nullopt;
  std::size_t best = 0;
  for (std::size_t i = 1; i < places.size(); ++i) {
    if (cost(i).below(cost(best))) best = i;
  }
  if (last_ && *last_ < places.size()) {
    const ScreenRect& now = places[*last_];
    const Cost stays = cost(*last_);
    const float much = kMoves * now.width() * now.height();
    if (stays.kept <= cost(best).kept && stays.better <= cost(best).better + much) best = *last_;
  }
  last_ = best;
  return places[best];
}

}  // namespace limpid
