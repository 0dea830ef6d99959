// The predictive coupling.
//
// Device and proxy are solved together for their mean velocities over the coming tick, so that
// walls are as stiff as set. Small passive networks shape the felt inertia instead of the observed
// force. Motor limits, several contacts and friction enter the same solve. A ledger bounds the
// energy that the human is given.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "core/base/field.h"
#include "core/coupling/law_info.h"

namespace limpid {

// Constants of the predictor; see PredictorSettings::gains().
struct PredictorGains {
  double p;        // memory of a filter whose memory fades; NaN: see encoder_filter.h [-]
  double mu;       // factor on the device's inertia in the predictor [-]
  double damping;  // of walls, as a part of m_n/T [-]

  bool weighs() const { return std::isnan(p); }  // readings, by the encoders' step
};
struct PredictorSettings {
  double memory = kUnset;      // p [-]
  double inertia = kUnset;     // mu [-]
  double hand_mass = 0.2;      // in the second predictor [kg]
  int delay = 0;               // known delay between command and motor [ticks]
  double delay_most = kUnset;  // largest delay possible [ticks]

  // NaN, which stands for "as usual", or "as far as it is known".
  static constexpr double kUnset = std::numeric_limits<double>::quiet_NaN();

  PredictorGains gains(double encoder_step) const {
    constexpr double kExact = 0.2, kCoarse = 1.5e-4;  // p of exact encoders; step [rad]
    PredictorGains g{memory, 1, 0.2};
    if (g.weighs() && !(encoder_step > 0)) {
      g.p = kExact;
    } else if (!g.weighs() && encoder_step > kCoarse) {  // as recordings with a p have it
      g.mu = 0.5;
      g.damping = 0.1;
    }
    if (!std::isnan(inertia)) g.mu = inertia;
    return g;
  }

  template <class P>
  static constexpr std::array<Field<P>, 5> settings() {
    return {
        {{"predictor.p", "memory p", "memory p", &P::memory, "-", 0, 0.9, 0, 0.9, false, true,
          "Predictive coupling: memory of the filter that predicts the device's motion. 0: no "
          "memory. A larger value smooths the readings more. Default with exact encoders: 0.2. "
          "Default with encoder steps: another filter, which computes the weight of each reading "
          "from the encoder step and from the possible motion of the hand. Some recordings of "
          "Limpid 0.2 set p. Limpid keeps this setting so that they can run again."},
         {"predictor.mu", "inertia \xCE\xBC", "inertia \xCE\xBC", &P::inertia, "-", 0.1, 3, 0.1, 3,
          true, true,
          "Predictive coupling: factor on the device's inertia in the predictor. Default: "
          "1."},
         {"predictor.hand_mass", "hand mass m_h", "hand mass m_h", &P::hand_mass, "kg", 0, 2, 0, 1,
          false, true,
          "Predictive coupling: mass of hand and handle in the second predictor. The law uses the "
          "second predictor while it predicts better than the first one. 0: no second predictor."},
         {"model.delay", "known delay", "Known delay", &P::delay, "ticks", 0, 20, 0, 5, false, true,
          "Predictive coupling: delay between command and motor that the law calculates with, in "
          "ticks."},
         {"model.delay_most", "possible delay", "possible delay", &P::delay_most, "ticks", 0, 20, 0,
          5, false, true,
          "Predictive coupling: largest possible delay between command and motor, in ticks. The "
          "energy account covers every delay from model.delay to model.delay_most. With a larger "
          "value eta above 1 is felt in a narrower frequency band. Default for the virtual arm: "
          "device.delay. Default for a real device: one tick more than the identified delay, or "
          "3 if the delay was not identified."}}};
  }
};

struct LedgerSettings {
  double energy = 0.005;  // E0, the most that the human may be given [J]

  template <class P>
  static constexpr std::array<Field<P>, 1> settings() {
    return {{{"ledger.energy", "ledger E\xE2\x82\x80", "Energy allowed E\xE2\x82\x80", &P::energy,
              "J", 1e-4, 0.02, 1e-3, 0.02, true, true,
              "Predictive coupling: since the start of the loop the human gets at most this energy "
              "more than the energy that came in. In any part of this time the human gets at most "
              "four times this energy more than the energy that came in. When the reserve is low "
              "the law reduces the contact force, the cancelled damping and the added inertia."}}};
  }
};

struct PredictiveLaw {
  static constexpr std::array kSliders{"coupling.eta",       "coupling.damping", "coupling.band",
                                       "coupling.k_vc",      "coupling.b_vc",    "coupling.b_v",
                                       "coupling.per_joint", "ledger.energy"};
  static constexpr LawInfo kInfo{
      .key = "predictive",
      .label = "Predictive",
      .meaning =
          "solves device and proxy together for the coming tick and shapes inertia by passive "
          "networks: allows stiff walls, a light device and friction, and counts the energy given.",
      .verdict = "Recommended: passive, without drift, with stiff walls and a light arm.",
      .promise = Promise::ledger,
      .takes_eta = true,
      .solves_together = true,
      .through_link = "the law solves device and proxy together and has no link",
      .sliders = kSliders,
  };

  // Settings without eta, which is the proposed law's.
  struct Settings : PredictorSettings, LedgerSettings {
    double felt_damping = kFollowsEta;  // share of b_d + b_v that is felt [-]
    double band = 5.3;                  // edge of the band in which eta holds [Hz]

    // NaN, which stands for "as eta has it".
    static constexpr double kFollowsEta = std::numeric_limits<double>::quiet_NaN();
    static constexpr double kLeastDamping = 1.0 / 3;

    double damping_share(double eta) const {
      if (!std::isnan(felt_damping)) return felt_damping;
      return 1 - std::clamp(2 * (1 - eta), 0.0, 1.0) * (1 - kLeastDamping);
    }

    template <class P>
    static constexpr auto settings() {
      constexpr std::array<Field<P>, 2> own{
          {{"coupling.damping", "damping", "Damping felt", &P::felt_damping, "-", kLeastDamping, 1,
            kLeastDamping, 1, false, true,
            "Predictive coupling: share of the damping b_d + b_v that the hand still feels in free "
            "motion. Default: depends on eta, from 1 at eta 1 down to 1/3 at eta 0.5 and below."},
           {"coupling.band", "band", "Band of the inertia", &P::band, "Hz", 0.5, 20, 1, 10, true,
            true,
            "Predictive coupling: up to this frequency the inertia felt is eta times the natural "
            "inertia. A wider band needs more damping."}}};
      return joined<P>(own, PredictorSettings::settings<P>(), LedgerSettings::settings<P>());
    }
  };

  // Makes the law.
  template <int N>
  static std::unique_ptr<Law<N>> make();
  // The stiffest wall under the law, and what is felt in free motion at f [Hz].
  static TipWall wall(const LawSettings& p, const LawAtTip& at);
  static FeltAtTip felt(const LawSettings& p, const LawAtTip& at, double f);
};

}  // namespace limpid
