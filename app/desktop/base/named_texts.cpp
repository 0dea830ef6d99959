#include "app/desktop/base/named_texts.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <sstream>

#include "devices/files/atomic_file.h"
#include "devices/files/file_error.h"
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

std::vector<NamedTexts::Entry> read(const fs::path& file, bool shipped) {
  std::vector<NamedTexts::Entry> entries;
  const toml::table whole = parse_toml(read_text(file, kLongest), file.string());
  for (const auto& [name, node] : whole) {
    if (!node.is_table()) {
      throw FileError(fmt::format("{}:{}: {}: {} is not allowed; allowed: a table, [\"a name\"]",
                                  file.string(), name.source().begin.line, name.str(),
                                  found_text(node)));
    }
    entries.push_back({std::string(name.str()), text_of(*node.as_table()), shipped});
  }
  return entries;
}

}  // namespace

NamedTexts::NamedTexts(const fs::path& shipped, fs::path own) : own_(std::move(own)) {
  const auto take = [this](const fs::path& file, bool from_program) {
    for (NamedTexts::Entry& entry : read(file, from_program)) {
      if (find(entry.name) == nullptr) entries_.push_back(std::move(entry));
    }
  };
  try {
    take(shipped, true);
  } catch (const std::exception& e) {
    complaint_ = e.what();
  }
  std::error_code none;
  if (!fs::exists(own_, none)) return;
  try {
    take(own_, false);
  } catch (const std::exception& e) {
    complaint_ = e.what();
    unread_ = true;
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
  std::vector<Entry> entries = entries_;
  const auto found = std::ranges::find(entries, name, &Entry::name);
  if (found == entries.end()) {
    entries.push_back({name, text});
  } else {
    found->text = text;
  }
  return replace(std::move(entries));
}

std::string NamedTexts::rename(const std::string& from, const std::string& to) {
  std::vector<Entry> entries = entries_;
  const auto found = std::ranges::find(entries, from, &Entry::name);
  if (found == entries.end() || from == to) return {};
  found->name = to;
  return replace(std::move(entries));
}

std::string NamedTexts::remove(const std::string& name) {
  std::vector<Entry> entries = entries_;
  std::erase_if(entries, [&](const Entry& entry) { return entry.name == name; });
  return replace(std::move(entries));
}

std::string NamedTexts::replace(std::vector<Entry> entries) {
  toml::table whole;
  for (const Entry& entry : entries) {
    if (!entry.shipped) whole.insert(entry.name, toml::parse(entry.text));
  }
  std::error_code error;
  if (unread_) fs::rename(own_, own_.string() + ".unread", error);
  if (error) return fmt::format("{}: {}", own_.string(), error.message());
  unread_ = false;
  std::ostringstream text;
  text << whole << '\n';
  std::string wrong = try_write_atomically(own_, text.str());
  if (wrong.empty()) entries_ = std::move(entries);
  return wrong;
}

}  // namespace limpid
