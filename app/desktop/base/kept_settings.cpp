#include "app/desktop/base/kept_settings.h"

#include <utility>

namespace limpid {

std::string KeptSettings::keep(const Settings& settings) {
  std::string failure = save_settings(settings, kept_);
  if (failure.empty()) kept_ = settings;
  return failure;
}

bool KeptSettings::due(double now) {
  if (now - looked_ < kBetween) return false;
  looked_ = now;
  return true;
}

std::string KeptSettings::follow(const Settings& settings) {
  const bool stands = kept_alike(settings, settled_);
  settled_ = settings;
  if (!stands || kept_alike(settings, kept_)) return {};
  std::string failure = keep(settings);
  if (failure == failure_) return {};
  failure_ = failure;
  return failure;
}

}  // namespace limpid
