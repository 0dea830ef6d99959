// What may come next on an unfinished command line, for the completions of the shells.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/cli/options.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace limpid {

struct Completions {
  std::vector<HelpWord> words;        // whether they begin as the last word does or not
  bool folders = false;               // files belong there; these need folders as a way to them
  std::vector<std::string> suffixes;  // of files that do
};

// `words`: the line without the program, the last one unfinished, or empty. After "--option=" it is
// the value that is completed.
Completions completions(const CLI::App& app, std::span<const std::string> words);

// The value of an option as help and manual call it, such as "FILE.toml". Empty: it takes none.
std::string value_name(const CLI::Option& option);
// The commands that people are told of.
std::vector<const CLI::App*> shown_commands(const CLI::App& app);

// `limpid complete WORDS...`, which assets/completions call: WORD, tab, what it is; a line; and
// where files belong a line of a tab, "folders" or "files", and their suffixes.
int print_completions(const CLI::App& app, std::span<const std::string> words);

}  // namespace limpid
