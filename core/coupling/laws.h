// The coupling laws: texts for people about each of them, and settings of laws, link and observer.
// A new law is an entry here, and a file like proposed.h with what it does.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <tuple>

#include "core/base/field.h"

namespace limpid {

// Texts about a law for people, and properties of it.
struct LawInfo {
  const char* key;      // in files and on the command line
  const char* label;    // on a button
  const char* meaning;  // in help and tooltips, a sentence after "KEY: "
  const char* verdict;  // judgement in a few words: how it feels, when it is safe
  // The law scales free motion by eta: under the predictive law the inertia; under the proposed one
  // the damping, though (12) has it of the inertia.
  bool takes_eta;
  // The law feeds the observed human force forward: the conditions of (25) are about it.
  bool observes;
  // The law accounts for the energy that the human is given, and bounds it.
  bool keeps_ledger;
  // The law solves device, proxy and contacts together, so it has no link. The others have a spring
  // or fed-forward torques between device and proxy.
  bool solves_together;
  bool for_links;                        // without a link it only weakens the standard law
  const char* through_link;              // known properties with a delay between device and proxy
  std::span<const char* const> sliders;  // keys of the panel's sliders
};

struct SpringDamper {
  double k_vc = 10;     // [N m/rad]
  double b_vc = 0.001;  // [N m s/rad]
  double b_v = 0.012;   // [N m s/rad]

  template <class P>
  static constexpr std::array<Field<P>, 3> settings() {
    return {{{"coupling.k_vc", "k_vc", "Coupling spring k_vc", &P::k_vc, "N m/rad", 1e-3, 1e4, 0.1,
              100, true, true,
              "Spring between device and proxy, (1)-(2). Stiffer keeps them closer, until "
              "condition (3) breaks: b_d >= 2 b_vc + k_vc T and b_v >= k_vc T / 2."},
             {"coupling.b_vc", "b_vc", "Coupling damper b_vc", &P::b_vc, "N m s/rad", 0, 100, 1e-5,
              0.1, true, true,
              "Damper between device and proxy, (1)-(2). It acts on a delayed velocity, so it "
              "costs device damping twice: condition (3)."},
             {"coupling.b_v", "b_v", "Proxy damper b_v", &P::b_v, "N m s/rad", 0, 100, 1e-4, 1,
              true, true,
              "Damping of the proxy, (2). Felt through the coupling; condition (3) asks for "
              "at least k_vc T / 2."}}};
  }
};

inline constexpr int kMostLinkDelay = 200, kMostLinkJitter = 50;  // [ticks]

// A delay between device and proxy, see link.h.
struct LinkSettings {
  int link_delay = 0;    // delay each way [ticks]
  int link_jitter = 0;   // largest extra delay of a packet [ticks]
  double link_loss = 0;  // share of the packets that never arrive [-]
  int link_seed = 1;     // seed of the random numbers for jitter and loss

  bool linked() const { return link_delay > 0 || link_jitter > 0 || link_loss > 0; }
  // Largest age of a side's knowledge of the other, unless packets are lost [ticks].
  int oldest() const { return link_delay + link_jitter; }

  template <class P>
  static constexpr std::array<Field<P>, 4> settings() {
    return {
        {{"link.delay", "link delay", "Link delay, each way", &P::link_delay, "ticks", 0,
          kMostLinkDelay, 0, 100, false, true,
          "Delay between device and proxy, each way, as if the world were far away. The predictive "
          "coupling solves both at once and knows no link."},
         {"link.jitter", "link jitter", "Link jitter", &P::link_jitter, "ticks", 0, kMostLinkJitter,
          0, 20, false, true,
          "Each packet between device and proxy takes up to so many ticks more, at random; each "
          "side goes by the packet that was sent last of those that it has."},
         {"link.loss", "link loss", "Packets lost", &P::link_loss, "-", 0, 0.9, 0, 0.5, false, true,
          "Share of the packets between device and proxy that never arrive; what has nothing new "
          "keeps the last one."},
         {"link.seed", "link seed", "link seed", &P::link_seed, "-", 0, 1e9, 0, 100, false, true,
          "Whole number from which the random numbers of link.jitter and link.loss follow."}}};
  }
};

// Condition (3) for a constant tick: b_d >= 2 b_vc + k_vc T and b_v >= k_vc T / 2. With a torque
// that answers its reading t_d late, and knowledge of the other side up to t_l old, j ticks of it
// jitter,
//     b_d >= (2 + j/2) b_vc + k_vc (T + 3/2 t_d + t_l),
//     b_v >= j/2 b_vc + k_vc ((T + t_d) / 2 + t_l).
//
// With a delay of d ticks the device's torque lacks k_vc (x_E,k - x_E,k-d), whose work on dx1_k is
// at most
//     k_vc sum_j |dx1_k (dx1_k-j - dx2_k-j)| <= k_vc d (3/2 dx1^2 + 1/2 dx2^2),
// summed over the ticks; the dampers b_d, b_v take b/T dx^2. The bound of (3) itself is derived in
// the same way. Through a link the device lacks k_vc (x2_k - x2_k-d) and the proxy k_vc (x1_k -
// x1_k-d), together at most k_vc d (dx1^2 + dx2^2). For d ticks each way this agrees with Lee and
// Spong (2006) and Nuno et al. (2009) for such couplings in continuous time. Velocities that are
// held for want of newer ones act up to j + 1 times.
//
// The condition covers spring and damper alone: no bound is known for torques that the proposed law
// feeds forward through a link.
struct Condition3 {
  double device_margin = 0;  // b_d less the bound, at the joint with the least [N m s/rad]
  double proxy_margin = 0;   // b_v less the bound [N m s/rad]
  bool known = true;         // false where packets are lost: then their age has no bound
  bool holds = false;        // to round-off: the paper's own gains are on the edge
};
// Evaluates the condition. b_d: of every joint [N m s/rad]; T and delay [s].
Condition3 condition3(const SpringDamper& p, double T, std::span<const double> b_d,
                      double delay = 0, const LinkSettings& link = {});

// Sliders of the paper's laws, the same for all; some have no effect in one law.
inline constexpr std::array kPaperSliders{"coupling.eta",  "observer.alpha", "coupling.k_vc",
                                          "coupling.b_vc", "coupling.b_v",   "link.delay",
                                          "link.jitter",   "link.loss"};

struct StandardLaw {
  static constexpr LawInfo kInfo{
      .key = "standard",
      .label = "Standard",
      .meaning = "spring and damper alone, (1)-(2).",
      .verdict = "The usual one: hand and world drift apart.",
      .takes_eta = false,
      .observes = false,
      .keeps_ledger = false,
      .solves_together = false,
      .for_links = false,
      .through_link = "passive where (3) holds",
      .sliders = kPaperSliders,
  };

  using Settings = SpringDamper;

  template <int N>
  struct Of;  // standard.h
};

struct ProposedLaw {
  static constexpr LawInfo kInfo{
      .key = "proposed",
      .label = "Proposed",
      .meaning = "with feedforward of the observed human force and the contact force, (14)-(15).",
      .verdict = "The paper's: no drift; passive only above \xCE\xB7_min.",
      .takes_eta = true,
      .observes = true,
      .keeps_ledger = false,
      .solves_together = false,
      .for_links = false,
      .through_link = "of what is fed forward no bound is known",
      .sliders = kPaperSliders,
  };

  struct Settings {
    double eta = 1;  // [-]

    template <class P>
    static constexpr std::array<Field<P>, 1> settings() {
      return {{{"coupling.eta", "\xCE\xB7", "Impedance scaling \xCE\xB7", &P::eta, "-", 0.01, 100,
                0.1, 10, true, true,
                "Impedance scaling: what the hand feels of free motion. Predictive coupling: eta "
                "times the inertia "
                "M1 + M2, up to coupling.band. Proposed coupling: eta times the damping, and so "
                "what is felt of slow motion; the paper has it of the inertia, (12), of which is "
                "measured 0.7 at eta 0.6 and less than none above eta 1. Below eta_min of (25) the "
                "proposed coupling is not passive."}}};
    }
  };

  template <int N>
  class Of;  // proposed.h
};

// Constants of the predictor; see PredictorSettings::gains().
struct PredictorGains {
  double p;        // memory of a filter whose memory fades; NaN: see encoder_filter.h [-]
  double mu;       // factor on the device's inertia in the predictor [-]
  double damping;  // of walls, as a part of m_n/T [-]

  bool weighs() const { return std::isnan(p); }  // readings, by the encoders' step
};

inline constexpr int kMostDelay = 20;  // largest delay of a device [ticks]

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
          "Predictive coupling: memory of a filter whose memory fades, 0 none, as recordings of "
          "Limpid 0.2 may have it. Default: with encoder steps none, each reading counts by the "
          "step and by what the hand may do; with exact encoders 0.2."},
         {"predictor.mu", "inertia \xCE\xBC", "inertia \xCE\xBC", &P::inertia, "-", 0.1, 3, 0.1, 3,
          true, true,
          "Predictive coupling: factor on the device's inertia in the predictor. Default: "
          "1."},
         {"predictor.hand_mass", "hand mass m_h", "hand mass m_h", &P::hand_mass, "kg", 0, 2, 0, 1,
          false, true,
          "Predictive coupling: mass of hand and handle in the second predictor, which takes "
          "over when it is the better one. 0 does without."},
         {"model.delay", "known delay", "Delay that is known", &P::delay, "ticks", 0, 20, 0, 5,
          false, true,
          "Predictive coupling: delay between command and motor that it reckons with, in "
          "ticks."},
         {"model.delay_most", "possible delay", "possible delay", &P::delay_most, "ticks", 0, 20, 0,
          5, false, true,
          "Predictive coupling: the most that the delay between command and motor may be, in "
          "ticks. The energy given is accounted for every delay from model.delay to this one, and "
          "eta above 1 is felt in a narrower band. Default: of the virtual arm device.delay; of a "
          "real device one tick more than was identified, or 3."}}};
  }
};

struct LedgerSettings {
  double energy = 0.005;  // E0, the most that the human may be given [J]

  template <class P>
  static constexpr std::array<Field<P>, 1> settings() {
    return {{{"ledger.energy", "ledger E\xE2\x82\x80", "Energy allowed E\xE2\x82\x80", &P::energy,
              "J", 1e-4, 0.02, 1e-3, 0.02, true, true,
              "Predictive coupling: the human is given at most this energy beyond what came in, "
              "since the loop was started, and at most four times of it in any part of that time. "
              "When the reserve runs low the contact force, the cancelled damping and the added "
              "inertia are cut."}}};
  }
};

struct PredictiveLaw {
  static constexpr std::array kSliders{"coupling.eta",  "coupling.damping", "coupling.band",
                                       "coupling.k_vc", "coupling.b_vc",    "coupling.b_v",
                                       "ledger.energy"};
  static constexpr LawInfo kInfo{
      .key = "predictive",
      .label = "Predictive",
      .meaning =
          "device and proxy solved together for the coming tick, inertia shaped by passive "
          "networks: stiff walls, light hands, friction, and a ledger of the energy given.",
      .verdict = "Recommended: no drift, stiff walls, light, passive.",
      .takes_eta = true,
      .observes = false,
      .keeps_ledger = true,
      .solves_together = true,
      .for_links = false,
      .through_link = "the predictive law knows no link",
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
            "Predictive coupling: share of the damping b_d + b_v that stays felt in free motion. "
            "Default: falls with eta, from 1 at eta 1 to 1/3 at eta 0.5 and below."},
           {"coupling.band", "band", "Band of the inertia", &P::band, "Hz", 0.5, 20, 1, 10, true,
            true,
            "Predictive coupling: up to this frequency the inertia felt is eta times the natural "
            "one; a wider band costs more damping."}}};
      return joined<P>(own, PredictorSettings::settings<P>(), LedgerSettings::settings<P>());
    }
  };

  template <int N>
  class Of;  // predictive.h
};

// Two-layer passivity (Franken, Stramigioli, Misra, Secchi, Macchelli 2011).
struct TankLaw {
  static constexpr std::array kSliders{"coupling.k_vc", "coupling.b_vc", "coupling.b_v",
                                       "tank.energy",   "tank.damping",  "link.delay",
                                       "link.jitter",   "link.loss"};
  static constexpr LawInfo kInfo{
      .key = "tank",
      .label = "Tank",
      .meaning =
          "the standard coupling with an energy tank on each side, which bounds the energy given "
          "whatever the link between them does.",
      .verdict = "Passive through any link; soft, and drags as the standard one.",
      .takes_eta = false,
      .observes = false,
      .keeps_ledger = true,
      .solves_together = false,
      .for_links = true,
      .through_link = "passive whatever it does",
      .sliders = kSliders,
  };

  struct Settings {
    double tank_energy = 0.005;  // E0, in both tanks at the start [J]
    double tank_most = 0.1;      // most that each tank keeps [J]
    double tank_share = 0.02;    // share of a tank's energy above E0/2 that is sent in a tick [-]
    double tank_damping = 100;   // damper of an empty tank, over the device's inertia [1/s]

    template <class P>
    static constexpr std::array<Field<P>, 4> settings() {
      return {
          {{"tank.energy", "tanks E\xE2\x82\x80", "Energy of both tanks", &P::tank_energy, "J",
            1e-4, 1, 1e-3, 0.02, true, true,
            "Tank coupling: what both tanks hold at the start, half of it each. Coupling and "
            "device never give more than this beyond what came in."},
           {"tank.most", "tank's most", "tank's most", &P::tank_most, "J", 1e-4, 100, 1e-2, 1, true,
            true,
            "Tank coupling: the most that each tank keeps of what came in. So much may be given in "
            "any part of the time."},
           {"tank.share", "tank's share", "tank's share", &P::tank_share, "-", 1e-4, 1, 1e-3, 1,
            true, true,
            "Tank coupling: share of what a tank holds above its half of tank.energy that it sends "
            "to the other one in a tick."},
           {"tank.damping", "refill", "Refilling damper", &P::tank_damping, "1/s", 0, 200, 0, 200,
            false, true,
            "Tank coupling: where the device's tank holds less than its half of tank.energy, a "
            "damper of up to this rate times the device's inertia fills it from the hand."}}};
    }
  };

  template <int N>
  class Of;  // tank.h
};

enum class VelocitySource : std::uint8_t { raw, lowpass, adaptive };
inline constexpr std::array kVelocitySources{"raw", "lowpass", "adaptive"};

struct ObserverSettings {
  double alpha = 0.035;  // [N m s/rad]
  bool anti_windup = true;
  VelocitySource velocity = VelocitySource::raw;

  template <class P>
  static constexpr std::array<Field<P>, 3> settings() {
    return {{{"observer.alpha", "\xCE\xB1", "Observer gain \xCE\xB1", &P::alpha, "N m s/rad", 1e-6,
              1e3, 1e-3, 1, true, true,
              "Gain of the human force observer, L = alpha M^-1, (17)-(18). Larger follows the "
              "hand faster (w_f = alpha / m) and raises eta_min."},
             {"observer.anti_windup", "anti-windup", "Observer knows the motors' limit",
              &P::anti_windup, "-", 0, 1, 0, 1, false, true,
              "Feed the observer with the torque the motors really gave (section 3.1). Without "
              "it a saturated contact winds the estimate up and the proxy lurks."},
             {"observer.velocity", "velocity", "Velocity estimate",
              choice<P, &P::velocity>(kVelocitySources), "-", 0, 2, 0, 2, false, true,
              "Velocity estimate: raw difference of positions, low-pass, or adaptive window "
              "(for coarse encoders)."}}};
  }
};

// Kinds of law, numbered in the order of Laws; recordings keep the number.
enum class CouplingKind : std::uint8_t { standard, proposed, predictive, tank };
using Laws = std::tuple<StandardLaw, ProposedLaw, PredictiveLaw, TankLaw>;

namespace detail {

template <class... Law>
struct Listed {
  struct Settings : Law::Settings... {};
  static constexpr std::array<const LawInfo*, sizeof...(Law)> kInfos{&Law::kInfo...};
  static constexpr std::array<const char*, sizeof...(Law)> kKeys{Law::kInfo.key...};
};
template <class... Law>
Listed<Law...> listed(std::tuple<Law...>*);
using AllLaws = decltype(listed(static_cast<Laws*>(nullptr)));

// Joins the texts that `put_law(put, law, number)` puts for each law, separated by `between`.
template <class PutLaw>
consteval auto text_of_all(std::string_view between, PutLaw put_law) {
  constexpr std::size_t kLongest = 1024;
  std::array<char, kLongest> text{};
  std::size_t at = 0;
  const auto put = [&](std::string_view part) {
    at = static_cast<std::size_t>(std::ranges::copy(part, text.begin() + at).out - text.begin());
  };
  for (std::size_t i = 0; i < AllLaws::kInfos.size(); ++i) {
    if (i > 0) put(between);
    put_law(put, *AllLaws::kInfos[i], i);
  }
  return text;
}

}  // namespace detail

// Settings of all laws: a law finds its own among them.
using LawSettings = detail::AllLaws::Settings;

// Descriptions of LawSettings, law by law, for an owner that inherits them.
template <class P>
constexpr auto law_settings() {
  return std::apply(
      [](auto... law) { return joined<P>(decltype(law)::Settings::template settings<P>()...); },
      Laws{});
}

inline const LawInfo& info(CouplingKind kind) {
  return *detail::AllLaws::kInfos[static_cast<std::size_t>(kind)];
}
// Next law when switching through all of them.
inline CouplingKind next(CouplingKind kind) {
  const auto i = static_cast<std::size_t>(kind) + 1;
  return static_cast<CouplingKind>(i % detail::AllLaws::kInfos.size());
}
inline constexpr auto& kLawKeys = detail::AllLaws::kKeys;
inline constexpr std::uint8_t kLaws = kLawKeys.size();
// Meanings of all laws: "standard: what it does. proposed: ...".
inline constexpr auto kLawMeanings =
    detail::text_of_all(" ", [](auto put, const LawInfo& law, std::size_t) {
      put(law.key);
      put(": ");
      put(law.meaning);
    });
// Numbers of all laws as recordings keep them: "0 standard, 1 proposed, ...".
inline constexpr auto kLawNumbers =
    detail::text_of_all(", ", [](auto put, const LawInfo& law, std::size_t number) {
      const char digit = static_cast<char>('0' + number);
      put({&digit, 1});
      put(" ");
      put(law.key);
    });
static_assert(kLaws <= 10);

}  // namespace limpid
