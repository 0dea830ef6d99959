#include "app/desktop/base/deeds.h"

#include <algorithm>

namespace limpid {
namespace {

char letter_of(Deed deed) { return std::ranges::find(kDeeds, deed, &DeedInfo::deed)->letter; }

}  // namespace

bool done(const Settings& settings, Deed deed) {
  return settings.tried.find(letter_of(deed)) != std::string::npos;
}

void note_done(Settings& settings, Deed deed) {
  if (!done(settings, deed)) settings.tried += letter_of(deed);
}

bool all_done(const Settings& settings) {
  return std::ranges::all_of(kDeeds,
                             [&](const DeedInfo& each) { return done(settings, each.deed); });
}

void note_all_done(Settings& settings) {
  for (const DeedInfo& each : kDeeds) note_done(settings, each.deed);
}

}  // namespace limpid
