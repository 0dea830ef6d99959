// Coupling of device and proxy by one law at a time.
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "core/coupling/laws.h"
#include "core/coupling/ledger.h"
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

// All laws; one at a time ties device and proxy together. One ledger books the energy given under
// each of them.
template <int N>
class Coupling {
 public:
  void start(const LawStart<N>& at) {
    if (at.reserve) reserve_ = *at.reserve;
    takes_over_ = at.takes_over;
    if (takes_over_) {
      ledger_.let_through();
    } else {
      ledger_.start(at.x1, at.reserve, at.owed);
      sent_.fill(Vec<N>::Zero(at.x1.size()));
    }
    // A law that accounts for energy leaves the rest of its reserve to the next one.
    LawStart<N> all = at;
    all.reserve = reserve_;
    std::apply([&](auto&... law) { (law.start(all), ...); }, laws_);
  }
  // First in a tick: locates the device as the law models it.
  template <class P>
  DeviceEstimate<N> locate(CouplingKind kind, const P& p, LawReading<N> in) {
    DeviceEstimate<N> at;
    elapsed_ = in.elapsed;
    if (!takes_over_ && elapsed_ == 0) ledger_.begin_at(in.x1);
    if (takes_over_) in.elapsed = 0;
    with(laws_, kind, [&](auto& law) { at = law.locate(p, in); });
    return at;
  }
  // Second: steps the proxy over the tick; returns the torque asked of the motors [N m].
  template <class P>
  Vec<N> step(CouplingKind kind, const P& p, LawInput<N> in, Proxy<N>& proxy) {
    Vec<N> torque;
    in.ledger = &ledger_;
    if (in.armed_anew) reserve_ = std::numeric_limits<double>::infinity();
    with(laws_, kind, [&](auto& law) {
      if (!law.kKeepsLedger || takes_over_) book(p, in, proxy);
      least_left_ = law.kLeastLeft;
      takes_over_ = false;
      torque = law.step(p, in, proxy);
      const double reserve = law.report().reserve;
      if (std::isfinite(reserve)) {
        reserve_ = reserve;
      } else if (std::isfinite(reserve_)) {
        reserve_ = ledger_.reserve();
      }
    });
    return torque;
  }
  // Last: tells the law the torque that left [N m].
  void applied(CouplingKind kind, const Vec<N>& torque) {
    newest_ = (newest_ + 1) % sent_.size();
    sent_[newest_] = torque;
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

  // Books the tick just ended by what is measured, see Ledger.
  template <class P>
  void book(const P& p, const LawInput<N>& in, const Proxy<N>& proxy) {
    ledger_.expect(p.delay, in.delay_most);
    const double before = ledger_.reserve();
    if (elapsed_ > 0) {
      const auto sent = [&](int d) -> const Vec<N>& {
        return sent_[(newest_ + sent_.size() - static_cast<std::size_t>(d)) % sent_.size()];
      };
      const double given = in.authority > 0 ? given_to_bodies(proxy) : 0;
      ledger_.add(in.x1, in.x1, sent, in.b_d_sure, given, in.encoder_step, elapsed_);
    }
    const double spring = spring_energy<N>(p.k_vc, in.x1 - proxy.x(), in.limit);
    ledger_.settle(p.energy, spring + proxy.kinetic_energy() + proxy.contact_potential(),
                   in.authority == 0);
    if (in.armed_anew) ledger_.refill();
    const bool sure = (in.b_d_sure.array() >= in.b_d.array()).all();
    ledger_.forgive(before, sure ? least_left_ : std::max(least_left_, Ledger<N>::kForgiven));
  }

  detail::Instances<Laws>::Of<N> laws_;
  Ledger<N> ledger_;
  std::array<Vec<N>, kMostDelay + 1> sent_;  // torques sent, in a ring [N m]
  std::size_t newest_ = 0;
  double elapsed_ = 0;       // since the previous reading [s]
  bool takes_over_ = false;  // a law takes over at this tick
  // PlainLaw::kLeastLeft of the last tick's law.
  double least_left_ = -std::numeric_limits<double>::infinity();
  double reserve_ = std::numeric_limits<double>::infinity();
};

}  // namespace limpid
