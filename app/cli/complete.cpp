#include "app/cli/complete.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/device/device_hub.h"
#include "app/experiments/experiment.h"
#include "core/base/model_kinds.h"

namespace limpid {
namespace {

std::vector<HelpWord> known_device_words() {
  std::vector<HelpWord> words{
      {"simulated", "a simulated device whose values differ from its file"}};
  try {
    for (const FoundDevice& found : DeviceHub::look()) {
      words.push_back({found.place.id, found.place.name});
    }
  } catch (const std::exception&) {  // a shell wants no message
  }
  return words;
}

std::vector<HelpWord> experiment_words() {
  std::vector<HelpWord> words{{"all", "all experiments, one after the other"}};
  for (const Experiment& e : experiments()) words.push_back({e.name, e.about});
  return words;
}

// Adds values by an option's type: "FILE.csv|FILE.h5" names suffixes of files, "DIR" folders,
// others words.
void add_values(const std::string& name, Completions& into) {
  const auto add = [&into](const std::vector<HelpWord>& words) {
    into.words.insert(into.words.end(), words.begin(), words.end());
  };
  if (name == "KIND") {
    for (const auto& key : kLawKeys) into.words.push_back({std::string(key), ""});
  } else if (name.find("KEY=VALUE") != std::string::npos) {
    add(parameter_words());
  } else if (name == "NAME") {
    add(experiment_words());
  } else if (name == "DEVICE") {
    add(known_device_words());
  } else if (name == "OUT") {
    into.folders = true;
    into.suffixes = {".mp4", ".gif"};
  } else if (name == "DIR") {
    into.folders = true;
  }
  for (const std::string& part : CLI::detail::split(name, '|')) {
    if (part == "MODEL") {
      for (const ModelKind& each : kModelKinds) into.suffixes.emplace_back(each.suffix);
    }
    const auto dot = part.find('.');
    if (dot == std::string::npos || dot + 1 == part.size() || part[dot + 1] == '.') continue;
    if (std::isalpha(static_cast<unsigned char>(part[dot + 1])) == 0) continue;
    into.suffixes.push_back(part.substr(dot));
  }
  into.folders |= !into.suffixes.empty();
}

std::vector<std::string> names(const CLI::Option& option) {
  std::vector<std::string> all;
  for (const std::string& name : option.get_snames()) all.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) all.push_back("--" + name);
  return all;
}

const CLI::Option* option_called(const CLI::App& command, const std::string& name) {
  for (const CLI::Option* option : command.get_options()) {
    if (std::ranges::count(names(*option), name) > 0) return option;
  }
  return nullptr;
}

// Command, open option and number of positional words before the last word.
struct Position {
  const CLI::App* command;
  const CLI::Option* open = nullptr;  // wants a value
  std::size_t positionals = 0;
};

Position read(const CLI::App& app, std::span<const std::string> words) {
  Position at{&app};
  for (const std::string& word : words) {
    if (at.open != nullptr) {
      at.open = nullptr;
    } else if (word.starts_with("-")) {
      const CLI::Option* option = option_called(*at.command, word);
      if (option != nullptr && !value_name(*option).empty()) at.open = option;
    } else {
      const auto commands = shown_commands(*at.command);
      const auto called = [&](const CLI::App* one) { return one->get_name() == word; };
      const auto found = std::ranges::find_if(commands, called);
      if (at.positionals == 0 && found != commands.end()) {
        at.command = *found;
      } else {
        ++at.positionals;
      }
    }
  }
  return at;
}

void add_positional(const Position& at, Completions& into) {
  std::size_t left = at.positionals;
  for (const CLI::Option* option : at.command->get_options()) {
    if (!option->get_positional() || left-- > 0) continue;
    const std::string name = value_name(*option);
    if (name == "NAME" && at.command->get_name() != "experiment") return;  // chosen freely
    add_values(name, into);
    return;
  }
}

}  // namespace

std::string value_name(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return {};
  std::string name = option.get_type_name();
  name = name.substr(0, name.find(':'));  // without the description of a check
  const bool says_nothing = name.empty() || name == "TEXT";
  return option.get_positional() && says_nothing ? option.get_name(true) : name;
}

std::vector<const CLI::App*> shown_commands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* one) { return !one->get_group().empty(); });
}

Completions completions(const CLI::App& app, std::span<const std::string> words) {
  Completions all;
  if (words.empty()) return all;
  const std::string& last = words.back();
  const Position at = read(app, words.first(words.size() - 1));
  if (at.open != nullptr) {
    add_values(value_name(*at.open), all);
  } else if (const auto equals = last.find('=');
             last.starts_with("--") && equals != std::string::npos) {
    const CLI::Option* option = option_called(*at.command, last.substr(0, equals));
    if (option != nullptr) add_values(value_name(*option), all);
  } else if (last.starts_with("-")) {
    for (const CLI::Option* option : at.command->get_options()) {
      for (const std::string& name : names(*option)) {
        all.words.push_back({name, option->get_description()});
      }
    }
  } else {
    if (at.positionals == 0) {
      for (const CLI::App* command : shown_commands(*at.command)) {
        all.words.push_back({command->get_name(), command->get_description()});
      }
    }
    add_positional(at, all);
  }
  return all;
}

int print_completions(const CLI::App& app, std::span<const std::string> words) {
  const Completions all = completions(app, words);
  for (const HelpWord& word : all.words) fmt::print("{}\t{}\n", word.word, word.about);
  if (!all.suffixes.empty()) {
    fmt::print("\tfiles {}\n", fmt::join(all.suffixes, " "));
  } else if (all.folders) {
    fmt::print("\tfolders\n");
  }
  return 0;
}

}  // namespace limpid
