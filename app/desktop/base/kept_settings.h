// Settings on the disk for the next start, and when they are written.
#pragma once

#include <string>

#include "app/desktop/base/settings.h"

namespace limpid {

// Returns true if both would be written to the settings file alike.
bool kept_alike(const Settings& a, const Settings& b);

class KeptSettings {
 public:
  static constexpr double kBetween = 2;  // between two looks at changes [s]

  explicit KeptSettings(const Settings& read) : kept_(read), settled_(read) {}

  // The settings on the disk, as they were read or written last.
  const Settings& kept() const { return kept_; }
  // Writes the settings. Returns the reason of a failure, or an empty text.
  std::string keep(const Settings& settings);
  // Returns true every kBetween seconds, at `now` [s].
  bool due(double now);
  // Writes the changes since the last writing that have stood since the last call. A slider that is
  // dragged thus waits. Returns the reason of a failure, unless it was the same before.
  std::string follow(const Settings& settings);

 private:
  Settings kept_, settled_;
  double looked_ = 0;  // when due() returned true last [s]
  std::string failure_;
};

}  // namespace limpid
