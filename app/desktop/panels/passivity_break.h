// Shows what passivity is for: a setting under which the loop gives energy without end, and back.
#pragma once

#include <optional>

#include "core/dynamics/arm_description.h"
#include "core/tick/parameters.h"

namespace limpid {

// The proposed law in a stiff, undamped grip, with eta well below Routh's limit for it. All else
// stays.
Parameters without_passivity(const Parameters& p, const ArmDescription& arm);

class PassivityBreak {
 public:
  // Whether these are parameters under which passivity was broken.
  bool broken(const Parameters& p) const;
  void break_it(Parameters& p, const ArmDescription& arm);
  // As it was before. Precondition: broken(p).
  void repair(Parameters& p);

 private:
  struct Grip {
    CouplingKind kind;
    double eta, stiffness, damping;
    friend bool operator==(const Grip&, const Grip&) = default;
  };
  static Grip grip_of(const Parameters& p);

  std::optional<Grip> before_, made_;
};

}  // namespace limpid
