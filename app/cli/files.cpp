// Commands about session files.
#include <fmt/format.h>
#include <fmt/os.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "app/cli/commands.h"
#include "app/cli/options.h"
#include "app/cli/summary_json.h"
#include "app/run/provenance.h"
#include "app/run/replay.h"
#include "app/run/run_watch.h"
#include "app/run/summary.h"
#include "app/story/run_story.h"
#include "devices/files/atomic_file.h"
#include "devices/files/session/derived_columns.h"
#include "devices/files/session/session.h"
#include "devices/files/session/session_csv.h"

namespace limpid {
namespace {

struct InfoOptions {
  std::string session, csv;
  bool force = false, json = false;
};

// Recordings of the first edition have but the torque of their contacts.
std::string contacts(const Session& session) {
  const bool known = session.size() > 0 && !std::isnan(session.at(0, Column::contact_force)[0]);
  if (!known) return "where and how hard was not recorded";
  return fmt::format("the {} hardest of every tick, x, y, z one after the other", kRowContacts);
}

// Those of the first row. What another version wrote and this one does not know is left out.
void print_settings(const Session& session, const std::string& file) {
  try {
    const Parameters p = session_parameters(session, file);
    fmt::print("coupling at first        {}, eta {:.3g}\n", name(p.kind), p.eta);
    if (!p.linked()) return;
    fmt::print("link at first            {} ticks each way, jitter {}, loss {:.3g}\n", p.link_delay,
               p.link_jitter, p.link_loss);
  } catch (const std::exception&) {
    return;
  }
}

// As its rows have them, so those of recordings that were made before there were any, too. None of
// another version's settings.
std::vector<std::string> warnings_in(const Session& session, const std::string& file) {
  try {
    return warnings_of(session, file);
  } catch (const std::exception&) {
    return {};
  }
}

// Whose table a CSV is, for a file beside it as W3C's "CSV on the Web" has it.
std::string metadata_of(const InfoOptions& options, const SessionInfo& i) {
  const nlohmann::ordered_json json{{"@context", "http://www.w3.org/ns/csvw"},
                                    {"url", std::filesystem::path(options.csv).filename().string()},
                                    {"dc:source", options.session},
                                    {"dc:description", provenance_of(i)}};
  return json.dump(2) + "\n";
}

void write_table(const InfoOptions& options, const Session& session) {
  write_csv(session, options.csv, options.force);
  if (!std::filesystem::is_regular_file(options.csv)) return;  // a pipe
  const std::string beside = options.csv + "-metadata.json";
  const std::string wrong = try_write_atomically(beside, metadata_of(options, session.info));
  if (!wrong.empty()) throw FileError(wrong);
  fmt::print(options.json ? stderr : stdout, "written as {}; where it is from: {}\n", options.csv,
             beside);
}

void print_json(const InfoOptions& options, const Session& session, const Summary& summary,
                const Summary* twin) {
  const SessionInfo& i = session.info;
  nlohmann::ordered_json json{{"provenance", provenance_of(i)},
                              {"file", options.session},
                              {"created", i.created},
                              {"app_version", i.app_version},
                              {"build", i.build},
                              {"source", i.source},
                              {"joints", i.dof},
                              {"tick_s", i.tick},
                              {"seed", i.seed},
                              {"length_s", static_cast<double>(session.size()) * i.tick},
                              {"objects", i.bodies}};
  std::vector<const Summary*> lanes{&summary};
  if (twin != nullptr) lanes.push_back(twin);
  json.update(runs_json(lanes, warnings_in(session, options.session)));
  json["changes"] = nlohmann::ordered_json::array();
  for (const SettingChange& change : session.changes) {
    json["changes"].push_back({{"row", change.row}, {"setting", change.setting}});
  }
  json["marks"] = nlohmann::ordered_json::array();
  for (const Mark& mark : session.marks) {
    json["marks"].push_back({{"row", mark.tick}, {"text", mark.text}});
  }
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

int info(const InfoOptions& options) {
  keep_apart("--csv", options.csv, std::span(&options.session, 1));
  std::error_code none;
  const bool pipe = std::filesystem::exists(options.csv, none) &&
                    !std::filesystem::is_regular_file(options.csv, none);
  if (!options.csv.empty() && !pipe) check_place(options.csv, options.force);
  const Session session = read_session(options.session);
  const SessionInfo& i = session.info;
  const auto arm = recorded_arm(i);
  const std::vector<bool> slides = arm ? slides_of(*arm) : i.slides;
  Summary summary(session.layout, slides);
  for (std::size_t k = 0; k < session.size(); ++k) summary.add(session.row(k));
  std::optional<Summary> twin;
  if (session.twin) {
    twin.emplace(session.layout, slides);
    for (std::size_t k = 0; k < session.twin->size(); ++k) twin->add(session.twin->row(k));
  }
  if (options.json) {
    print_json(options, session, summary, twin ? &*twin : nullptr);
    if (!options.csv.empty()) write_table(options, session);
    return 0;
  }
  fmt::print("{}\n", options.session);
  fmt::print("created                  {} by limpid {}\n", i.created, i.app_version);
  if (!i.build.empty()) fmt::print("build                    {}\n", i.build);
  fmt::print("hand                     {}\n", i.source);
  print_settings(session, options.session);
  if (!i.safety.empty()) {
    std::string limits = i.safety;
    std::ranges::replace(limits, '\n', ' ');
    fmt::print("limits of force          {}\n", limits);
  }
  fmt::print("arm                      {} joints, tick {} s, seed {}\n", i.dof, i.tick, i.seed);
  if (!i.bodies.empty()) {
    fmt::print("objects that move        {}\n", fmt::join(i.bodies, ", "));
  }
  fmt::print("length                   {:.3f} s\n", static_cast<double>(session.size()) * i.tick);
  if (twin) {
    fmt::print("two runs on one hand\n{}", Summary::beside(summary, "first", *twin, "twin"));
  } else {
    fmt::print("{}", summary.text());
  }
  for (const std::string& warning : warnings_in(session, options.session)) {
    fmt::print("warning                  {}\n", warning);
  }
  fmt::print("{}", force_tally(session));
  fmt::print("contacts                 {}\n", contacts(session));
  if (const ToldSteps told = told_in(options.session); !told.steps.empty()) {
    fmt::print("story                    {}, {} steps\n", told.title, told.steps.size());
  }
  for (const SettingChange& change : session.changes) {
    fmt::print("from {:8.3f} s          {}\n", static_cast<double>(change.row) * i.tick,
               change.setting);
  }
  for (const Mark& mark : session.marks) {
    fmt::print("mark {:8.3f} s          {}\n", static_cast<double>(mark.tick) * i.tick, mark.text);
  }
  if (!options.csv.empty()) write_table(options, session);
  return 0;
}

struct RecoverOptions {
  std::string part;
  bool force = false;
};

int recover(const RecoverOptions& options) {
  const Recovered recovered = recover_session(options.part, options.force);
  fmt::print("{} ticks recovered in {}\n", recovered.rows, recovered.file.string());
  return 0;
}

}  // namespace

Command declare_info(CLI::App& app) {
  auto* command = app.add_subcommand("info", "what a recording holds");
  auto options = std::make_shared<InfoOptions>();
  command->add_option("SESSION.h5", options->session, "the recording")
      ->transform(or_shipped({"sessions"}), "", "")
      ->type_name("")
      ->required();
  command->add_flag("--json", options->json, "one JSON object on standard output");
  command->add_option("--csv", options->csv, "write it as a table")->type_name("OUT.csv");
  command->add_flag("--force", options->force, "replace OUT.csv if it exists");
  return [options] { return info(*options); };
}

Command declare_recover(CLI::App& app) {
  auto* command =
      app.add_subcommand("recover", "what a killed recording left, as a proper session file");
  auto options = std::make_shared<RecoverOptions>();
  command->add_option("SESSION.h5.part", options->part, "the leftover, with .part at its end")
      ->type_name("")
      ->required();
  command->add_flag("--force", options->force, "replace SESSION.h5 if it exists");
  return [options] { return recover(*options); };
}

}  // namespace limpid
