#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "app/base/folders.h"
#include "app/base/open_elsewhere.h"
#include "app/base/version.h"
#include "app/cli/commands.h"
#include "app/cli/complete.h"
#include "app/style/icon.h"
#include "devices/files/text_file.h"
#include "render/gl/offscreen.h"

namespace limpid {

namespace {

namespace fs = std::filesystem;

// `text` for roff: '-' stays a minus that can be copied, and no line is a request.
std::string roff(const std::string& text) {
  std::string out;
  bool at_start = true;
  for (const char c : text) {
    if (at_start && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
    at_start = c == '\n';
  }
  return out;
}

std::string upper(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

// "limpid-devices-look", with these characters between the words.
std::string full_name(const CLI::App& command, const char* between) {
  const CLI::App* above = command.get_parent();
  return (above == nullptr ? "" : full_name(*above, between) + between) + command.get_name();
}

// Keeps tables and lines broken by hand.
std::string as_it_stands(const std::string& text) {
  return fmt::format(".nf\n{}\n.fi\n", roff(text));
}

std::string synopsis(const CLI::App& command) {
  std::string text = fmt::format("\\fB{}\\fR [\\fIOPTION\\fR]...", roff(full_name(command, " ")));
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_positional()) continue;
    const std::string name = fmt::format("\\fI{}\\fR", roff(option->get_name(true)));
    text += option->get_required() ? " " + name : " [" + name + "]";
  }
  return text + "\n";
}

std::string bonds(const CLI::Option& option) {
  std::vector<std::string> with, without;
  for (const CLI::Option* other : option.get_needs()) with.push_back(other->get_name());
  for (const CLI::Option* other : option.get_excludes()) without.push_back(other->get_name());
  std::ranges::sort(without);  // they come ordered by addresses
  std::string text;
  if (!with.empty()) text += fmt::format(" Only with {}.", fmt::join(with, ", "));
  if (!without.empty()) text += fmt::format(" Not with {}.", fmt::join(without, ", "));
  return text;
}

std::string option_entry(const CLI::Option& option) {
  std::vector<std::string> names;
  if (option.get_positional()) {
    names.push_back(fmt::format("\\fI{}\\fR", roff(option.get_name(true))));
  }
  for (const std::string& name : option.get_snames()) names.push_back("\\fB\\-" + name + "\\fR");
  for (const std::string& name : option.get_lnames()) {
    names.push_back("\\fB\\-\\-" + roff(name) + "\\fR");
  }
  std::string head = fmt::format("{}", fmt::join(names, ", "));
  const std::string value = value_name(option);
  if (!value.empty() && !option.get_positional()) head += fmt::format(" \\fI{}\\fR", roff(value));
  return fmt::format(".TP\n{}\n{}\n", head, roff(option.get_description() + bonds(option)));
}

std::string options(const CLI::App& command) {
  std::string text;
  for (const bool positional : {true, false}) {
    for (const CLI::Option* option : command.get_options()) {
      if (option->get_positional() == positional) text += option_entry(*option);
    }
  }
  return text;
}

std::string commands(const CLI::App& app) {
  std::string text = ".SH COMMANDS\n";
  for (const CLI::App* one : shown_commands(app)) {
    text += fmt::format(".TP\n\\fB{}\\fR\n{}; see \\fB{}\\fR(1)\n", full_name(*one, " "),
                        roff(one->get_description()), roff(full_name(*one, "-")));
  }
  return text;
}

constexpr const char* kFiles = R"(.SH FILES
.TP
\fI~/.config/limpid\fR
devices, layouts and presets; below \fBXDG_CONFIG_HOME\fR if this variable is set
.TP
\fI~/.local/share/limpid\fR
sessions; below \fBXDG_DATA_HOME\fR if this variable is set
.TP
\fI~/.cache/limpid\fR
small pictures of sessions; below \fBXDG_CACHE_HOME\fR if this variable is set
.TP
\fI$XDG_RUNTIME_DIR/limpid/NAME.control\fR
socket of \fBlimpid \-\-listen NAME\fR and \fBlimpid serve NAME\fR, for programs of the same user
)";

std::string see_also(const CLI::App& command) {
  std::vector<std::string> pages;
  const auto add = [&](const CLI::App& other) {
    pages.push_back(fmt::format("\\fB{}\\fR(1)", roff(full_name(other, "-"))));
  };
  if (command.get_parent() != nullptr) add(*command.get_parent());
  for (const CLI::App* one : shown_commands(command)) add(*one);
  return fmt::format(".SH SEE ALSO\n{}\n", fmt::join(pages, ",\n"));
}

std::string manual_page(const CLI::App& command) {
  const bool whole = command.get_parent() == nullptr;
  std::string about = command.get_description();
  if (whole) about = about.substr(about.find(": ") + 2);  // the name stands before
  std::string text = fmt::format(".TH {} 1 \"\" \"Limpid {}\" \"Limpid\"\n",
                                 roff(upper(full_name(command, "-"))), roff(program_version()));
  text += fmt::format(".SH NAME\n{} \\- {}\n", roff(full_name(command, "-")), roff(about));
  text += ".SH SYNOPSIS\n" + synopsis(command);
  if (!shown_commands(command).empty()) {
    text += fmt::format(".br\n\\fB{}\\fR \\fICOMMAND\\fR [\\fIOPTION\\fR]...\n{}",
                        roff(full_name(command, " ")), commands(command));
  }
  text += ".SH OPTIONS\n" + options(command);
  if (!command.get_footer().empty()) text += ".SH NOTES\n" + as_it_stands(command.get_footer());
  if (whole) text += kFiles;
  return text + see_also(command);
}

void write(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream out(file, std::ios::binary);
  out << text;
  if (!out.flush()) throw FileError(file.string() + ": could not be written");
}

// Writes the pages of a command and of those below it.
void write_pages(const CLI::App& command, const fs::path& folder) {
  write(folder / (full_name(command, "-") + ".1"), manual_page(command));
  for (const CLI::App* one : shown_commands(command)) write_pages(*one, folder);
}

void write_icons(const fs::path& folder) {
  write(folder / "scalable/apps/limpid.svg", icon_svg());
  for (const int size : {16, 22, 24, 32, 48, 64, 128, 256, 512}) {
    const fs::path apps = folder / fmt::format("{0}x{0}/apps", size);
    fs::create_directories(apps);
    write_png(apps / "limpid.png", size, size, icon(size));
  }
}

}  // namespace

Command declare_share(CLI::App& app, std::vector<ManualKey> keys) {
  auto* command = app.add_subcommand("share", "writes the manual and icons for an installation");
  command->group("");
  auto into = std::make_shared<std::string>();
  command->add_option("DIR", *into, "the folder for manual and icons")->required();
  return [into, &app, keys = std::move(keys)] {
    write_pages(app, fs::path(*into) / "man/man1");
    write_icons(fs::path(*into) / "icons/hicolor");
    write(fs::path(*into) / "manual.html", manual_html(data_dir(), keys));
    return 0;
  };
}

Command declare_manual(CLI::App& app) {
  auto* command = app.add_subcommand("manual", "opens the manual in the browser");
  auto path = std::make_shared<bool>(false);
  command->add_flag("--path", *path, "only print where the manual is");
  return [path] {
    const fs::path file = manual_file();
    if (file.empty()) {
      fmt::print(stderr, "limpid: the manual is not there; install Limpid again\n");
      return 1;
    }
    if (*path || !open_elsewhere(file)) fmt::print("{}\n", file.string());
    return 0;
  };
}

}  // namespace limpid
