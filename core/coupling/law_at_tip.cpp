#include "core/coupling/law_at_tip.h"

#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <tuple>

#include "core/coupling/laws.h"

namespace limpid {
namespace {

// Functions that tell the limits, of all laws in their order.
template <class... Law>
struct Told {
  static constexpr std::array kWalls{&Law::wall...};
  static constexpr std::array kFelt{&Law::felt...};
};
template <class... Law>
Told<Law...> told_by(std::tuple<Law...>*);
using AllTold = decltype(told_by(static_cast<Laws*>(nullptr)));

// Returns the tip with the gains of a law that takes those of all joints alike.
LawAtTip alike(LawAtTip at) {
  for (double* gain : {&at.loop.k_vc, &at.loop.b_v, &at.felt.k_vc, &at.felt.b_v, &at.felt.b_vc}) {
    *gain /= at.weight;
  }
  at.weight = at.easiest_weight = 1;
  return at;
}

bool weighs_gains(CouplingKind kind) { return info(kind).has("coupling.per_joint"); }

}  // namespace

FeltAtTip felt_mass(std::complex<double> Z, double f) {
  return {Z.imag() / (2 * std::numbers::pi * f), Z.real()};
}

TipWall LawAtTip::through_spring(double k_vc) const {
  return {spring_at_tip(tip, weight * k_vc), "the wall is felt through the spring k_vc"};
}

TipWall LawAtTip::on_device(double stiffness, const char* bound) const {
  const double stepped = stepped_wall(encoder_step * std::sqrt(tip.lever2), friction);
  if (stepped < stiffness) return {stepped, "the hand feels each encoder step as a push"};
  return {stiffness, bound};
}

TipWall wall_at_tip(CouplingKind kind, const LawSettings& p, const LawAtTip& at) {
  return AllTold::kWalls[static_cast<std::size_t>(kind)](p, weighs_gains(kind) ? at : alike(at));
}

FeltAtTip felt_at_tip(CouplingKind kind, const LawSettings& p, const LawAtTip& at, double f) {
  return AllTold::kFelt[static_cast<std::size_t>(kind)](p, weighs_gains(kind) ? at : alike(at), f);
}

}  // namespace limpid
