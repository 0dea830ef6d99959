// What a user keeps by name, in a file of tables: layouts of the window, presets of settings.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "app/desktop/base/settings.h"

namespace limpid {

class NamedTexts {
 public:
  struct Entry {
    std::string name;
    std::string text;      // TOML
    bool shipped = false;  // comes along with the program: to be used, not changed
  };

  // Reads both files: one that comes along, and the user's own, which may not be there yet. What
  // cannot be read is left out, and complaint() says why.
  NamedTexts(const std::filesystem::path& shipped, std::filesystem::path own);

  const std::filesystem::path& file() const { return own_; }
  const std::string& complaint() const { return complaint_; }
  const std::vector<Entry>& all() const { return entries_; }  // those that come along first
  const Entry* find(const std::string& name) const;           // null: there is none
  bool may_change(const std::string& name) const;             // or have anew

  // Each changes this one only, in the file as it is by then, which another window may have
  // changed, and takes over what that left. Returns what went wrong, empty if nothing did; nothing
  // has changed then. A file that could not be read is kept beside it, with ".unread" behind its
  // name.
  std::string keep(const std::string& name, const std::string& text);  // also in place of another
  std::string rename(const std::string& from, const std::string& to);
  std::string remove(const std::string& name);

 private:
  struct Tables;  // of a file
  static Tables tables_of(const std::string& text, const std::filesystem::path& file);
  void take(const Tables& tables, bool shipped);
  std::string change(const std::function<void(Tables&)>& what);

  std::filesystem::path own_;
  std::string complaint_;
  std::vector<Entry> entries_;
};

// Which plots and panels the window shows, as text: for layouts that have a name.

// TOML of the layout that these settings have.
std::string layout_text(const Settings& settings);
// The layout of a text; other settings stay. Errors: FileError naming `where`, key and what is
// allowed; nothing has changed then.
void apply_layout(Settings& settings, const std::string& text, const std::string& where);

// The settings that a preset has: those of coupling, observer and ledger.
std::string preset_text(const Parameters& p);
// The preset of a text; what it does not name of these settings gets the paper's value, all others
// stay. Errors: as apply_config_text().
void apply_preset(Parameters& p, const std::string& text, const std::string& where);

}  // namespace limpid
