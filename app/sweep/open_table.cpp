#include "app/sweep/open_table.h"

#include <fmt/format.h>

#include <cmath>

#include "app/sweep/blocks.h"
#include "devices/files/file_error.h"
#include "devices/files/session/hdf5_reading.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using hdf5::Quiet;

bool says_it_is(const fs::path& path) {
  const Quiet quiet;
  const hdf5::File file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
  // Recordings may be large, and are told from tables without looking through all of them.
  if (!file || H5Lexists(file.get(), "measure", H5P_DEFAULT) <= 0) return false;
  try {
    hdf5::check_before_opening(path);
    return hdf5::read_text(file.get(), "format", path) == kSweepFormat;
  } catch (const FileError&) {
    return false;
  }
}

class TableFile {
 public:
  explicit TableFile(const fs::path& path) : path_(path), file_(opened(path)), claims_(path) {
    const std::string format = text("format");
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

  std::string text(const char* name) const { return hdf5::read_text(file_.get(), name, path_); }
  // Empty where it says nothing.
  std::string text_if_any(const char* name) const {
    return H5Aexists(file_.get(), name) > 0 ? text(name) : "";
  }

  template <class Value>
  std::vector<Value> column(const std::string& name, hid_t type, std::uint64_t rows) {
    if (!hdf5::has(file_.get(), name, path_)) {
      throw FileError(fmt::format("{}: damaged: {}: missing", path_.string(), name));
    }
    const hdf5::Dataset dataset = hdf5::open_dataset(file_.get(), name, path_);
    const hdf5::Dataspace space(H5Dget_space(dataset.get()));
    const auto found = H5Sget_simple_extent_npoints(space.get());
    if (found != static_cast<hssize_t>(rows)) {
      throw FileError(fmt::format("{}: damaged: {}: {} values; needed: {}, as it says",
                                  path_.string(), name, found, rows));
    }
    claims_.stored(dataset);
    claims_.take(rows, sizeof(Value), name);
    std::vector<Value> values(rows);
    const bool read =
        H5Dread(dataset.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
    hdf5::check(read, path_, ("damaged: " + name).c_str());
    return values;
  }

  std::uint64_t count(const char* name) const { return hdf5::read_count(file_.get(), name, path_); }
  [[noreturn]] void refuse_rows(std::uint64_t found, std::uint64_t needed) const {
    throw FileError(fmt::format("{}: damaged: {} points; needed: {}, as its plan has",
                                path_.string(), found, needed));
  }

 private:
  static hdf5::File opened(const fs::path& path) {
    try {
      return hdf5::open_to_read(path);
    } catch (const FileError& error) {
      throw FileError(fmt::format("{} (damaged, or no table of a sweep)", error.what()));
    }
  }

  const fs::path& path_;
  hdf5::File file_;
  hdf5::Claims claims_;
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
void fill(TableFile& file, SweepTable& table) {
  const std::uint64_t rows = file.count("points");
  const auto done = file.column<std::uint8_t>("/done", H5T_NATIVE_UINT8, rows);
  std::vector<std::vector<double>> columns;
  for (const SweepColumn& c : table.columns) {
    columns.push_back(file.column<double>("/measure/" + c.name, H5T_NATIVE_DOUBLE, rows));
  }
  std::uint64_t from = 0;
  do {
    for (std::uint64_t i = from; i < std::min(rows, table.points()); ++i) {
      table.done[i] = done[i];
      for (std::size_t c = 0; c < columns.size(); ++c) {
        table.values[i * columns.size() + c] = columns[c][i];
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
  const Quiet quiet;
  TableFile file(path);
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
