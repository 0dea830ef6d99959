// A tick of the predictive law, solved again with matrices written out from its equations.
#include <gtest/gtest.h>

#include "core/coupling/law.h"
#include "core/coupling/ledger.h"
#include "core/coupling/predictive.h"
#include "core/math/eigen.h"
#include "core/tick/parameters.h"
#include "core/touch/proxy.h"
#include "tests/support/random_arm.h"
#include "tests/support/tick.h"

namespace limpid {
namespace {

using test::Random;

using test::T;

// Fast, and tenths of a radian apart: the terms of C count. At eta 1 there is no network, in free
// space no contact, and nobody's torque is known:
//     D0 w = 2/T M1 v1 + tau1,  tau1 = -c v_E - s0 + C_EL v_L - b_v w + (I - phi^T) C_LE v_E
//     tau2 = c v_E + s0 - C_EL v_L + phi^T C_LE v_E,  so  tau1 + tau2 = -b_v w + C_LE v_E.
TEST(PredictiveLaw, IsTheJointSolutionOfItsEquations) {
  Random random(160);
  for (unsigned seed = 0; seed < 50; ++seed) {
    const ArmDescription description = test::random_arm(3, 161 + seed);
    const Arm<3> arm(description);
    Parameters p;
    p.eta = 1;
    p.hand_mass = 0;
    p.b_v = 0.015;
    const Vec<3> x1 = random.vector(3, 2), v1 = random.vector(3, 12), zero = Vec<3>::Zero();
    const Vec<3> x2 = x1 + random.vector(3, 0.4), v2 = random.vector(3, 12);
    const Vec<3> b_d = Vec<3>::Constant(0.013), most = Vec<3>::Constant(1e6);
    Proxy<3> proxy(description, Scene{});
    proxy.place(x2, v2, 0.6);
    const Eigen::MatrixXd M2 = proxy.M(), C2 = proxy.C();
    Arm<3>::Frames frames;
    Dynamics<3> device{{}, {}, v1};
    arm.frames(x1, frames);
    arm.inertia_coriolis(frames, v1, device.M, device.C);

    const auto law = PredictiveLaw::make<3>();
    law->start({x1, v1, zero});
    law->locate(p, {x1, v1, 0, 0});
    Ledger<3> ledger;
    ledger.start(x1, std::nullopt, Owed::nothing);
    LawInput<3> in{x1, v1, device, zero, zero, T, frames, b_d, zero, most, 1, T, 0, 0};
    in.ledger = &ledger;
    const Eigen::VectorXd tau1 = law->step(p, in, proxy);
    const Eigen::VectorXd tau2 = proxy.tau(), u = (proxy.x() - x2) / T;

    const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(3, 3), M1 = device.M, C1 = device.C;
    const Eigen::MatrixXd phi = (M1 + M2).inverse() * M2;
    const Eigen::MatrixXd C_EL = phi.transpose() * C1 + (phi.transpose() - I) * C2;
    const Eigen::MatrixXd C_LE = -C_EL.transpose();
    const Eigen::MatrixXd sum = C_LE - p.b_v * I;
    const Eigen::VectorXd w = least_squares(sum, tau1 + tau2 + C_LE * u);
    const Eigen::VectorXd v_E = w - u, v_L = w - phi * v_E;
    const Eigen::VectorXd s0 = p.k_vc * (x1 - x2);
    const double c = p.b_vc + p.k_vc * T / 2;
    const Eigen::VectorXd shape = C_LE * v_E, locked = C_EL * v_L;
    const Eigen::VectorXd wanted =
        -c * v_E - s0 + locked - p.b_v * w + shape - phi.transpose() * shape;
    EXPECT_LT((tau1 - wanted).norm(), 1e-9 * tau1.norm()) << seed;
    EXPECT_GT(locked.norm(), 1e-6 * tau1.norm()) << "the term counts";
    // The midpoint rule, or, for a joint that dies out within a tick, its exact decay.
    const Eigen::Array3d a = T * 0.013 * M1.inverse().diagonal().array();
    Eigen::VectorXd ahead = Eigen::VectorXd::Constant(3, 2);
    if ((a > 1).any()) ahead = a / (a / (1 - (-a).exp()) - 1);
    const Eigen::MatrixXd Mp = M1 * ahead.asDiagonal() / T, D0 = Mp + C1 + 0.013 * I;
    EXPECT_LT((D0 * w - Mp * v1 - tau1).norm(), 1e-9 * (Mp * v1).norm()) << seed;
  }
}

}  // namespace
}  // namespace limpid
