// Named texts that a user keeps in a file of tables: layouts of the window, presets of settings.
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
    bool shipped = false;  // comes with the program: can be used, not changed
  };

  // Reads both files: the program's, and the user's own, which may not exist. Unreadable entries
  // are left out, and complaint() says why.
  NamedTexts(const std::filesystem::path& shipped, std::filesystem::path own);

  const std::filesystem::path& file() const { return own_; }
  const std::string& complaint() const { return complaint_; }
  const std::vector<Entry>& all() const { return entries_; }  // shipped ones first
  const Entry* find(const std::string& name) const;           // null: there is none
  bool may_change(const std::string& name) const;             // or be given to a new one

  // Changes one text in the user's file, which another window may have changed, and reads all its
  // texts anew. Returns the reason of a failure, with nothing changed, or an empty text. An
  // unreadable file is kept beside it, with ".unread" behind its name.
  std::string keep(const std::string& name, const std::string& text);  // may replace one
  std::string rename(const std::string& from, const std::string& to);
  std::string remove(const std::string& name);

 private:
  struct Tables;  // the tables of one file
  static Tables tables_of(const std::string& text, const std::filesystem::path& file);
  void take(const Tables& tables, bool shipped);
  std::string change(const std::function<void(Tables&)>& what);

  std::filesystem::path own_;
  std::string complaint_;
  std::vector<Entry> entries_;
};

// Returns a layout as TOML: the plots and panels that the window shows under these settings.
std::string layout_text(const Settings& settings);
// Applies a layout's text; other settings stay. Errors: FileError naming `where`, key and what is
// allowed; nothing has changed then.
void apply_layout(Settings& settings, const std::string& text, const std::string& where);

// Returns a preset as TOML: the parameters of coupling, observer and ledger.
std::string preset_text(const Parameters& p);
// Applies a preset's text. Parameters of a preset that it does not name get the paper's value, all
// others stay. Errors: as apply_config_text().
void apply_preset(Parameters& p, const std::string& text, const std::string& where);

}  // namespace limpid
