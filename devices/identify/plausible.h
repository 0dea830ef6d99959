// Inertial parameters of links that some body has, near those of a guess.
//
// A body's second moments about its origin, Sigma = int r r^T dm = (tr I / 2) 1 - I, its first
// moment h = m c and its mass make the pseudo-inertia
//     J = [ Sigma  h ]
//         [ h^T    m ],
// which is positive definite for every body of some extent and for nothing else (Wensing, Kim and
// Slotine, 2017). With J = L0 E E^T L0^T, L0 the guess's and E a lower triangle with the diagonal
// e^d, every vector of ten numbers is a body, and the zero vector is the guess.
#pragma once

#include "core/dynamics/regressor.h"

namespace limpid {

class PlausibleLink {
 public:
  // A guess without extent is given a little.
  explicit PlausibleLink(const LinkParameters& guess);

  LinkParameters at(const LinkParameters& d) const;
  // Its derivative, a column for each number.
  Eigen::Matrix<double, kLinkParameters, kLinkParameters> slope(const LinkParameters& d) const;

 private:
  Eigen::Matrix4d L0_;
};

}  // namespace limpid
