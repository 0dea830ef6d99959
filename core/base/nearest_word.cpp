#include "core/base/nearest_word.h"

#include <algorithm>
#include <numeric>

namespace limpid {
namespace {

// Edit distance: the fewest letters to insert, drop or change.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({changed, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::optional<std::string> nearest(std::string_view word, const std::vector<std::string>& among) {
  std::optional<std::string> best;
  std::size_t fewest = 1 + std::max<std::size_t>(2, word.size() / 3);
  if (word.empty() || word.size() > 200) return best;
  for (const std::string& candidate : among) {
    const std::size_t steps = distance(word, candidate);
    if (steps < fewest) {
      fewest = steps;
      best = candidate;
    }
  }
  return best;
}

std::string allowed_for(std::string_view word, const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& each : words) text += (text.empty() ? "" : ", ") + each;
  const auto meant = nearest(word, words);
  return meant ? text + "; did you mean " + *meant + "?" : text;
}

}  // namespace limpid
