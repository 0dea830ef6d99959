// Options shared by several commands, and the plan, arm and parameters that they give.
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
  std::string tip;                  // link of the device that the hand holds; empty: the file's
  std::vector<std::string> configs;
  std::vector<std::string> settings;                // key=value
  std::optional<std::string> coupling, eta, alpha;  // short for three settings
  std::optional<double> duration;
  std::optional<std::uint64_t> seed;       // seed of the variations
  std::optional<std::uint64_t> variation;  // number of the hand's variation; 0: unchanged
  bool readings = false;                   // of a virtual arm are as its file says

  // Whether an option of add_parameters() is given.
  bool set_parameters() const {
    return !configs.empty() || !settings.empty() || coupling || eta || alpha;
  }

  // Declares --config, --set, --coupling, --eta, --alpha.
  void add_parameters(CLI::App& command);
  // Declares --device and --tip.
  void add_arm(CLI::App& command);
  // Declares --device, --tip and --scene.
  void add_world(CLI::App& command);
  // Declares --readings.
  void add_readings(CLI::App& command);
  // Declares --hand, --duration, --variation, --seed.
  void add_hand(CLI::App& command);
};

// Merges two sets of options: `second` wins for single values, lists are appended.
InputOptions both(const InputOptions& first, InputOptions second);

// Reads every file and checks every value. A session given as the hand brings its own device, scene
// and parameters; options override them. Errors: UsageError, FileError, ParameterError.
RunPlan make_plan(const InputOptions& options);
// Applies the options to `base`.
Parameters make_parameters(const InputOptions& options, Parameters base = {});
// Applies the options to the parameters that suit `arm`.
Parameters make_parameters(const InputOptions& options, const ArmDescription& arm);
// Id of the real device that `words` name in place of an arm's file; empty: none. Errors:
// UsageError.
std::string device_named(const std::string& words);
// The arm of the options; for a named real device the built-in arm like it.
ArmDescription arm_of(const InputOptions& options);
// Refuses --readings for an arm whose file has none. Errors: UsageError.
void require_readings(const InputOptions& options, const ArmDescription& arm);
// Reads device and scene, without the models of its meshes; the default scene is one in the
// device's reach.
void read_world(const InputOptions& options, ArmDescription& arm, SceneDocument& document);

// Refuses to write over a file that is read. `option`: option of the output, "--record". Errors:
// UsageError.
void keep_apart(const char* option, const std::filesystem::path& out,
                std::span<const std::string> read);
// Refuses to write over any file that these options name.
void keep_apart(const char* option, const std::filesystem::path& out, const InputOptions& input);
// Refuses two outputs in one file. Errors: UsageError.
void keep_outputs_apart(const char* one, const std::filesystem::path& out, const char* two,
                        const std::filesystem::path& other);

// Transform of an option's value: a file that does not exist, but came with the program under this
// name, is replaced by that one. A similar name is refused with the right one. Errors: UsageError.
std::function<std::string(std::string)> or_shipped(Kinds kinds);

// Returns the allowed values of a parameter, for people.
std::string allowed_values(const FieldInfo& info);
// Help on parameters: every key with its default and allowed values.
std::string parameter_help();
// Breaks the texts of all options into lines that fit into a terminal.
void wrap_help(CLI::App& command);
// A word of the command line and what it is.
struct HelpWord {
  std::string word, about;
};
// KEY=VALUE for every value that is a word; KEY= with the allowed values for other keys.
std::vector<HelpWord> parameter_words();

// Lets the option take only whole numbers from 0 on.
void require_whole_number(CLI::Option* option);
// Lets the option take only numbers above 0.
void require_above_zero(CLI::Option* option, double most, const std::string& unit);
// Refuses empty values for all options of the command.
void refuse_empty_values(CLI::App& command);

}  // namespace limpid
