#include "app/doctor/doctor.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/cli/commands.h"

namespace limpid {
namespace {

using State = Finding::State;

const char* word(State state) {
  switch (state) {
    case State::fine: return "ok";
    case State::better: return "better";
    case State::broken: return "broken";
  }
  return "";
}

void print(const DoctorFindings& all) {
  std::string area;
  for (const Finding& finding : all) {
    if (finding.area != area) fmt::print("{}{}\n", area.empty() ? "" : "\n", finding.area);
    area = finding.area;
    fmt::print("  {:<7} {:<16} {}\n", word(finding.state), finding.what, finding.found);
    if (!finding.cost.empty()) fmt::print("{:27}{}\n", "", finding.cost);
    if (!finding.mend.empty()) fmt::print("{:27}-> {}\n", "", finding.mend);
  }
}

void print_json(const DoctorFindings& all, State worst) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Finding& finding : all) {
    list.push_back({{"area", finding.area},
                    {"what", finding.what},
                    {"state", word(finding.state)},
                    {"found", finding.found},
                    {"cost", finding.cost},
                    {"mend", finding.mend}});
  }
  fmt::print("{}\n", nlohmann::ordered_json{{"state", word(worst)}, {"findings", list}}.dump(2));
}

int doctor(bool json) {
  DoctorFindings all;
  // The picture comes first: its processes must be made while there is only one thread.
  const DoctorFindings picture = look_at_picture();
  for (const DoctorFindings& some :
       {look_at_real_time(), look_at_devices(), picture, look_at_files()}) {
    all.insert(all.end(), some.begin(), some.end());
  }
  const State worst = std::ranges::max_element(all, {}, &Finding::state)->state;
  if (json) {
    print_json(all, worst);
  } else {
    print(all);
    fmt::print("\n{}\n", worst == State::fine     ? "all is well"
                         : worst == State::better ? "all works; some things can be improved"
                                                  : "something does not work");
  }
  return static_cast<int>(worst);
}

}  // namespace

Command declare_doctor(CLI::App& app) {
  auto* command = app.add_subcommand("doctor",
                                     "shows what is missing on this computer for real time, "
                                     "devices and picture, and which command repairs it");
  auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "one JSON object on standard output");
  command->footer(
      "The command needs no display, opens no device and changes nothing. Exit status: 0 all is "
      "well, 1 all works,\nbut some things can be improved, 2 something does not work.");
  return [json] { return doctor(*json); };
}

}  // namespace limpid
