#include "app/sweep/sweep_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "app/base/version.h"
#include "app/run/run_key.h"
#include "app/sweep/sweep_work.h"
#include "devices/files/atomic_file.h"
#include "devices/files/session/session_program.h"
#include "devices/files/text_file.h"

namespace limpid {

using hdf5::check;

namespace {

namespace fs = std::filesystem;

// Attribute of tables whose measures have metres and newtons where arms slide; earlier ones have
// rad and N m of all arms.
constexpr const char* kOwnUnits = "units of the arm";

constexpr std::size_t kGrowth = 1 << 18;  // [bytes]
constexpr hsize_t kChunk = 1 << 14;       // values

// Column of an axis: its value for each point.
std::vector<double> column_of(const SweepPlan& plan, std::size_t axis) {
  std::vector<double> values(plan.points());
  for (std::uint64_t i = 0; i < values.size(); ++i) {
    values[i] = point_of(plan, i).values[axis];
  }
  return values;
}

void add_axis(const SweepPlan& plan, std::size_t a, FileImage& image) {
  const SweepAxis& axis = plan.axes[a];
  const std::vector<double> values = column_of(plan, a);
  const hdf5::Dataset dataset = image.add("/axis/" + axis.name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE,
                                          values.size(), 1, values.data());
  image.text(dataset.get(), "unit", axis.unit);
  image.text(dataset.get(), "key", axis.key);
  image.text(dataset.get(), "spread", kSpreads[static_cast<std::size_t>(axis.spread)]);
  image.text(dataset.get(), "scale", axis.logarithmic ? "log" : "linear");
  if (!axis.words.empty()) {
    image.text(dataset.get(), "words", fmt::format("{}", fmt::join(axis.words, "\n")));
  }
}

// Writes enough digits to read the same number again.
std::string csv_number(double x) { return std::isnan(x) ? "" : fmt::format("{}", x); }

std::string csv_word(const std::string& word) {
  if (word.find_first_of(",\"\n") == std::string::npos) return word;
  std::string quoted = "\"";
  for (const char c : word) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string csv_header(const std::string& name, const std::string& unit) {
  return csv_word(unit == "-" ? name : fmt::format("{} [{}]", name, unit));
}

// Text of an attribute; empty if there is none.
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
      throw FileError(
          fmt::format("{}: damaged: {}: {} values; needed: {}, the number that the file gives",
                      path_.string(), name, found->second.size(), rows));
    }
    return found->second;
  }

  [[noreturn]] void refuse_rows(std::uint64_t found, std::uint64_t needed) const {
    throw FileError(fmt::format("{}: damaged: it has {} points; its sweep plan has {}",
                                path_.string(), found, needed));
  }

 private:
  const fs::path& path_;
  wire::Table table_;
};

// The plan of a table, with its runs' worlds, or `why_no_run`.
std::shared_ptr<const SweepPlan> plan_in(const TableFile& file, const fs::path& path,
                                         std::string& why_no_run) {
  const std::string text = file.text_if_any("plan");
  if (text.empty()) {
    throw FileError(
        fmt::format("{}: the table contains no plan, so the meaning of its points is not known; "
                    "needed: a table with a plan",
                    path.string()));
  }
  if (("\n" + text).find("\n[refine]") != std::string::npos) {
    throw FileError(
        fmt::format("{}: an older version of limpid refined this map; this version cannot show a "
                    "refined map. Read the file with h5py",
                    path.string()));
  }
  auto plan = std::make_shared<SweepPlan>(plan_of_text(text, plan_behind(path.parent_path())));
  try {
    read_worlds(*plan);
  } catch (const std::exception& e) {
    plan->worlds.clear();
    why_no_run = fmt::format("files that the plan names were not found: {}", e.what());
    return plan;
  }
  const std::string key = file.text_if_any("key");
  if (!key.empty() && key != hex(plan->key)) {
    why_no_run = fmt::format(
        "files that the plan names have changed since the sweep. Limpid searches for them beside "
        "{} and among its own files",
        plan->file.string());
  }
  return plan;
}

void fill(const TableFile& file, SweepTable& table) {
  const std::uint64_t rows = file.count("points");
  if (table.points() != rows) file.refuse_rows(rows, table.points());
  const std::vector<double>& done = file.column("/done", rows);
  for (std::uint64_t i = 0; i < rows; ++i) table.done[i] = done[i] != 0;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const std::vector<double>& column = file.column("/measure/" + table.columns[c].name, rows);
    for (std::uint64_t i = 0; i < rows; ++i) {
      table.values[i * table.columns.size() + c] = column[i];
    }
  }
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

FileImage::FileImage(std::filesystem::path file) : path_(std::move(file)) {
  const hdf5::Properties access(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_fapl_core(access.get(), kGrowth, false);
  file_ = hdf5::File(H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()));
  check(bool(file_), path_, "cannot be made");
}

hdf5::Dataset FileImage::add(const std::string& path, hid_t stored_as, hid_t held_as, hsize_t rows,
                             hsize_t width, const void* data) {
  const std::array<hsize_t, 2> size{rows, width};
  const int rank = width == 1 ? 1 : 2;
  const std::array<hsize_t, 2> chunk{std::clamp<hsize_t>(kChunk / width, 1, rows), width};
  const hdf5::Properties creation(H5Pcreate(H5P_DATASET_CREATE));
  H5Pset_obj_track_times(creation.get(), false);
  H5Pset_chunk(creation.get(), rank, chunk.data());
  H5Pset_fletcher32(creation.get());
  const hdf5::Properties links(H5Pcreate(H5P_LINK_CREATE));
  H5Pset_create_intermediate_group(links.get(), 1);
  const hdf5::Dataspace space(H5Screate_simple(rank, size.data(), nullptr));
  hdf5::Dataset dataset(H5Dcreate2(file_.get(), path.c_str(), stored_as, space.get(), links.get(),
                                   creation.get(), H5P_DEFAULT));
  check(dataset && H5Dwrite(dataset.get(), held_as, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0,
        path_, "cannot be made");
  return dataset;
}

void FileImage::number(hid_t object, const char* name, std::uint64_t value) {
  hdf5::write_scalar(object, name, H5T_STD_U64LE, H5T_NATIVE_UINT64, &value, path_);
}

void FileImage::text(hid_t object, const char* name, const std::string& value) {
  hdf5::write_text(object, name, value, path_);
}

void FileImage::write() {
  check(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL) >= 0, path_, "cannot be made");
  const ssize_t size = H5Fget_file_image(file_.get(), nullptr, 0);
  check(size > 0, path_, "cannot be made");
  std::vector<unsigned char> bytes(static_cast<std::size_t>(size));
  check(H5Fget_file_image(file_.get(), bytes.data(), bytes.size()) == size, path_,
        "cannot be made");
  write_atomically(path_, bytes);
}

std::uint64_t SweepTable::count() const {
  return static_cast<std::uint64_t>(std::ranges::count(done, 1));
}

std::uint64_t diverged_points(const SweepTable& table) {
  const auto column = std::ranges::find(table.columns, "diverged", &SweepColumn::name);
  if (column == table.columns.end()) return 0;
  std::uint64_t count = 0;
  for (std::uint64_t point = 0; point < table.points(); ++point) {
    const double value = table.at(point, static_cast<std::size_t>(column - table.columns.begin()));
    if (table.done[point] == 1 && value == 1) ++count;
  }
  return count;
}

void SweepTable::take(std::uint64_t first, const std::vector<double>& found) {
  std::ranges::copy(found, values.begin() + static_cast<std::ptrdiff_t>(first * columns.size()));
  const auto from = done.begin() + static_cast<std::ptrdiff_t>(first);
  std::fill_n(from, found.size() / columns.size(), std::uint8_t{1});
}

void write_table(const SweepPlan& plan, const SweepTable& table,
                 const std::filesystem::path& file) {
  FileImage image(file);
  const std::uint64_t points = table.points();
  image.text(image.root(), "format", kSweepFormat);
  image.number(image.root(), "version", kSweepVersion);
  image.text(image.root(), "title", plan.title);
  image.text(image.root(), "plan", plan.text);
  image.text(image.root(), "key", hex(plan.key));
  image.text(image.root(), "app_version", program_version());
  image.text(image.root(), "build", hex(build_digest()));
  image.text(image.root(), "measures_in", kOwnUnits);
  image.number(image.root(), "points", points);
  image.number(image.root(), "done", table.count());
  for (std::size_t a = 0; a < plan.axes.size(); ++a) add_axis(plan, a, image);
  std::vector<double> column(points);
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    for (std::uint64_t i = 0; i < points; ++i) {
      column[i] = table.done[i] ? table.at(i, c) : std::nan("");
    }
    const hdf5::Dataset dataset = image.add("/measure/" + table.columns[c].name, H5T_IEEE_F64LE,
                                            H5T_NATIVE_DOUBLE, points, 1, column.data());
    image.text(dataset.get(), "unit", table.columns[c].unit);
    image.text(dataset.get(), "what", table.columns[c].what);
  }
  std::vector<std::uint32_t> repeat(points);
  for (std::uint64_t i = 0; i < points; ++i) {
    repeat[i] = static_cast<std::uint32_t>(i % plan.repeats);
  }
  image.add("/repeat", H5T_STD_U32LE, H5T_NATIVE_UINT32, points, 1, repeat.data());
  image.add("/done", H5T_STD_U8LE, H5T_NATIVE_UINT8, points, 1, table.done.data());
  image.write();
}

void write_table_csv(const SweepPlan& plan, const SweepTable& table,
                     const std::filesystem::path& file) {
  std::string text = "point";
  for (const SweepAxis& axis : plan.axes) {
    // An axis and a measure may share a name; columns may not.
    const bool taken = std::ranges::count(table.columns, axis.name, &SweepColumn::name) > 0;
    const std::string other = axis.key.empty() ? "axis " + axis.name : axis.key;
    text += ',' + csv_header(taken ? other : axis.name, axis.unit);
  }
  text += ",repeat";
  for (const SweepColumn& c : table.columns) text += ',' + csv_header(c.name, c.unit);
  text += '\n';
  for (std::uint64_t i = 0; i < table.points(); ++i) {
    if (!table.done[i]) continue;
    const SweepPoint point = point_of(plan, i);
    text += fmt::format("{}", i);
    for (std::size_t a = 0; a < plan.axes.size(); ++a) {
      const SweepAxis& axis = plan.axes[a];
      text += ',' + (axis.words.empty()
                         ? csv_number(point.values[a])
                         : csv_word(axis.words[static_cast<std::size_t>(point.values[a])]));
    }
    text += fmt::format(",{}", point.repeat);
    for (std::size_t c = 0; c < table.columns.size(); ++c) text += ',' + csv_number(table.at(i, c));
    text += '\n';
  }
  write_atomically(file, {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
}

std::uint64_t build_digest() {
  static const std::uint64_t digest = [] {
    Digest all;
    all.add(program_digest());
    // Includes results of the mathematical library, which chooses its code by the processor.
    for (int i = 1; i <= 500; ++i) {
      const volatile double x = 0.0137 * i;
      for (const double y : {std::sin(x), std::cos(x), std::tan(x), std::exp(-x), std::log(x),
                             std::pow(x, 0.7), std::atan2(x, 1.3), std::hypot(x, 0.9)}) {
        all.add(y);
      }
    }
    return all.value();
  }();
  return digest;
}

std::string hex(std::uint64_t digest) { return fmt::format("{:016x}", digest); }

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
  if (file.text_if_any("measures_in") != kOwnUnits) {
    for (SweepColumn& each : opened->table.columns) {
      if (const MeasureInfo* measure = find_measure(each.name)) each.unit = measure->unit;
    }
  }
  for (std::size_t c = 0; c < opened->table.columns.size(); ++c) {
    opened->ranges.push_back(range_of(opened->table, c));
  }
  return opened;
}

}  // namespace limpid
