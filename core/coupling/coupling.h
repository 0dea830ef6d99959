// Coupling of device and proxy by one law at a time.
#pragma once

#include <array>
#include <limits>
#include <memory>

#include "core/coupling/law.h"
#include "core/coupling/laws.h"
#include "core/coupling/ledger.h"

namespace limpid {

// All laws; one at a time ties device and proxy together. One ledger books the energy given under
// each of them.
template <int N>
class Coupling {
 public:
  Coupling();

  void start(const LawStart<N>& at);
  // First in a tick: locates the device as the law models it.
  DeviceEstimate<N> locate(CouplingKind kind, const LawSettings& p, LawReading<N> in);
  // Second: steps the proxy over the tick; returns the torque asked of the motors [N m].
  Vec<N> step(CouplingKind kind, const LawSettings& p, LawInput<N> in, Proxy<N>& proxy);
  // Last: tells the law the torque that left [N m].
  void applied(CouplingKind kind, const Vec<N>& torque);
  // Energy that the last law which accounts for it may still give the human, whichever law is in
  // force; infinite before there was one [J].
  double reserve() const { return reserve_; }
  LawReport report(CouplingKind kind) const { return law(kind).report(); }

 private:
  Law<N>& law(CouplingKind kind) const { return *laws_[static_cast<std::size_t>(kind)]; }
  void book(const LawSettings& p, const LawInput<N>& in, const Proxy<N>& proxy);

  std::array<std::unique_ptr<Law<N>>, kLaws> laws_;
  Ledger<N> ledger_;
  std::array<Vec<N>, kMostDelay + 1> sent_;  // torques sent, in a ring [N m]
  std::size_t newest_ = 0;
  double elapsed_ = 0;       // since the previous reading [s]
  bool takes_over_ = false;  // a law takes over at this tick
  // Law::least_left() of the last tick's law.
  double least_left_ = -std::numeric_limits<double>::infinity();
  double reserve_ = std::numeric_limits<double>::infinity();
};

extern template class Coupling<3>;
extern template class Coupling<7>;
extern template class Coupling<kAnyDof>;

}  // namespace limpid
