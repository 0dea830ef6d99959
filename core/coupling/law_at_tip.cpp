#include "core/coupling/law_at_tip.h"

#include <array>
#include <cmath>
#include <numbers>
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
  return AllTold::kWalls[static_cast<std::size_t>(kind)](p, at);
}

FeltAtTip felt_at_tip(CouplingKind kind, const LawSettings& p, const LawAtTip& at, double f) {
  return AllTold::kFelt[static_cast<std::size_t>(kind)](p, at, f);
}

}  // namespace limpid
