// Texts about a coupling law for people, and its properties.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

namespace limpid {

template <int N>
class Law;
struct LawSettings;
struct LawAtTip;
struct TipWall;
struct FeltAtTip;

inline constexpr int kMostDelay = 20;  // largest delay of a device [ticks]

// Bound of the energy that the human is given.
enum class Promise : std::uint8_t {
  none,        // no limit is known
  condition3,  // nothing, where condition (3) holds
  eta_min,     // nothing in free motion, above eta_min of (25)
  ledger,      // at most the ledger's energy
  tanks,       // at most the tanks' energy
  port,        // nothing, whatever the hand does
  line,        // nothing, where the line is soft beside the device's damping
  observer,    // what was given is taken back, as far as a damper can
};

// Loop that a law makes with arm, hand and wall where it is linear, in ticks.
enum class LinearLoop : std::uint8_t {
  none,           // it is not linear
  on_device,      // the wall on the device itself
  behind_spring,  // the wall behind the proxy, spring and damper
  fed_forward     // the same, and torques fed forward
};

struct LawInfo {
  const char* key;      // in files and on the command line
  const char* label;    // on a button
  const char* meaning;  // in help and tooltips, a sentence after "KEY: "
  const char* verdict;  // judgement in a few words: how it feels, when it is safe
  Promise promise;
  LinearLoop loop = LinearLoop::none;
  // The law scales free motion by eta: under the predictive law the inertia; under the proposed one
  // the damping, though (12) has it of the inertia.
  bool takes_eta = false;
  // The law feeds the observed human force forward: the conditions of (25) are about it.
  bool observes = false;
  // The law solves device, proxy and contacts together.
  bool solves_together = false;
  // The law renders contacts on the device itself: the proxy goes where the readings are, and no
  // spring lies between.
  bool on_device = false;
  bool for_links = false;       // without a link it only weakens the standard law
  bool for_comparison = false;  // others use it; it has no button of its own in the panel
  const char* through_link;     // known properties with a delay between device and proxy
  // Meanings of the shares of its torque and of its damper that the law tells; null: it has none.
  const char* torque_share = nullptr;
  const char* damper_share = nullptr;
  std::span<const char* const> sliders;  // keys of the panel's sliders

  // The law accounts for the energy that the human is given, and bounds it.
  bool keeps_ledger() const { return promise == Promise::ledger || promise == Promise::tanks; }
  // The law has a spring or fed-forward torques between device and proxy, and so may have a link.
  bool knows_link() const { return !solves_together && !on_device; }
  bool has(std::string_view setting) const {
    return std::ranges::any_of(sliders, [&](std::string_view each) { return each == setting; });
  }
};

}  // namespace limpid
