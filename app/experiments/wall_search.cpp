#include "app/experiments/wall_search.h"

#include <cmath>

namespace limpid {
namespace {

struct Search {
  double low = kSoftest, high = kStiffest;
  bool done = false;
};

// Whether each wall, not a number where none is asked for, is rendered well in every grip. What one
// grip finds bad is not tried in the next.
std::vector<char> try_walls(Laboratory& lab, std::span<const TapSetting> settings,
                            const std::vector<double>& walls) {
  std::vector<char> good(settings.size(), 1);
  for (const double grip : kGrips) {
    std::vector<std::size_t> of;
    std::vector<TapBench> benches;
    std::vector<Trial> trials;
    for (std::size_t i = 0; i < settings.size(); ++i) {
      if (std::isnan(walls[i]) || good[i] == 0) continue;
      of.push_back(i);
      benches.emplace_back(settings[i], walls[i], grip, 1);
      trials.push_back(benches.back().trial());
      trials.back().may_diverge = true;  // where that begins is what is looked for
    }
    lab.run(trials, [&](std::size_t t, const TrialResult& result) {
      const bool exact = settings[of[t]].encoder_step == 0;
      good[of[t]] = well_rendered(benches[t].touch(result), exact) ? 1 : 0;
    });
  }
  return good;
}

}  // namespace

bool well_rendered(const Touch& touch, bool exact_encoder) {
  using W = WellRendered;
  return touch.port <= W::kPort && touch.chatter <= W::kChatter &&
         std::abs(touch.felt - 1) <= W::kFelt && std::isfinite(touch.energy) &&
         (!exact_encoder || touch.energy <= W::kEnergy);
}

std::vector<double> stiffest_walls(Laboratory& lab, std::span<const TapSetting> settings) {
  std::vector<Search> searches(settings.size());
  std::vector<double> walls(settings.size());
  // First the ends: where one of them is the answer there is nothing between to look for.
  for (int step = -2; step < kBisections; ++step) {
    for (std::size_t i = 0; i < settings.size(); ++i) {
      const Search& s = searches[i];
      walls[i] = s.done       ? std::nan("")
                 : step == -2 ? s.high
                 : step == -1 ? s.low
                              : std::sqrt(s.low * s.high);
    }
    const std::vector<char> good = try_walls(lab, settings, walls);
    for (std::size_t i = 0; i < settings.size(); ++i) {
      Search& s = searches[i];
      if (s.done) continue;
      (good[i] != 0 ? s.low : s.high) = walls[i];
      s.done = s.low >= s.high;
    }
  }
  std::vector<double> found;
  for (const Search& s : searches) found.push_back(s.low);
  return found;
}

}  // namespace limpid
