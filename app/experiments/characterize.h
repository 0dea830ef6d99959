// Report of what an arm can render, law by law: walls, energy given and what is felt in free
// motion, measured on the virtual arm of its file beside what `limpid analyze` computes.
#pragma once

#include <string>
#include <vector>

#include "app/experiments/felt_impedance.h"
#include "app/experiments/law_bench.h"

namespace limpid {

// A number on which the measurements stand.
struct KnownNumber {
  std::string key, what, unit;
  double value = 0;
  std::string from;      // for people: "the device says so"
  bool assumed = false;  // nobody has measured, set or said it
};

// The arm that is characterized, the settings of its runs, and where these are from.
struct Characterized {
  ArmUnderLaw at;
  std::string name;  // of the device, or of the arm
  std::vector<KnownNumber> numbers;
};

// A law's measurements on that arm.
struct LawRendered {
  CouplingKind kind = CouplingKind::standard;
  double wall = 0;                    // stiffest that is felt as set and quiet [N/m]
  double named = 0;                   // stiffest by `limpid analyze` [N/m]
  std::string bound;                  // what bounds that
  std::vector<Came> taps = {};        // of kCommonWall, in each of kHands
  std::vector<FeltMotion> free = {};  // mass [kg] and damping [N s/m] at the tip; empty: unstable
  std::vector<FeltMotion> free_named = {};  // the same by `limpid analyze`

  double most_given() const;               // [J]
  std::pair<double, double> felt() const;  // stiffness, least and most of stable taps [N/m]
};

struct Characterization {
  std::vector<LawRendered> laws;
  Outcome outcome;
};

// Frequencies of free motion that are told of [Hz].
inline constexpr double kFreeTold[] = {0.5, 1, 2, 5, 10};

// Measures all laws of kBenchLaws. Errors: Cancelled.
Characterization characterize(TrialRunner& lab, const Characterized& subject);

// The most energy given in mJ, for people; "unstable" if a tap was.
std::string given_text(const LawRendered& law);
// The motion at that frequency; null: it was not measured.
const FeltMotion* at_frequency(const std::vector<FeltMotion>& felt, double f);
// "19066 or more" where the search ended at its end; "below 50" likewise [N/m].
std::string wall_text(double wall);

// Name of the files.
inline constexpr const char* kCharacterize = "characterize";

// Writes DIR/report.html, and DIR/characterize.json, .csv, .png and .svg. Errors: FileError,
// std::runtime_error.
void write_characterization(const Characterized& subject, const Characterization& found,
                            const std::filesystem::path& dir);

}  // namespace limpid
