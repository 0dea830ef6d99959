// Chooses a command and says what went wrong.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>

#include "app/cli/commands.h"
#include "app/cli/options.h"

using namespace limpid;

namespace {

// Bad usage or input, found before anything was written.
int refuse(const std::exception& e) {
  fmt::print(stderr, "limpid: {}\n", e.what());
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Limpid: touch a virtual world and see how transparent the coupling is."};
  app.name("limpid");
  app.set_version_flag("--version", "limpid " LIMPID_VERSION);
  app.require_subcommand(0, 1);
  std::map<std::string, Command> commands;
  commands["run"] = declare_run(app);
  commands["analyze"] = declare_analyze(app);
  commands["info"] = declare_info(app);
  commands["recover"] = declare_recover(app);
  commands["devices"] = declare_devices(app);
  commands["play"] = declare_play(app);
  const Command desktop = declare_desktop(app);
  for (CLI::App* command : app.get_subcommands({})) {
    command->set_version_flag("--version", "limpid " LIMPID_VERSION);
  }
  try {
    app.parse(argc, argv);
    const auto chosen = app.get_subcommands();
    return chosen.empty() ? desktop() : commands.at(chosen.front()->get_name())();
  } catch (const CLI::Success& e) {
    return app.exit(e);  // --help, --version
  } catch (const CLI::ParseError& e) {
    return refuse(e);
  } catch (const UsageError& e) {
    return refuse(e);
  } catch (const ParameterError& e) {
    return refuse(e);
  } catch (const FileError& e) {
    return refuse(e);
  } catch (const std::exception& e) {
    fmt::print(stderr, "limpid: {}\n", e.what());
    return 1;
  }
}
