#include "core/coupling/proposed.h"

#include "core/coupling/law_at_tip.h"
#include "core/coupling/laws.h"
#include "core/coupling/ledger.h"
#include "core/coupling/spring_coupling.h"

namespace limpid {
namespace {

template <int N>
class Proposed final : public Law<N> {
 public:
  // This law may give energy below eta_min and wherever it takes over.
  double least_left() const override { return Ledger<N>::kForgiven; }
  Vec<N> step(const LawSettings& p, const LawInput<N>& in, Proxy<N>& proxy) override {
    const double eta = p.eta;
    if (in.link == nullptr) {
      const Decomposition<N> d(in.device, {proxy.M(), proxy.C(), proxy.v()});
      return couple<N>(p, in, feedforward(eta, d, in.f1_hat), proxy);
    }
    // Each side decomposes its own state and what it knows of the other's.
    FromProxy<N> here = told(in, proxy);
    const FromDevice<N>& far = in.link->to_proxy(told(in));
    const Decomposition<N> there(far.device, here.proxy);
    move_proxy<N>(p, in, far, feedforward(eta, there, far.f1_hat), proxy);
    here.f2 = proxy.f();
    const FromProxy<N>& known = in.link->to_device(here);
    const Decomposition<N> d(in.device, known.proxy);
    return on_device<N>(p, in, known, feedforward(eta, d, in.f1_hat));
  }
};

}  // namespace

TipWall ProposedLaw::wall(const LawSettings&, const LawAtTip& at) {
  WallSetting loop = at.loop;
  loop.delay += at.felt.trip;
  return {proposed_wall(at.tip, loop),
          "the damping available is just enough for the delay of the contact force"};
}

FeltAtTip ProposedLaw::felt(const LawSettings& p, const LawAtTip& at, double f) {
  return felt_mass(at.felt.proposed(f, p.eta, at.w_f), f);
}

template <int N>
std::unique_ptr<Law<N>> ProposedLaw::make() {
  return std::make_unique<Proposed<N>>();
}

template std::unique_ptr<Law<3>> ProposedLaw::make();
template std::unique_ptr<Law<7>> ProposedLaw::make();
template std::unique_ptr<Law<kAnyDof>> ProposedLaw::make();

}  // namespace limpid
