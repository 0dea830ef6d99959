#include "core/coupling/standard.h"

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
    move_proxy<N>(p, in.T, in.link->to_proxy(told(in)), none, proxy);
    here.f2 = proxy.f();
    return on_device<N>(p, in, in.link->to_device(here), none);
  }
};

}  // namespace

template <int N>
std::unique_ptr<Law<N>> StandardLaw::make() {
  return std::make_unique<Standard<N>>();
}

template std::unique_ptr<Law<3>> StandardLaw::make();
template std::unique_ptr<Law<7>> StandardLaw::make();
template std::unique_ptr<Law<kAnyDof>> StandardLaw::make();

}  // namespace limpid
