#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/experiments/experiment.h"

namespace limpid {

// Each in its own file, NAME.cpp.
Outcome coordination(Laboratory& lab);
Outcome inertia(Laboratory& lab);
Outcome passivity(Laboratory& lab);
Outcome spectrum(Laboratory& lab);
Outcome saturation(Laboratory& lab);
Outcome observer(Laboratory& lab);
Outcome transparency(Laboratory& lab);
Outcome eta_min_map(Laboratory& lab);
Outcome lightness(Laboratory& lab);
Outcome zwidth(Laboratory& lab);
Outcome switching(Laboratory& lab);
Outcome friction(Laboratory& lab);
Outcome delay(Laboratory& lab);
Outcome walls(Laboratory& lab);

namespace {

constexpr std::array kExperiments{
    Experiment{"coordination", "device-proxy coordination in contact (Figs. 3 and 4)",
               coordination},
    Experiment{"inertia", "human torque for the same free motion at three etas (Fig. 5)", inertia},
    Experiment{"passivity", "controller energy over many trials (Fig. 6)", passivity},
    Experiment{"spectrum", "frequency content of the hand's motion (Fig. 7)", spectrum},
    Experiment{"saturation",
               "contact beyond the torque limit, with and without anti-windup "
               "(section 3.1), and between walls",
               saturation},
    Experiment{"observer", "bandwidth of the human force estimate (section 3.1)", observer},
    Experiment{"transparency", "impedance felt at the handle", transparency},
    Experiment{"eta_min", "stability over eta and grip against theory (section 4.2)", eta_min_map},
    Experiment{"lightness", "inertia and damping felt, and what a passive law pays for lightness",
               lightness},
    Experiment{"zwidth", "the stiffest wall that is rendered well", zwidth},
    Experiment{"switching", "contacts made and broken, couplings switched while pressing",
               switching},
    Experiment{"friction", "sticking, slipping, and the energy that friction takes", friction},
    Experiment{"delay", "what is given and felt where the device's torque comes late", delay},
    Experiment{"walls", "walls of any arm, as stiff as limpid analyze names them", walls},
};

void write_verdict(const std::string& name, const Outcome& outcome,
                   const std::filesystem::path& file) {
  nlohmann::ordered_json checks = nlohmann::ordered_json::array();
  for (const Check& c : outcome.checks) {
    checks.push_back(
        {{"what", c.what}, {"value", c.value}, {"bound", c.bound}, {"passed", c.passed}});
  }
  const nlohmann::ordered_json verdict{{"name", name},
                                       {"passed", outcome.passed()},
                                       {"title", outcome.figure.title},
                                       {"caption", outcome.figure.caption},
                                       {"checks", checks}};
  std::ofstream out(file);
  out << verdict.dump(2) << '\n';
  if (!out.flush()) throw FileError(file.string() + ": could not be written");
}

}  // namespace

std::span<const Experiment> experiments() { return kExperiments; }

void write_outcome(const std::string& name, const Outcome& outcome,
                   const std::filesystem::path& dir) {
  std::filesystem::create_directories(dir);
  write_figure_data(outcome.figure, dir / (name + ".csv"));
  draw_figure(outcome.figure, dir, name);
  // Last, so that a verdict says that everything else is there.
  write_verdict(name, outcome, dir / (name + ".json"));
}

Outcome carry_out(const Experiment& experiment, const Laboratory::Options& options) {
  std::filesystem::create_directories(options.dir);
  Laboratory lab(experiment.name, options);
  Outcome outcome = experiment.run(lab);
  const std::string conditions = lab.conditions().text();
  if (!conditions.empty()) {
    outcome.figure.caption += " " + conditions;
    outcome.checks.push_back(at_most("trials that diverged, of those that may not",
                                     static_cast<double>(lab.diverged()), 0));
  }
  write_outcome(experiment.name, outcome, options.dir);
  return outcome;
}

}  // namespace limpid
