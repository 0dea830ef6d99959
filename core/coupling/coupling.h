// Coupling of device and proxy by one law at a time.
#pragma once

#include <cmath>
#include <limits>

#include "core/coupling/laws.h"
#include "core/coupling/predictive.h"
#include "core/coupling/proposed.h"
#include "core/coupling/standard.h"
#include "core/coupling/tank.h"

namespace limpid {
namespace detail {

template <class>
struct Instances;
template <class... Law>
struct Instances<std::tuple<Law...>> {
  template <int N>
  using Of = std::tuple<typename Law::template Of<N>...>;
};

}  // namespace detail

// All laws; one at a time ties device and proxy together.
template <int N>
class Coupling {
 public:
  void start(const LawStart<N>& at) {
    if (at.reserve) reserve_ = *at.reserve;
    // A law that accounts for energy leaves the rest of its reserve to the next one.
    LawStart<N> all = at;
    all.reserve = reserve_;
    std::apply([&](auto&... law) { (law.start(all), ...); }, laws_);
  }
  // First in a tick: locates the device as the law models it.
  template <class P>
  DeviceEstimate<N> locate(CouplingKind kind, const P& p, const LawReading<N>& in) {
    DeviceEstimate<N> at;
    with(laws_, kind, [&](auto& law) { at = law.locate(p, in); });
    return at;
  }
  // Second: steps the proxy over the tick; returns the torque asked of the motors [N m].
  template <class P>
  Vec<N> step(CouplingKind kind, const P& p, const LawInput<N>& in, Proxy<N>& proxy) {
    Vec<N> torque;
    if (in.armed_anew) reserve_ = std::numeric_limits<double>::infinity();
    with(laws_, kind, [&](auto& law) {
      torque = law.step(p, in, proxy);
      if (const double reserve = law.report().reserve; std::isfinite(reserve)) reserve_ = reserve;
    });
    return torque;
  }
  // Last: tells the law the torque that left [N m].
  void applied(CouplingKind kind, const Vec<N>& torque) {
    with(laws_, kind, [&](auto& law) { law.applied(torque); });
  }
  // Energy that the last law which accounts for it may still give the human, whichever law is in
  // force; infinite before there was one [J].
  double reserve() const { return reserve_; }
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

  detail::Instances<Laws>::Of<N> laws_;
  double reserve_ = std::numeric_limits<double>::infinity();
};

}  // namespace limpid
