// The options that several commands share, and what they amount to.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "app/run/shipped_files.h"
#include "app/run/simulate.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace limpid {

// Wrong usage or bad input, refused before anything is written: exit status 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct InputOptions {
  std::string device, scene, hand;  // files; empty: the default
  std::string tip;                  // of the device's links; empty: as its file has it
  std::vector<std::string> configs;
  std::vector<std::string> settings;                // key=value
  std::optional<std::string> coupling, eta, alpha;  // short for three settings
  std::optional<double> duration;
  std::optional<std::uint64_t> seed;       // which hand a variation is
  std::optional<std::uint64_t> variation;  // of the hand; 0: as it is

  // Whether any of them is given that add_parameters() declares.
  bool set_parameters() const {
    return !configs.empty() || !settings.empty() || coupling || eta || alpha;
  }

  // Declares --config, --set, --coupling, --eta, --alpha.
  void add_parameters(CLI::App& command);
  // Declares --device, --tip and --scene.
  void add_world(CLI::App& command);
  // Declares --hand, --duration, --variation, --seed.
  void add_hand(CLI::App& command);
};

// What is given in two places: single ones as the second says, if it does; lists one after the
// other.
InputOptions both(const InputOptions& first, InputOptions second);

// Reads every file and checks every value. Errors: UsageError, FileError, ParameterError.
// A session given as the hand brings its own device, scene and parameters; options override them.
RunPlan make_plan(const InputOptions& options);
// Parameters alone, over `base`.
Parameters make_parameters(const InputOptions& options, Parameters base = {});
// The same over those that suit the arm.
Parameters make_parameters(const InputOptions& options, const ArmDescription& arm);
// The id of the real device that is named where an arm's file could be; empty: none is. Errors:
// UsageError.
std::string device_named(const std::string& words);
// The arm alone; of a real device that is named, the built-in one that is like it.
ArmDescription arm_of(const InputOptions& options);
// Device and scene alone, without the models of its meshes; by default a scene that the device can
// reach.
void read_world(const InputOptions& options, ArmDescription& arm, SceneDocument& document);

// That a command does not write over what it reads. `option`: that names the output, "--record".
// Errors: UsageError.
void keep_apart(const char* option, const std::filesystem::path& out,
                std::span<const std::string> read);
// The same of all that these options name.
void keep_apart(const char* option, const std::filesystem::path& out, const InputOptions& input);

// A transform of options: a file that is not there, and came along with the program under this name
// in a folder of assets, is that one. A file that is nowhere, and nearly has the name of one of
// these, is refused with that name. Errors: UsageError.
std::function<std::string(std::string)> or_shipped(Kinds kinds);

// For the help text: every key with its default and what is allowed.
std::string parameter_help();
// Breaks the texts of all options into lines that fit into a terminal.
void wrap_help(CLI::App& command);
// A word of the command line and what it is.
struct HelpWord {
  std::string word, about;
};
// Every KEY=VALUE where the values are words, else KEY= and what is allowed.
std::vector<HelpWord> parameter_words();

// The option takes a whole number from 0 on.
void require_whole_number(CLI::Option* option);
// The option takes a number above 0.
void require_above_zero(CLI::Option* option, double most, const std::string& unit);
// No option of the command takes an empty word for a value.
void refuse_empty_values(CLI::App& command);

}  // namespace limpid
