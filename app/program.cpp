#include "app/program.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <span>

#include "app/base/version.h"
#include "app/cli/commands.h"
#include "app/cli/complete.h"
#include "app/cli/options.h"
#include "app/open_window.h"
#include "app/window_keys.h"
#include "devices/files/toml_reader.h"

namespace limpid {
namespace {

// Reports bad usage or input, found before anything was written.
int refuse(const std::exception& e) {
  fmt::print(stderr, "limpid: {}\n", e.what());
  return 2;
}

// Refuses options of the window before a command that opens none, where they would be lost.
void check_order(const CLI::App& app, const CLI::App& command) {
  for (const CLI::Option* option : app.get_options()) {
    if (option->count() == 0) continue;
    const std::string name = option->get_name();
    if (name == "FILE") {
      throw UsageError(
          fmt::format("\"{0}\" must not stand before the command {1}; `limpid {1} --help` lists "
                      "its options; `limpid {0}` would open a file with this name",
                      option->results().front(), command.get_name()));
    }
    if (command.get_option_no_throw(name) == nullptr) {
      throw UsageError(fmt::format("{}: is an option of the window, and limpid {} opens no window",
                                   name, command.get_name()));
    }
    throw UsageError(fmt::format("{0}: stands before the command; write limpid {1} {0} ...", name,
                                 command.get_name()));
  }
}

// Reports a failed write to standard output, which may be all that a command is for.
int if_written(int status) {
  errno = 0;
  std::cout.flush();
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout) return status;
  fmt::print(stderr, "limpid: standard output: {}\n", std::strerror(errno != 0 ? errno : EIO));
  return status == 0 ? 1 : status;
}

// Whether words are `limpid help` or `limpid help COMMAND`; not if a file is called help.
bool asks_for_help(const std::vector<std::string>& words) {
  return !words.empty() && words.size() <= 2 && words[0] == "help" &&
         !std::filesystem::exists(words[0]);
}

UsageError unexpected(const CLI::App& app) {
  const auto words = app.remaining(true);
  const CLI::App* chosen = &app;
  std::string command = "limpid";
  while (!chosen->get_subcommands().empty()) {
    chosen = chosen->get_subcommands().front();
    command += " " + chosen->get_name();
  }
  std::vector<std::string> known;
  for (const CLI::Option* option : chosen->get_options()) {
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  }
  const std::string first = words.empty() ? "" : words.front().substr(0, words.front().find('='));
  const auto meant = first.starts_with("-") ? nearest(first, known) : std::nullopt;
  return UsageError(fmt::format("\"{}\": not expected here; {}`{} --help` lists what is allowed",
                                fmt::join(words, " "),
                                meant ? fmt::format("did you mean {}? ", *meant) : "", command));
}

// Calls `prepare` for each command below `app`, and for those below these.
void for_each_command(CLI::App& app, const std::function<void(CLI::App&)>& prepare) {
  for (CLI::App* command : app.get_subcommands({})) {
    prepare(*command);
    for_each_command(*command, prepare);
  }
}

// Declares the commands that open no window, by name.
std::map<std::string, Command> declare_commands(CLI::App& app, char** argv,
                                                const VideoMakers& videos) {
  std::map<std::string, Command> commands;
  commands["run"] = declare_run(app);
  commands["serve"] = declare_serve(app);
  commands["experiment"] = declare_experiment(app);
  commands["sweep"] = declare_sweep(app);
  commands["analyze"] = declare_analyze(app);
  commands["characterize"] = declare_characterize(app);
  commands["check"] = declare_check(app);
  commands["info"] = declare_info(app);
  commands["recover"] = declare_recover(app);
  commands["devices"] = declare_devices(app);
  commands["identify"] = declare_identify(app);
  commands["doctor"] = declare_doctor(app);
  commands["manual"] = declare_manual(app);
  commands["share"] = declare_share(app, keys_of_window());
  commands["story"] =
      declare_story(app, [=](const std::string& script, const VideoOptions& options, double) {
        return videos.of_story(script, options, argv);
      });
  return commands;
}

}  // namespace

int run_program(int argc, char** argv, const VideoMakers& videos) {
  CLI::App app{"Limpid: touch a virtual world and see how transparent the coupling is."};
  app.name("limpid");
  const std::string version = std::string("limpid ") + program_version();
  app.set_version_flag("-V,--version", version);
  app.require_subcommand(0, 1);
  const auto commands = declare_commands(app, argv, videos);
  const WindowCommands window = declare_window(
      app, [=](const std::string& session, const VideoOptions& options, double text_scale) {
        return videos.of_session(session, options, text_scale, argv);
      });
  app.footer(
      "Without a command, the desktop app starts. `limpid COMMAND --help` says more about a "
      "command.\nExit status: 0 done; 1 the run failed, became unstable, or was stopped (Ctrl-C); "
      "2 wrong usage or bad input. `serve` is stopped with Ctrl-C, and ends with 0; `doctor "
      "--help` lists the exit statuses of `doctor`.\nA complete run that gave energy ends with 0, "
      "and with a warning; the recording keeps this warning.");
  refuse_empty_values(app);
  for_each_command(app, [&](CLI::App& command) {
    command.set_version_flag("-V,--version", version);
    refuse_empty_values(command);
  });
  try {
    std::vector<std::string> words(argv + 1, argv + argc);
    if (!words.empty() && words[0] == "complete") {
      return print_completions(app, std::span(words).subspan(1));
    }
    // Completions and manual pages break lines themselves.
    if (words.empty() || words[0] != "share") {
      wrap_help(app);
      for_each_command(app, wrap_help);
    }
    if (asks_for_help(words)) {
      words.erase(words.begin());
      words.emplace_back("--help");
    }
    std::ranges::reverse(words);  // the order for CLI11
    app.parse(words);
    if (app.get_subcommands().empty()) return window.desktop();
    const CLI::App& command = *app.get_subcommands().front();
    if (command.get_name() == "play") return window.play();
    check_order(app, command);
    return if_written(commands.at(command.get_name())());
  } catch (const CLI::Success& e) {
    return if_written(app.exit(e));  // --help, --version
  } catch (const CLI::ExtrasError&) {
    return refuse(unexpected(app));
  } catch (const CLI::ParseError& e) {
    return refuse(e);
  } catch (const UsageError& e) {
    // The value of an unknown option may be taken for a file, which does not exist.
    return app.remaining_size(true) > 0 ? refuse(unexpected(app)) : refuse(e);
  } catch (const ParameterError& e) {
    return refuse(e);
  } catch (const FileError& e) {
    return refuse(e);
  } catch (const std::exception& e) {
    fmt::print(stderr, "limpid: {}\n", e.what());
    return 1;
  }
}

}  // namespace limpid
