#include "app/sweep/open_table.h"

#include <fmt/format.h>

#include <cmath>

#include "app/sweep/blocks.h"
#include "devices/files/file_error.h"
#include "devices/files/session/session_program.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

// Empty where it says nothing.
std::string text_in(const wire::Table& table, const std::string& name) {
  const auto found = table.texts.find(name);
  return found == table.texts.end() ? "" : found->second;
}

bool says_it_is(const fs::path& path) {
  try {
    return text_in(read_table(path), "format") == kSweepFormat;
  } catch (const FileError&) {
    return false;
  }
}

class TableFile {
 public:
  explicit TableFile(const fs::path& path) : path_(path), table_(read_table(path)) {
    const std::string format = text_if_any("format");
    if (format != kSweepFormat) {
      throw FileError(fmt::format("{}: format \"{:.40}\"; needed: \"{}\"", path_.string(), format,
                                  kSweepFormat));
    }
    const auto version = count("version");
    if (version != kSweepVersion) {
      throw FileError(fmt::format("{}: version {}; this program reads {}", path_.string(), version,
                                  kSweepVersion));
    }
  }

  std::string text_if_any(const std::string& name) const { return text_in(table_, name); }
  std::uint64_t count(const std::string& name) const {
    const auto found = table_.counts.find(name);
    if (found != table_.counts.end()) return found->second;
    throw FileError(
        fmt::format("{}: attribute {}: missing; needed: a whole number", path_.string(), name));
  }
  const std::vector<double>& column(const std::string& name, std::uint64_t rows) const {
    const auto found = table_.columns.find(name);
    if (found == table_.columns.end()) {
      throw FileError(fmt::format("{}: damaged: {}: missing", path_.string(), name));
    }
    if (found->second.size() != rows) {
      throw FileError(fmt::format("{}: damaged: {}: {} values; needed: {}, as it says",
                                  path_.string(), name, found->second.size(), rows));
    }
    return found->second;
  }

  [[noreturn]] void refuse_rows(std::uint64_t found, std::uint64_t needed) const {
    throw FileError(fmt::format("{}: damaged: {} points; needed: {}, as its plan has",
                                path_.string(), found, needed));
  }

 private:
  const fs::path& path_;
  wire::Table table_;
};

// With what its runs need, or why that cannot be had.
std::shared_ptr<const SweepPlan> plan_in(const TableFile& file, const fs::path& path,
                                         std::string& why_no_run) {
  const std::string text = file.text_if_any("plan");
  if (text.empty()) {
    throw FileError(
        fmt::format("{}: holds no plan, so that nobody knows what its points are", path.string()));
  }
  auto plan = std::make_shared<SweepPlan>(plan_of_text(text, plan_behind(path.parent_path())));
  try {
    read_worlds(*plan);
  } catch (const std::exception& e) {
    plan->worlds.clear();
    why_no_run = fmt::format("files that the plan names are not there: {}", e.what());
    return plan;
  }
  const std::string key = file.text_if_any("key");
  if (!key.empty() && key != hex(plan->key)) {
    why_no_run = fmt::format(
        "files that the plan names have changed since: they are looked for beside {} and among "
        "the program's own",
        plan->file.string());
  }
  return plan;
}

// Round by round, as it came about.
void fill(const TableFile& file, SweepTable& table) {
  const std::uint64_t rows = file.count("points");
  const std::vector<double>& done = file.column("/done", rows);
  std::vector<const std::vector<double>*> columns;
  for (const SweepColumn& c : table.columns) {
    columns.push_back(&file.column("/measure/" + c.name, rows));
  }
  std::uint64_t from = 0;
  do {
    for (std::uint64_t i = from; i < std::min(rows, table.points()); ++i) {
      table.done[i] = done[i] != 0;
      for (std::size_t c = 0; c < columns.size(); ++c) {
        table.values[i * columns.size() + c] = (*columns[c])[i];
      }
    }
    from = table.points();
  } while (from < rows && table.grow());
  if (table.points() != rows) file.refuse_rows(rows, table.points());
  if (table.count() == rows) table.grow();  // where this is all, it knows now
}

std::pair<double, double> range_of(const SweepTable& table, std::size_t column) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (std::uint64_t i = 0; i < table.points(); ++i) {
    const double value = table.at(i, column);
    if (!table.done[i] || !std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  return low <= high ? std::pair{low, high} : std::pair{0.0, 1.0};
}

}  // namespace

std::optional<fs::path> sweep_table_at(const fs::path& path) {
  std::error_code none;
  if (fs::is_directory(path, none)) {
    const fs::path table = path / "table.h5";
    return fs::is_regular_file(table, none) ? std::optional(table) : std::nullopt;
  }
  return fs::is_regular_file(path, none) && says_it_is(path) ? std::optional(path) : std::nullopt;
}

std::shared_ptr<const OpenedSweep> open_table(const fs::path& path, const OpenedSweep* before) {
  const TableFile file(path);
  std::string why_no_run;
  std::shared_ptr<const SweepPlan> plan;
  if (before != nullptr && before->plan->text == file.text_if_any("plan") &&
      hex(before->plan->key) == file.text_if_any("key")) {
    plan = before->plan;
    why_no_run = before->why_no_run;
  } else {
    plan = plan_in(file, path, why_no_run);
  }
  auto opened = std::make_shared<OpenedSweep>(OpenedSweep{
      path, plan, SweepTable(*plan), file.text_if_any("build"), std::move(why_no_run), {}});
  fill(file, opened->table);
  for (std::size_t c = 0; c < opened->table.columns.size(); ++c) {
    opened->ranges.push_back(range_of(opened->table, c));
  }
  return opened;
}

}  // namespace limpid
