#include "app/desktop/base/notices.h"

#include <algorithm>

namespace limpid {

using SteadyClock = std::chrono::steady_clock;

void Notices::say(std::string text, bool bad) {
  std::erase_if(notices_, [&](const Notice& notice) { return notice.text == text; });
  const auto seconds = std::chrono::seconds(bad ? 10 : 5);
  notices_.push_back(
      {std::move(text), bad, SteadyClock::now() + seconds, std::chrono::system_clock::now()});
  past_.push_back(notices_.back());
  if (past_.size() > kKept) past_.pop_front();
}

void Notices::say_once(const std::string& text, bool bad) {
  const auto same = [&](const Notice& notice) { return notice.text == text; };
  if (std::ranges::none_of(notices_, same)) say(text, bad);
}

void Notices::forget_old() {
  while (!notices_.empty() && notices_.front().until < SteadyClock::now()) notices_.pop_front();
}

}  // namespace limpid
