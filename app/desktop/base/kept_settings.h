// Settings on the disk for the next start, and when they are written.
#pragma once

#include <string>

#include "app/desktop/base/settings.h"

namespace limpid {

// Whether the file would have the same of both.
bool kept_alike(const Settings& a, const Settings& b);

class KeptSettings {
 public:
  static constexpr double kBetween = 2;  // looks at changes [s]

  explicit KeptSettings(const Settings& read) : kept_(read), settled_(read) {}

  // The settings on the disk, as they were read or written last.
  const Settings& kept() const { return kept_; }
  // Writes them. Returns what went wrong; empty: nothing.
  std::string keep(const Settings& settings);
  // Whether it is time to look again, at `now` [s].
  bool due(double now);
  // Writes what has changed since the last time, and stands since: what still moves, as a slider
  // that is dragged, waits. Returns what went wrong, unless it was the same before.
  std::string follow(const Settings& settings);

 private:
  Settings kept_, settled_;
  double looked_ = 0;  // [s]
  std::string failure_;
};

}  // namespace limpid
