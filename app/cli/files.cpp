// Commands about session files.
#include <fmt/format.h>
#include <fmt/os.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <exception>
#include <filesystem>
#include <span>

#include "app/cli/commands.h"
#include "app/cli/options.h"
#include "app/run/replay.h"
#include "app/run/summary.h"
#include "app/story/run_story.h"
#include "devices/files/session/derived_columns.h"
#include "devices/files/session/session.h"
#include "devices/files/session/session_csv.h"

namespace limpid {
namespace {

struct InfoOptions {
  std::string session, csv;
  bool force = false;
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

int info(const InfoOptions& options) {
  keep_apart("--csv", options.csv, std::span(&options.session, 1));
  const Session session = read_session(options.session);
  const SessionInfo& i = session.info;
  const auto arm = recorded_arm(i);
  const std::vector<bool> slides = arm ? slides_of(*arm) : i.slides;
  Summary summary(session.layout, slides);
  for (std::size_t k = 0; k < session.size(); ++k) summary.add(session.row(k));
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
  if (session.twin) {
    Summary twin(session.layout, slides);
    for (std::size_t k = 0; k < session.twin->size(); ++k) twin.add(session.twin->row(k));
    fmt::print("two runs on one hand\n{}", Summary::beside(summary, "first", twin, "twin"));
  } else {
    fmt::print("{}", summary.text());
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
  if (!options.csv.empty()) {
    write_csv(session, options.csv, options.force);
    fmt::print("written as {}\n", options.csv);
  }
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
  command->add_option("SESSION.h5", options->session, "the recording")->type_name("")->required();
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
