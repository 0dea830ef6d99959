#include "app/plot/band_stretches.h"

#include <algorithm>
#include <cmath>

namespace limpid {

std::vector<BandStretch> band_stretches(const Band& band, const History& history,
                                        const std::vector<SampleIndex>& rows) {
  std::vector<BandStretch> stretches;
  if (history.empty() || rows.size() < 2) return stretches;
  const Extent all = history.extent(band.channel, rows.front(), rows.back());
  if (!(all.low < all.high) && !band.names.front().empty()) return stretches;
  const auto most = static_cast<int>(band.names.size()) - 1;
  const auto at = [&](std::size_t pixel) {
    if (rows[pixel] >= rows[pixel + 1]) return -1;
    const Extent said = history.extent(band.channel, rows[pixel], rows[pixel + 1]);
    return said.empty() ? -1 : std::clamp(static_cast<int>(std::lround(said.high)), 0, most);
  };
  for (std::size_t pixel = 0; pixel + 1 < rows.size(); ++pixel) {
    const int now = at(pixel);
    if (now < 0) continue;
    const std::size_t from = pixel;
    while (pixel + 2 < rows.size() && at(pixel + 1) == now) ++pixel;
    stretches.push_back({now, from, pixel + 1});
  }
  return stretches;
}

}  // namespace limpid
