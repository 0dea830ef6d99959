#include "app/desktop/base/named_texts.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <sstream>

#include "devices/files/atomic_file.h"
#include "devices/files/text_file.h"
#include "devices/files/toml_reader.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kLongest = 1 << 20;  // of a file [bytes]

std::string text_of(const toml::table& table) {
  std::ostringstream text;
  text << toml::toml_formatter(table);
  return text.str();
}

}  // namespace

struct NamedTexts::Tables {
  toml::table all;
};

NamedTexts::Tables NamedTexts::tables_of(const std::string& text, const fs::path& file) {
  Tables tables{parse_toml(text, file.string())};
  for (const auto& [name, node] : tables.all) {
    if (node.is_table()) continue;
    throw FileError(fmt::format("{}:{}: {}: {} is not allowed; allowed: a table, [\"a name\"]",
                                file.string(), name.source().begin.line, name.str(),
                                found_text(node)));
  }
  return tables;
}

NamedTexts::NamedTexts(const fs::path& shipped, fs::path own) : own_(std::move(own)) {
  const auto read = [this](const fs::path& file, bool from_program) {
    try {
      take(tables_of(read_text(file, kLongest), file), from_program);
    } catch (const std::exception& e) {
      complaint_ = e.what();
    }
  };
  read(shipped, true);
  std::error_code none;
  if (fs::exists(own_, none)) read(own_, false);
}

// Those that come along hide the user's own of the same name, which stay in their file.
void NamedTexts::take(const Tables& tables, bool shipped) {
  std::erase_if(entries_, [&](const Entry& entry) { return entry.shipped == shipped; });
  for (const auto& [name, node] : tables.all) {
    const std::string text(name.str());
    if (find(text) == nullptr) entries_.push_back({text, text_of(*node.as_table()), shipped});
  }
}

const NamedTexts::Entry* NamedTexts::find(const std::string& name) const {
  const auto found = std::ranges::find(entries_, name, &Entry::name);
  return found == entries_.end() ? nullptr : &*found;
}

bool NamedTexts::may_change(const std::string& name) const {
  const Entry* entry = find(name);
  return !name.empty() && (entry == nullptr || !entry->shipped);
}

std::string NamedTexts::keep(const std::string& name, const std::string& text) {
  return change([&](Tables& own) { own.all.insert_or_assign(name, toml::parse(text)); });
}

std::string NamedTexts::rename(const std::string& from, const std::string& to) {
  if (from == to) return {};
  return change([&](Tables& own) {
    const toml::table* renamed = own.all[from].as_table();
    if (renamed == nullptr) {
      throw FileError(fmt::format("{} is not there any more: another window changed it.", from));
    }
    if (own.all.contains(to)) throw FileError(fmt::format("There is one called {} already.", to));
    own.all.insert(to, *renamed);
    own.all.erase(from);
  });
}

std::string NamedTexts::remove(const std::string& name) {
  return change([&](Tables& own) { own.all.erase(name); });
}

// Of the file as it is now: another window may have changed it.
std::string NamedTexts::change(const std::function<void(Tables&)>& what) {
  try {
    Tables own;
    update_file_under_lock(own_, [&](const std::string& text) {
      try {
        own = tables_of(text, own_);
      } catch (const FileError&) {
        keep_unread(own_);
      }
      what(own);
      std::ostringstream out;
      out << own.all << '\n';
      return out.str();
    });
    take(own, false);
    return {};
  } catch (const std::exception& e) {
    return e.what();
  }
}

}  // namespace limpid
