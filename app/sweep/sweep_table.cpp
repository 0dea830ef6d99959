#include "app/sweep/sweep_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "app/base/version.h"
#include "app/run/run_key.h"
#include "app/sweep/file_image.h"
#include "devices/files/atomic_file.h"

namespace limpid {
namespace {

// As the column of a table: of each point.
std::vector<double> column_of(const SweepPlan& plan, const SweepRows& rows, std::size_t axis) {
  std::vector<double> values(rows.size());
  for (std::uint64_t i = 0; i < values.size(); ++i) {
    values[i] = point_of(plan, rows.point(i)).values[axis];
  }
  return values;
}

void add_axis(const SweepPlan& plan, const SweepRows& rows, std::size_t a, FileImage& image) {
  const SweepAxis& axis = plan.axes[a];
  const std::vector<double> values = column_of(plan, rows, a);
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

void add_rounds(const SweepRows& rows, FileImage& image) {
  std::vector<std::uint64_t> point;
  std::vector<std::uint32_t> round;
  for (std::uint64_t i = 0; i < rows.size(); ++i) {
    point.push_back(rows.point(i));
    round.push_back(static_cast<std::uint32_t>(rows.round(i)));
  }
  image.add("/point", H5T_STD_U64LE, H5T_NATIVE_UINT64, point.size(), 1, point.data());
  image.add("/round", H5T_STD_U32LE, H5T_NATIVE_UINT32, round.size(), 1, round.data());
}

// Enough digits to give the same number again.
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

}  // namespace

std::uint64_t SweepTable::count() const {
  return static_cast<std::uint64_t>(std::ranges::count(done, 1));
}

std::optional<double> SweepTable::inferred(const std::vector<std::size_t>& place,
                                           std::uint64_t repeat, std::size_t column) const {
  const auto corners = rows.around(place, repeat);
  double sum = 0;
  for (const auto& [row, weight] : corners) {
    if (!done[row] || !std::isfinite(at(row, column))) return std::nullopt;
    sum += weight * at(row, column);
  }
  return corners.empty() ? std::nullopt : std::optional(sum);
}

bool SweepTable::grow() {
  if (!rows.grow([this](std::uint64_t row) { return at(row, refined_by); })) return false;
  done.resize(rows.size(), 0);
  values.resize(rows.size() * columns.size());
  return true;
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
  image.number(image.root(), "points", points);
  image.number(image.root(), "done", table.count());
  for (std::size_t a = 0; a < plan.axes.size(); ++a) add_axis(plan, table.rows, a, image);
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
    repeat[i] = static_cast<std::uint32_t>(table.rows.point(i) % plan.repeats);
  }
  image.add("/repeat", H5T_STD_U32LE, H5T_NATIVE_UINT32, points, 1, repeat.data());
  if (plan.refine) add_rounds(table.rows, image);
  image.add("/done", H5T_STD_U8LE, H5T_NATIVE_UINT8, points, 1, table.done.data());
  image.write();
}

void write_table_csv(const SweepPlan& plan, const SweepTable& table,
                     const std::filesystem::path& file) {
  std::string text = "point";
  for (const SweepAxis& axis : plan.axes) text += ',' + csv_header(axis.name, axis.unit);
  text += ",repeat";
  for (const SweepColumn& c : table.columns) text += ',' + csv_header(c.name, c.unit);
  text += '\n';
  for (std::uint64_t i = 0; i < table.points(); ++i) {
    if (!table.done[i]) continue;
    const SweepPoint point = point_of(plan, table.rows.point(i));
    text += fmt::format("{}", table.rows.point(i));
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
    // The mathematical library chooses its code by the processor.
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

}  // namespace limpid
