#include "core/tick/parameters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <string>

namespace limpid {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string refusal(const char* key, const ParameterValue& value) {
  Parameters p;
  try {
    set_parameter(p, key, value);
  } catch (const ParameterError& e) {
    EXPECT_EQ(p, Parameters{}) << key << " changed something though it was refused";
    return e.what();
  }
  return "";
}

TEST(Parameters, DefaultToThePapersValues) {
  const Parameters p;
  EXPECT_EQ(p.k_vc, 10);
  EXPECT_EQ(p.b_vc, 0.001);
  EXPECT_EQ(p.b_v, 0.012);
  EXPECT_EQ(p.alpha, 0.035);
  EXPECT_EQ(p.inertia_ratio, 1e-4);
  EXPECT_EQ(p.tick, 0.001);
}

TEST(Parameters, HaveEveryKeyOfTheContractOnce) {
  const std::set<std::string> contract{"coupling.kind",
                                       "coupling.k_vc",
                                       "coupling.b_vc",
                                       "coupling.b_v",
                                       "coupling.per_joint",
                                       "coupling.eta",
                                       "observer.alpha",
                                       "observer.anti_windup",
                                       "observer.velocity",
                                       "proxy.inertia_ratio",
                                       "model.inertia_error",
                                       "hand.stiffness",
                                       "hand.damping",
                                       "loop.tick",
                                       "device.substeps",
                                       "device.encoder_step",
                                       "device.friction",
                                       "device.damping",
                                       "device.torque_limit",
                                       "coupling.damping",
                                       "coupling.band",
                                       "predictor.p",
                                       "predictor.mu",
                                       "predictor.hand_mass",
                                       "ledger.energy",
                                       "hand.mass",
                                       "device.delay",
                                       "model.delay",
                                       "model.delay_most",
                                       "model.gravity",
                                       "device.down",
                                       "model.friction",
                                       "model.springs",
                                       "device.gravity",
                                       "device.springs",
                                       "plant.torque_scale",
                                       "plant.current_loop",
                                       "plant.resonance",
                                       "plant.cogging",
                                       "plant.friction",
                                       "plant.eccentricity",
                                       "plant.zero",
                                       "link.delay",
                                       "link.jitter",
                                       "link.loss",
                                       "link.seed",
                                       "tank.energy",
                                       "tank.most",
                                       "tank.share",
                                       "tank.damping",
                                       "eba.damping",
                                       "popc.damping",
                                       "popc.reference",
                                       "wave.b",
                                       "wave.matched",
                                       "tdpn.damping",
                                       "tdpn.drift",
                                       "sfa.soft",
                                       "sfa.step",
                                       "sfa.extended"};
  std::set<std::string> found;
  for (const ParameterInfo& info : parameter_table()) {
    EXPECT_TRUE(found.insert(info.key).second) << info.key;
    EXPECT_EQ(find_parameter(info.key), &info);
  }
  EXPECT_EQ(found, contract);
  EXPECT_EQ(find_parameter("coupling.k"), nullptr);
}

TEST(ParameterTable, IsConsistentAndHoldsTheDefaults) {
  const Parameters defaults;
  for (const ParameterInfo& info : parameter_table()) {
    EXPECT_LT(info.minimum, info.maximum) << info.key;
    EXPECT_LT(info.slider_minimum, info.slider_maximum) << info.key;
    EXPECT_GE(info.slider_minimum, info.minimum) << info.key;
    EXPECT_LE(info.slider_maximum, info.maximum) << info.key;
    if (info.logarithmic) {
      EXPECT_GT(info.slider_minimum, 0) << info.key;
    }
    EXPECT_GT(std::strlen(info.meaning), 20u) << info.key;
    if (info.kind == FieldInfo::Kind::number) {
      const double value = parameter_number(defaults, info);
      EXPECT_TRUE(std::isnan(value) || (value >= info.minimum && value <= info.maximum))
          << info.key;
    }
  }
}

TEST(SetParameter, TakesBothEndsOfEveryRangeAndNothingBeyond) {
  for (const ParameterInfo& info : parameter_table()) {
    if (!info.is_number()) continue;
    Parameters p;
    EXPECT_NO_THROW(set_parameter(p, info.key, info.minimum)) << info.key;
    EXPECT_NO_THROW(set_parameter(p, info.key, info.maximum)) << info.key;
    const double below = info.minimum - 1, above = info.maximum * 1.01;
    EXPECT_THAT(refusal(info.key, below), HasSubstr(info.key));
    EXPECT_THAT(refusal(info.key, above), HasSubstr(info.key));
  }
}

TEST(SetParameter, RefusesWhatIsNoNumberNamingKeyFoundAndAllowed) {
  for (const ParameterInfo& info : parameter_table()) {
    if (!info.is_number()) continue;
    for (const ParameterValue& bad :
         {ParameterValue(std::nan("")), ParameterValue(std::numeric_limits<double>::infinity()),
          ParameterValue(-std::numeric_limits<double>::infinity())}) {
      EXPECT_THAT(refusal(info.key, bad), AllOf(HasSubstr(info.key), HasSubstr("allowed")));
    }
    EXPECT_THAT(refusal(info.key, std::string("fast")),
                AllOf(HasSubstr(info.key), HasSubstr("\"fast\""), HasSubstr("allowed")));
    EXPECT_THAT(refusal(info.key, true), AllOf(HasSubstr(info.key), HasSubstr("true")));
  }
}

TEST(SetParameter, NamesFoundAndAllowedInItsMessages) {
  EXPECT_THAT(refusal("coupling.k_vc", -3.0),
              AllOf(HasSubstr("coupling.k_vc"), HasSubstr("-3"), HasSubstr("0.001"),
                    HasSubstr("10000"), HasSubstr("N m/rad")));
  EXPECT_THAT(refusal("coupling.kind", std::string("best")),
              AllOf(HasSubstr("coupling.kind"), HasSubstr("\"best\""), HasSubstr("standard"),
                    HasSubstr("proposed")));
  EXPECT_THAT(refusal("observer.velocity", std::int64_t{1}),
              AllOf(HasSubstr("observer.velocity"), HasSubstr("1"), HasSubstr("raw"),
                    HasSubstr("lowpass"), HasSubstr("adaptive")));
  EXPECT_THAT(refusal("observer.anti_windup", 1.0),
              AllOf(HasSubstr("observer.anti_windup"), HasSubstr("true, false")));
  EXPECT_THAT(refusal("device.substeps", 2.5),
              AllOf(HasSubstr("device.substeps"), HasSubstr("2.5"), HasSubstr("whole number")));
  EXPECT_THAT(refusal("coupling.stiffness", 1.0), HasSubstr("coupling.stiffness"));
}

TEST(SetParameter, TakesWholeNumbersForNumbers) {
  Parameters p;
  set_parameter(p, "coupling.k_vc", std::int64_t{7});
  set_parameter(p, "device.substeps", std::int64_t{5});
  set_parameter(p, "coupling.kind", std::string("standard"));
  set_parameter(p, "observer.velocity", std::string("adaptive"));
  set_parameter(p, "observer.anti_windup", false);
  EXPECT_EQ(p.k_vc, 7);
  EXPECT_EQ(p.substeps, 5);
  EXPECT_EQ(p.kind, CouplingKind::standard);
  EXPECT_EQ(p.velocity, VelocitySource::adaptive);
  EXPECT_FALSE(p.anti_windup);
}

TEST(ParameterText, GivesTheSameNumberBackToTheLastBit) {
  for (const ParameterInfo& info : parameter_table()) {
    if (info.kind != FieldInfo::Kind::number) continue;
    for (const double part : {0.0, 1.0 / 3, 0.7310585786300049, 1.0}) {
      Parameters p;
      const double value = info.minimum + part * (info.maximum - info.minimum);
      set_parameter(p, info.key, value);
      const std::string text = parameter_text(p, info);
      EXPECT_EQ(std::stod(text), value) << info.key;
      EXPECT_THAT(text, testing::ContainsRegex("[.e]")) << "an integer to TOML";
    }
  }
}

TEST(ParameterText, SpellsChoicesAndLeavesTheArmsOwnEmpty) {
  Parameters p;
  EXPECT_EQ(parameter_text(p, *find_parameter("coupling.kind")), "\"proposed\"");
  EXPECT_EQ(parameter_text(p, *find_parameter("observer.velocity")), "\"raw\"");
  EXPECT_EQ(parameter_text(p, *find_parameter("observer.anti_windup")), "true");
  EXPECT_EQ(parameter_text(p, *find_parameter("device.substeps")), "20");
  EXPECT_EQ(parameter_text(p, *find_parameter("device.damping")), "");
}

TEST(Parameters, AreEqualIfEveryOneOfThemIs) {
  EXPECT_EQ(Parameters{}, Parameters{});  // also values left to the arm, which are not numbers
  for (const ParameterInfo& info : parameter_table()) {
    Parameters p;
    if (info.kind == FieldInfo::Kind::whole) {
      set_parameter(p, info.key, std::int64_t{3});
    } else if (info.is_number()) {
      set_parameter(p, info.key, info.minimum + 0.3 * (info.maximum - info.minimum));
    } else if (info.kind == FieldInfo::Kind::flag) {
      set_parameter(p, info.key, parameter_number(p, info) == 0);
    } else if (info.key == std::string("coupling.kind")) {
      set_parameter(p, info.key, std::string("standard"));
    } else {
      set_parameter_number(p, info, 1);
    }
    EXPECT_FALSE(p == Parameters{}) << info.key;
    EXPECT_EQ(p, p) << info.key;
  }
}

}  // namespace
}  // namespace limpid
