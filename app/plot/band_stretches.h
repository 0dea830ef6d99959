// Where a band of a plot says what.
#pragma once

#include <vector>

#include "app/plot/history.h"
#include "app/plot/plot_spec.h"

namespace limpid {

// From one pixel up to another one the band's channel says the same: the number of a name.
struct BandStretch {
  int said;
  std::size_t from, to;  // [px]
};

// One after the other, `rows` being those of the pixels; none of a band that says nothing of
// interest there.
std::vector<BandStretch> band_stretches(const Band& band, const History& history,
                                        const std::vector<SampleIndex>& rows);

}  // namespace limpid
