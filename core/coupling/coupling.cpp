#include "core/coupling/coupling.h"

#include <cmath>

#include "core/coupling/spring_coupling.h"

namespace limpid {
namespace {

template <int N, class... Each>
std::array<std::unique_ptr<Law<N>>, sizeof...(Each)> made(std::tuple<Each...>*) {
  return {Each::template make<N>()...};
}

}  // namespace

template <int N>
Coupling<N>::Coupling() : laws_(made<N>(static_cast<Laws*>(nullptr))) {}

template <int N>
void Coupling<N>::start(const LawStart<N>& at) {
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
  for (const auto& law : laws_) law->start(all);
}

template <int N>
DeviceEstimate<N> Coupling<N>::locate(CouplingKind kind, const LawSettings& p, LawReading<N> in) {
  elapsed_ = in.elapsed;
  if (!takes_over_ && elapsed_ == 0) ledger_.begin_at(in.x1);
  if (takes_over_) in.elapsed = 0;
  return law(kind).locate(p, in);
}

template <int N>
Vec<N> Coupling<N>::step(CouplingKind kind, const LawSettings& p, LawInput<N> in, Proxy<N>& proxy) {
  in.ledger = &ledger_;
  if (in.armed_anew) reserve_ = std::numeric_limits<double>::infinity();
  Law<N>& now = law(kind);
  if (!now.books_itself() || takes_over_) book(p, in, proxy);
  least_left_ = now.least_left();
  takes_over_ = false;
  Vec<N> torque = now.step(p, in, proxy);
  const double reserve = now.report().reserve;
  if (std::isfinite(reserve)) {
    reserve_ = reserve;
  } else if (std::isfinite(reserve_)) {
    reserve_ = ledger_.reserve();
  }
  return torque;
}

template <int N>
void Coupling<N>::applied(CouplingKind kind, const Vec<N>& torque) {
  newest_ = (newest_ + 1) % sent_.size();
  sent_[newest_] = torque;
  law(kind).applied(torque);
}

// Books the tick just ended by what is measured, see Ledger.
template <int N>
void Coupling<N>::book(const LawSettings& p, const LawInput<N>& in, const Proxy<N>& proxy) {
  ledger_.expect(p.delay, in.delay_most);
  const double before = ledger_.reserve();
  if (elapsed_ > 0) {
    const auto sent = [&](int d) -> const Vec<N>& {
      return sent_[(newest_ + sent_.size() - static_cast<std::size_t>(d)) % sent_.size()];
    };
    const double given = in.authority > 0 ? given_to_bodies(proxy) : 0;
    ledger_.add(in.x1, ledger_.located(in.x1), sent, in.b_d_sure, given, in.encoder_step, elapsed_);
  }
  const double spring = spring_energy<N>(springs(p, in.b_d), in.x1 - proxy.x(), in.limit);
  ledger_.settle(p.energy, spring + proxy.kinetic_energy() + proxy.contact_potential());
  if (in.armed_anew) ledger_.refill();
  const bool sure = (in.b_d_sure.array() >= in.b_d.array()).all();
  ledger_.forgive(before, sure ? least_left_ : std::max(least_left_, Ledger<N>::kForgiven));
}

template class Coupling<3>;
template class Coupling<7>;
template class Coupling<kAnyDof>;

}  // namespace limpid
