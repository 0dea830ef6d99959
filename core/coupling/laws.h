// The coupling laws there are. A new one is a file like proposed.h, and its line here.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>
#include <tuple>

#include "core/coupling/predictive.h"
#include "core/coupling/proposed.h"
#include "core/coupling/standard.h"

namespace limpid {

// Numbered in the order of Laws: the number is what recordings keep.
enum class CouplingKind : std::uint8_t { standard, proposed, predictive };
using Laws = std::tuple<StandardLaw, ProposedLaw, PredictiveLaw>;

namespace detail {

template <class... Law>
struct Listed {
  struct Settings : Law::Settings... {};
  static constexpr std::array<const LawInfo*, sizeof...(Law)> kInfos{&Law::kInfo...};
  static constexpr std::array<const char*, sizeof...(Law)> kKeys{Law::kInfo.key...};
  template <int N>
  using Instances = std::tuple<typename Law::template Of<N>...>;
};
template <class... Law>
Listed<Law...> listed(std::tuple<Law...>*);
using AllLaws = decltype(listed(static_cast<Laws*>(nullptr)));

// What all of them do, in one text: "standard: ... proposed: ...".
consteval auto meanings() {
  constexpr std::size_t kLongest = 1024;
  std::array<char, kLongest> text{};
  std::size_t at = 0;
  const auto put = [&](std::string_view part) {
    at = static_cast<std::size_t>(std::ranges::copy(part, text.begin() + at).out - text.begin());
  };
  for (const LawInfo* law : AllLaws::kInfos) {
    if (at > 0) put(" ");
    put(law->key);
    put(": ");
    put(law->meaning);
  }
  return text;
}

}  // namespace detail

// Of all laws: a law finds its own among them.
using LawSettings = detail::AllLaws::Settings;

// What describes them, law by law, for an owner that inherits them.
template <class P>
constexpr auto law_settings() {
  return std::apply(
      [](auto... law) { return joined<P>(decltype(law)::Settings::template settings<P>()...); },
      Laws{});
}

inline const LawInfo& info(CouplingKind kind) {
  return *detail::AllLaws::kInfos[static_cast<std::size_t>(kind)];
}
// The law to switch to: all of them by turns.
inline CouplingKind next(CouplingKind kind) {
  const auto i = static_cast<std::size_t>(kind) + 1;
  return static_cast<CouplingKind>(i % detail::AllLaws::kInfos.size());
}
inline constexpr auto& kLawKeys = detail::AllLaws::kKeys;
inline constexpr std::uint8_t kLaws = kLawKeys.size();
inline constexpr auto kLawMeanings = detail::meanings();

// All laws, of which one at a time ties device and proxy together.
template <int N>
class Coupling {
 public:
  void start(const LawStart<N>& at) {
    std::apply([&](auto&... law) { (law.start(at), ...); }, laws_);
  }
  // First in a tick: where the law takes the device to be.
  template <class P>
  Whereabouts<N> locate(CouplingKind kind, const P& p, const LawReading<N>& in) {
    Whereabouts<N> at;
    with(laws_, kind, [&](auto& law) { at = law.locate(p, in); });
    return at;
  }
  // Then: steps the proxy over the tick; returns the torque that the motors are asked for [N m].
  template <class P>
  Vec<N> step(CouplingKind kind, const P& p, const LawInput<N>& in, Proxy<N>& proxy) {
    Vec<N> torque;
    with(laws_, kind, [&](auto& law) { torque = law.step(p, in, proxy); });
    return torque;
  }
  // Last: what left of it [N m].
  void applied(CouplingKind kind, const Vec<N>& torque) {
    with(laws_, kind, [&](auto& law) { law.applied(torque); });
  }
  LawReport report(CouplingKind kind) const {
    LawReport report;
    with(laws_, kind, [&](const auto& law) { report = law.report(); });
    return report;
  }

 private:
  template <class All, class Action>
  static void with(All& all, CouplingKind kind, const Action& action) {
    std::uint8_t i = 0;
    const auto one = [&](auto& law) {
      if (i++ == static_cast<std::uint8_t>(kind)) action(law);
    };
    std::apply([&](auto&... law) { (one(law), ...); }, all);
  }

  detail::AllLaws::Instances<N> laws_;
};

}  // namespace limpid
