// Commands about session files.
#include <fmt/format.h>
#include <fmt/os.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <span>

#include "app/cli/commands.h"
#include "app/cli/options.h"
#include "app/run/replay.h"
#include "app/run/summary.h"
#include "app/story/run_story.h"
#include "devices/files/session/derived_columns.h"
#include "devices/files/session/session.h"
#include "devices/files/session/session_csv.h"
#include "devices/files/session/session_stream.h"

namespace limpid {
namespace {

struct InfoOptions {
  std::string session, csv;
  bool force = false;
};

// What the rows of a recording amount to, whichever of them are in memory.
class RowsTold {
 public:
  void begins(const Session& about) {
    const auto arm = recorded_arm(about.info);
    const std::vector<bool> slides = arm ? slides_of(*arm) : about.info.slides;
    layout_ = about.layout;
    first_.emplace(layout_, slides);
    if (about.twin) twin_.emplace(layout_, slides);
    force_.emplace(layout_);
  }
  void take(std::span<const double> rows, std::span<const double> twin) {
    const auto stride = static_cast<std::size_t>(layout_.stride());
    if (count_ == 0 && !rows.empty()) {
      contacts_ = !std::isnan(layout_.in(rows.first(stride), Column::contact_force)[0]);
    }
    for (std::size_t at = 0; at < rows.size(); at += stride, ++count_) {
      first_->add(rows.subspan(at, stride));
      force_->add(rows.subspan(at, stride));
      if (twin_) twin_->add(twin.subspan(at, stride));
    }
  }

  std::string text(double tick) const {
    return fmt::format("length                   {:.3f} s\n", static_cast<double>(count_) * tick) +
           numbers() + force_->text(tick) +
           fmt::format("contacts                 {}\n", contacts());
  }

 private:
  std::string numbers() const {
    if (!twin_) return first_->text();
    return "two runs on one hand\n" + Summary::beside(*first_, "first", *twin_, "twin");
  }
  // Recordings of the first edition have but the torque of their contacts.
  std::string contacts() const {
    if (!contacts_) return "where and how hard was not recorded";
    return fmt::format("the {} hardest of every tick, x, y, z one after the other", kRowContacts);
  }

  RowLayout layout_{3};
  std::optional<Summary> first_, twin_;
  std::optional<ForceTally> force_;
  std::uint64_t count_ = 0;
  bool contacts_ = false;  // are known
};

// Those of the first row. What another version wrote and this one does not know is left out.
std::string settings_text(const Session& session, const std::string& file) {
  try {
    const Parameters p = session_parameters(session, file);
    std::string text =
        fmt::format("coupling at first        {}, eta {:.3g}\n", name(p.kind), p.eta);
    if (!p.linked()) return text;
    return text +
           fmt::format("link at first            {} ticks each way, jitter {}, loss {:.3g}\n",
                       p.link_delay, p.link_jitter, p.link_loss);
  } catch (const std::exception&) {
    return {};
  }
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

// Only a table takes all of the recording into memory.
Session read_and_tell(const InfoOptions& options, RowsTold& told) {
  if (options.csv.empty()) {
    return read_session(
        options.session, [&](const Session& about) { told.begins(about); },
        [&](std::span<const double> rows, std::span<const double> twin) { told.take(rows, twin); });
  }
  Session session = read_session(options.session);
  told.begins(session);
  told.take(session.rows,
            session.twin ? std::span<const double>(session.twin->rows) : std::span<const double>());
  return session;
}

int info(const InfoOptions& options) {
  const bool to_stdout = options.csv == kStandardOutput;
  if (!to_stdout) keep_apart("--csv", options.csv, std::span(&options.session, 1));
  RowsTold told;
  const Session session = read_and_tell(options, told);
  std::string text = options.session + "\n" + about(session.info) +
                     settings_text(session, options.session) + what_moves(session.info) +
                     told.text(session.info.tick);
  if (const ToldSteps story = told_in(session, options.session); !story.steps.empty()) {
    text += fmt::format("story                    {}, {} steps\n", story.title, story.steps.size());
  }
  // A table on standard output stands there alone.
  fmt::print(to_stdout ? stderr : stdout, "{}{}", text, happened(session));
  if (options.csv.empty()) return 0;
  std::fflush(stdout);
  write_csv(session, options.csv, options.force);
  if (!to_stdout) fmt::print("written as {}\n", options.csv);
  return 0;
}

struct RecoverOptions {
  std::string part, out;
  bool force = false;
};

int recover(const RecoverOptions& options) {
  const Recovered recovered = recover_session(options.part, options.force, options.out);
  fmt::print("{} ticks recovered in {}\n", recovered.rows, recovered.file.string());
  return 0;
}

}  // namespace

Command declare_info(CLI::App& app) {
  auto* command = app.add_subcommand("info", "what a recording holds");
  auto options = std::make_shared<InfoOptions>();
  command->add_option("SESSION.h5", options->session, "the recording")->type_name("")->required();
  command->add_option("--csv", options->csv, "write it as a table; - is standard output")
      ->type_name("OUT.csv");
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
  command->add_option("--out", options->out, "another name or disk, in place of SESSION.h5")
      ->type_name("OUT.h5");
  command->add_flag("--force", options->force, "replace the file if it exists");
  return [options] { return recover(*options); };
}

}  // namespace limpid
