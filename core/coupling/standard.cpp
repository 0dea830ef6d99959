#include "core/coupling/standard.h"

#include "core/coupling/law_at_tip.h"
#include "core/coupling/laws.h"
#include "core/coupling/spring_coupling.h"

namespace limpid {
namespace {

template <int N>
class Standard final : public Law<N> {
 public:
  Vec<N> step(const LawSettings& p, const LawInput<N>& in, Proxy<N>& proxy) override {
    const auto none = Feedforward<N>::none(in.x1.size());
    if (in.link == nullptr) return couple<N>(p, in, none, proxy);
    FromProxy<N> here = told(in, proxy);
    move_proxy<N>(p, in, in.link->to_proxy(told(in)), none, proxy);
    here.f2 = proxy.f();
    return on_device<N>(p, in, in.link->to_device(here), none);
  }
};

}  // namespace

TipWall StandardLaw::wall(const LawSettings& p, const LawAtTip& at) {
  if (!at.condition3.known) return {0, "no limit is known because packets are lost (link.loss)"};
  if (!at.condition3.holds) {
    return {0, "condition (3) is broken: the coupling is not passive, not even in free motion"};
  }
  return at.through_spring(p.k_vc);
}

FeltAtTip StandardLaw::felt(const LawSettings&, const LawAtTip& at, double f) {
  return at.behind_spring(f);
}

template <int N>
std::unique_ptr<Law<N>> StandardLaw::make() {
  return std::make_unique<Standard<N>>();
}

template std::unique_ptr<Law<3>> StandardLaw::make();
template std::unique_ptr<Law<7>> StandardLaw::make();
template std::unique_ptr<Law<kAnyDof>> StandardLaw::make();

}  // namespace limpid
