#include "core/coupling/direct.h"

#include "core/coupling/device_walls.h"
#include "core/coupling/law_at_tip.h"
#include "core/coupling/laws.h"
#include "core/coupling/ledger.h"

namespace limpid {
namespace {

template <int N>
class Direct final : public Law<N> {
 public:
  double least_left() const override { return Ledger<N>::kForgiven; }
  Vec<N> step(const LawSettings&, const LawInput<N>& in, Proxy<N>& proxy) override {
    return walls_.step(in, proxy).torque;
  }
  LawReport report() const override { return {.unsettled = walls_.unsettled()}; }

 private:
  DeviceWalls<N> walls_;
};

}  // namespace

TipWall DirectLaw::wall(const LawSettings&, const LawAtTip& at) {
  return at.on_device(direct_wall(at.tip, at.loop),
                      "the damping of arm and hand limits the wall: (b_d + b_h)/(T/2 + delay)");
}

FeltAtTip DirectLaw::felt(const LawSettings&, const LawAtTip& at, double) { return at.arm_alone(); }

template <int N>
std::unique_ptr<Law<N>> DirectLaw::make() {
  return std::make_unique<Direct<N>>();
}

template std::unique_ptr<Law<3>> DirectLaw::make();
template std::unique_ptr<Law<7>> DirectLaw::make();
template std::unique_ptr<Law<kAnyDof>> DirectLaw::make();

}  // namespace limpid
