// Commands about session files.
#include <fmt/format.h>
#include <fmt/os.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string_view>

#include "app/cli/commands.h"
#include "app/cli/options.h"
#include "app/cli/summary_json.h"
#include "app/remote/remote_settings.h"
#include "app/run/lane_settings.h"
#include "app/run/provenance.h"
#include "app/run/replay.h"
#include "app/run/run_watch.h"
#include "app/run/summary.h"
#include "app/story/run_story.h"
#include "devices/files/atomic_file.h"
#include "devices/files/session/derived_columns.h"
#include "devices/files/session/session.h"
#include "devices/files/session/session_csv.h"
#include "devices/files/session/session_stream.h"

namespace limpid {
namespace {

struct InfoOptions {
  std::string session, csv;
  bool force = false, json = false;
};

// Summary of a recording's rows, which arrive in pieces and need not be in memory.
class RowsTold {
 public:
  explicit RowsTold(std::string file) : file_(std::move(file)) {}

  void begins(const Session& about) {
    try {
      watch_.emplace(about, file_);
    } catch (const std::exception&) {
      watch_.reset();  // another version wrote the settings
    }
    const auto arm = recorded_arm(about.info);
    layout_ = about.layout;
    tick_ = about.info.tick;
    lanes_.assign(about.lanes(),
                  arm ? Summary(layout_, *arm) : Summary(layout_, about.info.slides));
    force_.emplace(layout_);
  }
  void take(LaneRows rows) {
    const auto stride = static_cast<std::size_t>(layout_.stride());
    const std::span<const double> first = rows[kMainLane];
    if (count_ == 0 && !first.empty()) {
      contacts_ = !std::isnan(layout_.in(first.first(stride), Column::contact_force)[0]);
    }
    for (std::size_t at = 0; at < first.size(); at += stride, ++count_) {
      force_->add(first.subspan(at, stride));
      const double late = layout_.in(first.subspan(at, stride), Column::wake_latency)[0];
      late_ += late > tick_ ? 1 : 0;
      latest_ = std::max(latest_, late);
      for (std::size_t i = 0; i < lanes_.size(); ++i) lanes_[i].add(rows[i].subspan(at, stride));
    }
    try {
      if (watch_) watch_->take(rows);
    } catch (const std::exception&) {
      watch_.reset();
    }
  }

  std::uint64_t count() const { return count_; }
  std::uint64_t late() const { return late_; }  // ticks that began after the next one was due
  double latest() const { return latest_; }     // most that a tick began late [s]
  // Warnings computed from the rows, so that older recordings have them as well.
  std::vector<std::string> warnings() const {
    return watch_ ? watch_->warnings() : std::vector<std::string>();
  }
  // Time of each lane with a motor at its limit [s]; empty where that is not known.
  std::vector<double> at_limit() const {
    return watch_ ? watch_->at_limit() : std::vector<double>();
  }
  std::vector<const Summary*> lanes() const {
    std::vector<const Summary*> all;
    for (const Summary& lane : lanes_) all.push_back(&lane);
    return all;
  }
  std::string text(double tick) const {
    return fmt::format("length                   {:.3f} s\n", static_cast<double>(count_) * tick) +
           numbers() + at_limit_text(at_limit()) + late_text() + force_->text(tick) +
           fmt::format("contacts                 {}\n", contacts());
  }

 private:
  // Says how many ticks of the loop came late; empty if none did.
  std::string late_text() const {
    if (late_ == 0) return {};
    return fmt::format("late ticks               {} of {}, at most {:.3g} ms late\n", late_, count_,
                       1e3 * latest_);
  }
  std::string numbers() const {
    if (lanes_.size() == 1) return lanes_[0].text();
    std::vector<std::string> names{"first"};
    for (std::size_t i = 1; i < lanes_.size(); ++i) names.push_back(lane_name(i));
    return fmt::format("{} runs with the same hand\n", lanes_.size() == 2 ? "two" : "three") +
           Summary::beside(lanes(), names);
  }
  // Describes the recorded contacts; recordings of the first edition have only their torque.
  std::string contacts() const {
    if (!contacts_) return "contact points and forces were not recorded";
    return fmt::format("the {} strongest contacts of every tick, x, y, z one after the other",
                       kRowContacts);
  }

  std::string file_;
  RowLayout layout_{3};
  std::optional<SessionWatch> watch_;
  std::vector<Summary> lanes_;
  std::optional<ForceTally> force_;
  std::uint64_t count_ = 0, late_ = 0;
  double tick_ = 0, latest_ = 0;  // [s]
  bool contacts_ = false;         // are recorded
};

// Settings of a lane's first row; nothing if this version does not know them.
std::optional<Parameters> first_settings(const Session& lane, const std::string& file) {
  try {
    return session_parameters(lane, file);
  } catch (const std::exception&) {
    return {};
  }
}

// Settings that differ from others, a line each; what stands in lines of its own is left out.
std::string unlike_text(const Parameters& p, const Parameters& others, const std::string& title) {
  std::string text;
  for (const ParameterInfo* setting : differing(p, others)) {
    const std::string_view key = setting->key;
    if (key == "coupling.kind" || key == "coupling.eta" || key == "loop.tick") continue;
    if (p.linked() && key.starts_with("link.")) continue;
    text +=
        fmt::format("{:<25}{} = {}\n", text.empty() ? title : "", key, parameter_text(p, *setting));
  }
  return text;
}

std::string settings_text(const Session& session, const std::string& file) {
  std::string text;
  std::optional<Parameters> before;
  for (std::size_t i = 0; i < session.lanes(); ++i) {
    const auto p = first_settings(session.lane(i), file);
    if (!p) return text;
    const std::string of = i == 0 ? "" : fmt::format("{}, ", lane_name(i));
    text += fmt::format("{:<25}{}, eta {:.3g}\n", of + "coupling at first", name(p->kind), p->eta);
    if (p->linked()) {
      text += fmt::format("{:<25}{} ticks each way, jitter {}, loss {:.3g}\n", of + "link at first",
                          p->link_delay, p->link_jitter, p->link_loss);
    }
    text += unlike_text(*p, before.value_or(Parameters{}),
                        i == 0 ? "settings unlike defaults" : of + "other settings");
    if (i == 0) before = p;
  }
  return text;
}

// All settings of a lane's first row, by key.
nlohmann::ordered_json settings_json(const Parameters& p) {
  nlohmann::ordered_json all;
  for (const ParameterInfo& setting : parameter_table()) {
    all[setting.key] = json_of(value_of(setting, p));
  }
  return all;
}

// Metadata of a CSV by W3C's "CSV on the Web": the source of the table.
std::string metadata_of(const InfoOptions& options, const SessionInfo& i) {
  const nlohmann::ordered_json json{{"@context", "http://www.w3.org/ns/csvw"},
                                    {"url", std::filesystem::path(options.csv).filename().string()},
                                    {"dc:source", options.session},
                                    {"dc:description", provenance_of(i)}};
  return json.dump(2) + "\n";
}

std::string metadata_file(const InfoOptions& options) { return options.csv + "-metadata.json"; }

void write_table(const InfoOptions& options, const Session& session) {
  write_csv(session, options.csv, options.force);
  std::error_code none;
  if (!std::filesystem::is_regular_file(options.csv, none)) return;  // standard output, or a pipe
  const std::string beside = metadata_file(options);
  const std::string wrong = try_write_atomically(beside, metadata_of(options, session.info));
  if (!wrong.empty()) throw FileError(wrong);
  fmt::print(options.json ? stderr : stdout, "table written as {}; the sources of the table: {}\n",
             options.csv, beside);
}

void print_json(const InfoOptions& options, const Session& session, const RowsTold& told,
                const std::vector<std::string>& warnings) {
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
                              {"late_ticks", told.late()},
                              {"largest_lateness_s", told.latest()},
                              {"length_s", static_cast<double>(told.count()) * i.tick},
                              {"objects", i.bodies}};
  json.update(runs_json(told.lanes(), warnings, told.at_limit()));
  for (std::size_t lane = 0; lane < session.lanes(); ++lane) {
    if (const auto p = first_settings(session.lane(lane), options.session)) {
      json["runs"][lane]["settings"] = settings_json(*p);
    }
  }
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

std::string about(const SessionInfo& i) {
  std::string text =
      fmt::format("created                  {} by limpid {}\n", i.created, i.app_version);
  if (!i.build.empty()) text += fmt::format("build                    {}\n", i.build);
  return text + fmt::format("hand                     {}\n", i.source);
}

std::string what_moves(const SessionInfo& i) {
  std::string text;
  if (!i.safety.empty()) {
    std::string limits = i.safety;
    std::ranges::replace(limits, '\n', ' ');
    text += fmt::format("limits of force          {}\n", limits);
  }
  text += fmt::format("arm                      {} joints, tick {} s, seed {}\n", i.dof, i.tick,
                      i.seed);
  if (!i.bodies.empty()) {
    text += fmt::format("objects that move        {}\n", fmt::join(i.bodies, ", "));
  }
  return text;
}

std::string warnings_text_of(const std::vector<std::string>& warnings) {
  std::string text;
  for (const std::string& warning : warnings) {
    text += fmt::format("warning                  {}\n", warning);
  }
  return text;
}

std::string happened(const Session& session) {
  std::string text;
  const auto seconds = [&](std::uint64_t row) {
    return static_cast<double>(row) * session.info.tick;
  };
  for (const SettingChange& change : session.changes) {
    text += fmt::format("from {:8.3f} s          {}\n", seconds(change.row), change.setting);
  }
  for (const Mark& mark : session.marks) {
    text += fmt::format("mark {:8.3f} s          {}\n", seconds(mark.tick), mark.text);
  }
  return text;
}

// Reads a recording; only writing a table takes all of it into memory.
Session read_and_tell(const InfoOptions& options, RowsTold& told) {
  if (options.csv.empty()) {
    return read_session(
        options.session, [&](const Session& about) { told.begins(about); },
        [&](LaneRows rows) { told.take(rows); });
  }
  Session session = read_session(options.session);
  told.begins(session);
  told.take(session.lane_rows());
  return session;
}

int info(const InfoOptions& options) {
  const bool to_stdout = options.csv == kStandardOutput;
  if (to_stdout && options.json) {
    throw UsageError("--json: not together with --csv -: both write to standard output");
  }
  if (!to_stdout) keep_apart("--csv", options.csv, std::span(&options.session, 1));
  std::error_code none;
  const bool pipe = to_stdout || (std::filesystem::exists(options.csv, none) &&
                                  !std::filesystem::is_regular_file(options.csv, none));
  if (!options.csv.empty() && !pipe) {
    check_place(options.csv, options.force);
    keep_apart("--csv", metadata_file(options), std::span(&options.session, 1));
    check_place(metadata_file(options), options.force);
  }
  RowsTold told(options.session);
  const Session session = read_and_tell(options, told);
  const std::vector<std::string> warnings = told.warnings();
  if (options.json) {
    print_json(options, session, told, warnings);
    if (!options.csv.empty()) write_table(options, session);
    return 0;
  }
  std::string text = options.session + "\n" + about(session.info) +
                     settings_text(session, options.session) + what_moves(session.info) +
                     told.text(session.info.tick) + warnings_text_of(warnings);
  if (const ToldSteps story = told_in(session, options.session); !story.steps.empty()) {
    text += fmt::format("story                    {}, {} steps\n", story.title, story.steps.size());
  }
  // Text moves to standard error if standard output has the table.
  fmt::print(to_stdout ? stderr : stdout, "{}{}", text, happened(session));
  if (options.csv.empty()) return 0;
  std::fflush(stdout);
  write_table(options, session);
  return 0;
}

struct RecoverOptions {
  std::string part, out;
  bool force = false;
};

int recover(const RecoverOptions& options) {
  if (!options.out.empty()) check_ending(options.out, kSessionEnding);
  const Recovered recovered = recover_session(options.part, options.force, options.out);
  fmt::print("{} ticks recovered in {}\n", recovered.rows, recovered.file.string());
  return 0;
}

}  // namespace

Command declare_info(CLI::App& app) {
  auto* command = app.add_subcommand("info", "shows what a recording contains");
  auto options = std::make_shared<InfoOptions>();
  command->add_option("SESSION.h5", options->session, "the recording")
      ->transform(or_shipped({"sessions"}), "", "")
      ->type_name("")
      ->required();
  command->add_flag("--json", options->json, "one JSON object on standard output");
  command->add_option("--csv", options->csv, "write the recording as a table; - is standard output")
      ->type_name("OUT.csv");
  command->add_flag("--force", options->force, "replace OUT.csv if it exists");
  return [options] { return info(*options); };
}

Command declare_recover(CLI::App& app) {
  auto* command =
      app.add_subcommand("recover", "makes a session file from a recording that was interrupted");
  auto options = std::make_shared<RecoverOptions>();
  command
      ->add_option("SESSION.h5.part", options->part,
                   "the recording that was interrupted: a file whose name ends in .part; it is "
                   "deleted when the session file is complete")
      ->type_name("")
      ->required();
  command->add_option("--out", options->out, "the file to write instead of SESSION.h5")
      ->type_name("OUT.h5");
  command->add_flag("--force", options->force, "replace the file if it exists");
  return [options] { return recover(*options); };
}

}  // namespace limpid
