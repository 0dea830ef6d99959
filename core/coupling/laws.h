// The coupling laws: their list, their settings, and texts about all of them. A new law is a file
// like direct.h that describes it, one like direct.cpp that does it and tells its limits, and its
// name in Laws.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <tuple>

#include "core/coupling/direct.h"
#include "core/coupling/eba.h"
#include "core/coupling/law_info.h"
#include "core/coupling/popc.h"
#include "core/coupling/predictive.h"
#include "core/coupling/proposed.h"
#include "core/coupling/sfa.h"
#include "core/coupling/standard.h"
#include "core/coupling/tank.h"
#include "core/coupling/tdpn.h"
#include "core/coupling/wave.h"

namespace limpid {

// Kinds of law, numbered in the order of Laws; recordings keep the number.
enum class CouplingKind : std::uint8_t {
  standard,
  proposed,
  predictive,
  tank,
  direct,
  eba,
  popc,
  wave,
  tdpn,
  sfa
};
using Laws = std::tuple<StandardLaw, ProposedLaw, PredictiveLaw, TankLaw, DirectLaw, EbaLaw,
                        PopcLaw, WaveLaw, TdpnLaw, SfaLaw>;

namespace detail {

template <class... Law>
struct Listed {
  struct Settings : Law::Settings... {};
  static constexpr std::array<const LawInfo*, sizeof...(Law)> kInfos{&Law::kInfo...};
  static constexpr std::array<const char*, sizeof...(Law)> kKeys{Law::kInfo.key...};
};
template <class... Law>
Listed<Law...> listed(std::tuple<Law...>*);
using AllLaws = decltype(listed(static_cast<Laws*>(nullptr)));

// Joins the texts that `put_law(put, law, number)` puts for each law, separated by `between`.
template <class PutLaw>
consteval auto text_of_all(std::string_view between, PutLaw put_law) {
  constexpr std::size_t kLongest = 2048;
  std::array<char, kLongest> text{};
  std::size_t at = 0;
  const auto put = [&](std::string_view part) {
    at = static_cast<std::size_t>(std::ranges::copy(part, text.begin() + at).out - text.begin());
  };
  for (std::size_t i = 0; i < AllLaws::kInfos.size(); ++i) {
    if (i > 0) put(between);
    put_law(put, *AllLaws::kInfos[i], i);
  }
  return text;
}

}  // namespace detail

// Settings of all laws: a law finds its own among them.
struct LawSettings : detail::AllLaws::Settings {
  // Impedance of the line of `wave` [N m s/rad].
  double line() const { return std::isnan(wave_b) ? std::max(b_v, kLeastLine) : wave_b; }
  static constexpr double kLeastLine = 1e-5;
};

// Descriptions of LawSettings, law by law, for an owner that inherits them.
template <class P>
constexpr auto law_settings() {
  return std::apply(
      [](auto... law) { return joined<P>(decltype(law)::Settings::template settings<P>()...); },
      Laws{});
}

inline const LawInfo& info(CouplingKind kind) {
  return *detail::AllLaws::kInfos[static_cast<std::size_t>(kind)];
}
// Next law when switching through all of them.
inline CouplingKind next(CouplingKind kind) {
  const auto i = static_cast<std::size_t>(kind) + 1;
  return static_cast<CouplingKind>(i % detail::AllLaws::kInfos.size());
}
inline constexpr auto& kLawKeys = detail::AllLaws::kKeys;
inline constexpr std::uint8_t kLaws = kLawKeys.size();
// Meanings of all laws: "standard: what it does. proposed: ...".
inline constexpr auto kLawMeanings =
    detail::text_of_all(" ", [](auto put, const LawInfo& law, std::size_t) {
      put(law.key);
      put(": ");
      put(law.meaning);
    });
// Numbers of all laws as recordings keep them: "0 standard, 1 proposed, ...".
inline constexpr auto kLawNumbers =
    detail::text_of_all(", ", [](auto put, const LawInfo& law, std::size_t number) {
      const char digit = static_cast<char>('0' + number);
      put({&digit, 1});
      put(" ");
      put(law.key);
    });
static_assert(kLaws <= 10);  // the texts above have one digit for a number

}  // namespace limpid
