#include "app/desktop/base/first_steps.h"

#include <algorithm>

namespace limpid {
namespace {

char letter_of(FirstStep step) {
  return std::ranges::find(kFirstSteps, step, &FirstStepInfo::step)->letter;
}

}  // namespace

bool done(const Settings& settings, FirstStep step) {
  return settings.tried.find(letter_of(step)) != std::string::npos;
}

void note_done(Settings& settings, FirstStep step) {
  if (!done(settings, step)) settings.tried += letter_of(step);
}

bool all_done(const Settings& settings) {
  return std::ranges::all_of(kFirstSteps,
                             [&](const FirstStepInfo& each) { return done(settings, each.step); });
}

void note_all_done(Settings& settings) {
  for (const FirstStepInfo& each : kFirstSteps) note_done(settings, each.step);
}

}  // namespace limpid
