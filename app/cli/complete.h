// Completions of an unfinished command line, for the shells.
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
  std::vector<HelpWord> words;        // also words that do not begin like the last one
  bool folders = false;               // files are allowed, and so folders on the way to them
  std::vector<std::string> suffixes;  // of files allowed
};

// `words`: the line without the program; the last word is unfinished or empty. After "--option=" it
// is that option's value.
Completions completions(const CLI::App& app, std::span<const std::string> words);

// Name of an option's value in help and manual, such as "FILE.toml"; empty if it takes none.
std::string value_name(const CLI::Option& option);
// The commands that help and manual list.
std::vector<const CLI::App*> shown_commands(const CLI::App& app);

// `limpid complete WORDS...`, called by assets/completions. Prints a line WORD, tab, meaning, for
// each word. Where files are allowed it adds a line: tab, "folders" or "files", and their suffixes.
int print_completions(const CLI::App& app, std::span<const std::string> words);

}  // namespace limpid
