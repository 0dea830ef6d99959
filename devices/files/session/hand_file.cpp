#include "devices/files/session/hand_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include "devices/files/text_file.h"

namespace limpid {

namespace {

constexpr std::size_t kLongestCsv = std::size_t{1} << 30;  // [bytes]
constexpr double kFarthest = 10;                           // [m]
constexpr double kLongestTime = 1e6;                       // [s]
constexpr std::string_view kSource = "# source: ";         // begins a line before the header
constexpr std::size_t kLongestSource = 200;                // [bytes]
constexpr std::array<std::string_view, 4> kHeader{"time_s", "x_m", "y_m", "z_m"};

// Cuts the first field off `line`.
std::string_view take_field(std::string_view& line) {
  const auto comma = line.find(',');
  const auto field = trimmed(line.substr(0, comma));
  line = comma == std::string_view::npos ? std::string_view{} : line.substr(comma + 1);
  return field;
}

// `text` with '?' for bytes that are no text for a terminal.
std::string printable(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return std::iscntrl(static_cast<unsigned char>(c)); },
      '?');
  return text;
}

struct Csv {
  const std::string& where;
  int line = 0;
  bool magnet = false;  // there is a fifth column, magnet

  [[noreturn]] void refuse(const std::string& why) const {
    throw FileError(fmt::format("{}:{}: {}", where, line, printable(why)));
  }

  void read_header(std::string_view text) {
    std::string_view rest = text;
    for (const std::string_view wanted : kHeader) {
      if (take_field(rest) != wanted) {
        refuse(fmt::format("header \"{:.60}\"; needed: time_s,x_m,y_m,z_m", trimmed(text)));
      }
    }
    magnet = take_field(rest) == "magnet";
  }

  double number(std::string_view field, std::string_view column, double limit) const {
    double x = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), x);
    if (field.empty() || error != std::errc{} || end != field.data() + field.size()) {
      refuse(fmt::format("{}: \"{:.40}\" is not a number", column, field));
    }
    if (!(std::abs(x) <= limit)) {
      refuse(
          fmt::format("{}: {} is not allowed; allowed: from -{} to {}", column, x, limit, limit));
    }
    return x;
  }

  void add_row(std::string_view text, HandPath& path) const {
    std::array<double, 4> row{};
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string_view field = take_field(text);
      row[i] = number(field, kHeader[i], i == 0 ? kLongestTime : kFarthest);
    }
    if (!path.time.empty() && row[0] <= path.time.back()) {
      refuse(fmt::format("time_s: {} after {}; needed: increasing", row[0], path.time.back()));
    }
    path.time.push_back(row[0]);
    path.position.emplace_back(row[1], row[2], row[3]);
    path.grip.push_back(1);
    if (!magnet) return;
    const double on = number(take_field(text), "magnet", 1);
    if (on != 0 && on != 1) refuse(fmt::format("magnet: {} is not allowed; allowed: 0 or 1", on));
    path.magnet.push_back(on == 1);
  }
};

// Slope of the monotone cubic at the middle one of three points with distances h and secants d
// (Fritsch and Butland 1984): zero at an extremum, else between the secants.
double slope(double h0, double d0, double h1, double d1) {
  if (d0 * d1 <= 0) return 0;
  const double w0 = 2 * h1 + h0;
  const double w1 = h1 + 2 * h0;
  return (w0 + w1) / (w0 / d0 + w1 / d1);
}

// Velocities at the samples. The hand starts and ends at rest, so that the path stays smooth there.
void find_velocities(HandPath& path) {
  const std::size_t n = path.time.size();
  path.velocity.assign(n, Vec3::Zero());
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double h0 = path.time[i] - path.time[i - 1];
    const double h1 = path.time[i + 1] - path.time[i];
    const Vec3 d0 = (path.position[i] - path.position[i - 1]) / h0;
    const Vec3 d1 = (path.position[i + 1] - path.position[i]) / h1;
    for (int axis = 0; axis < 3; ++axis) {
      path.velocity[i][axis] = slope(h0, d0[axis], h1, d1[axis]);
    }
  }
}

void start_at_zero(HandPath& path) {
  const double start = path.time.front();
  for (double& t : path.time) t -= start;
}

// The last sample at or before t, which must not lie before the first.
std::size_t before(const std::vector<double>& time, double t) {
  return static_cast<std::size_t>(std::upper_bound(time.begin(), time.end(), t) - time.begin()) - 1;
}

// The position in row k. Errors: FileError if it is farther off than a hand may be.
Vec3 place_of(const Session& session, std::size_t k, Column column, const std::string& where) {
  const auto at = session.at(k, column);
  for (const double x : at) {
    if (std::abs(x) <= kFarthest) continue;
    throw FileError(fmt::format("{}: {}: row {}: {} is not allowed; allowed: from -{} to {} m",
                                where, kColumnInfo[static_cast<std::size_t>(column)].path, k, x,
                                kFarthest, kFarthest));
  }
  return {at[0], at[1], at[2]};
}

// Pulls of the rows; empty if there are none. Errors: FileError.
std::vector<BodyPull> pulls_of(const Session& session, const std::string& where) {
  std::vector<BodyPull> pulls;
  for (std::size_t k = 0; k < session.size(); ++k) {
    const double number = session.at(k, Column::hand_pull)[0];
    if (!(number >= 0 && number <= kMostBodies)) {
      throw FileError(
          fmt::format("{}: /hand/pull: row {}: {} is not allowed; allowed: 0 (no body) or the "
                      "number of a body, up to {}",
                      where, k, number, kMostBodies));
    }
    if (number == 0) continue;
    if (pulls.empty()) pulls.resize(session.size());
    pulls[k] = {static_cast<int>(number) - 1, place_of(session, k, Column::pull_point, where),
                place_of(session, k, Column::pull_target, where)};
  }
  return pulls;
}

}  // namespace

Vec3 HandPath::at(double t) const {
  if (!(t > time.front())) return position.front();
  if (t >= time.back()) return position.back();
  const std::size_t i = before(time, t);
  if (t == time[i]) return position[i];
  // Cubic Hermite on [0, 1].
  const double h = time[i + 1] - time[i];
  const double s = (t - time[i]) / h;
  const double r = 1 - s;
  return (1 + 2 * s) * r * r * position[i] + s * s * (3 - 2 * s) * position[i + 1] +
         h * s * r * (r * velocity[i] - s * velocity[i + 1]);
}

Vec3 HandPath::sample(std::size_t k, double T) const {
  if (tick == T) return position[std::min(k, position.size() - 1)];
  return at(static_cast<double>(k) * T);
}

// The sample that holds at the k-th tick.
std::size_t HandPath::row(std::size_t k, double T) const {
  if (tick == T) return std::min(k, time.size() - 1);
  return row_at(static_cast<double>(k) * T);
}

std::size_t HandPath::row_at(double t) const { return t > time.front() ? before(time, t) : 0; }

double HandPath::grip_at(double t) const { return grip[row_at(t)]; }

double HandPath::grip_sample(std::size_t k, double T) const { return grip[row(k, T)]; }

bool HandPath::magnet_sample(std::size_t k, double T) const {
  return !magnet.empty() && magnet[row(k, T)];
}

BodyPull HandPath::pull_sample(std::size_t k, double T) const {
  return pull.empty() ? BodyPull{} : pull[row(k, T)];
}

HandPath hand_of(const Session& session, const std::string& where) {
  if (session.size() == 0) {
    throw FileError(
        fmt::format("{}: the file has no rows, so there is no motion of a hand", where));
  }
  HandPath path;
  path.source = where;
  path.tick = session.info.tick;
  for (std::size_t k = 0; k < session.size(); ++k) {
    const Vec3 target = place_of(session, k, Column::hand_target, where);
    const double grip = session.at(k, Column::hand_grip)[0];
    if (!(grip >= 0 && grip <= 1)) {
      throw FileError(
          fmt::format("{}: /hand/grip: row {}: {} is not allowed; allowed: from 0 to "
                      "1",
                      where, k, grip));
    }
    path.time.push_back(session.at(k, Column::time)[0]);
    path.position.push_back(target);
    path.grip.push_back(grip);
    if (session.layout.bodies() > 0) {
      path.magnet.push_back(session.at(k, Column::hand_magnet)[0] > 0);
    }
  }
  if (session.layout.bodies() > 0) path.pull = pulls_of(session, where);
  start_at_zero(path);
  find_velocities(path);
  return path;
}

HandPath hand_through(std::vector<double> time, std::vector<Vec3> position, std::string source) {
  HandPath path;
  path.grip.assign(time.size(), 1);
  path.time = std::move(time);
  path.position = std::move(position);
  path.source = std::move(source);
  find_velocities(path);
  return path;
}

HandPath read_hand(const std::filesystem::path& file) {
  const auto extension = file.extension();
  if (extension == ".h5" || extension == ".part") return hand_of(read_session(file), file.string());
  return parse_hand_csv(read_text(file, kLongestCsv), file.string());
}

HandPath parse_hand_csv(const std::string& text, const std::string& where) {
  HandPath path;
  path.source = where;
  Csv csv{where};
  std::string_view rest = text;
  bool headed = false;
  while (!rest.empty()) {
    const auto end = rest.find('\n');
    const std::string_view line = rest.substr(0, end);
    rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
    ++csv.line;
    if (csv.line == 1 && line.starts_with(kSource)) {
      const std::string_view source = trimmed(line.substr(kSource.size()));
      path.source = printable(std::string(source.substr(0, kLongestSource)));
    } else if (!std::exchange(headed, true)) {
      csv.read_header(line);
    } else if (!trimmed(line).empty()) {
      csv.add_row(line, path);
    }
  }
  if (path.time.size() < 2) {
    throw FileError(fmt::format("{}: {} samples; needed: a header and at least 2 samples", where,
                                path.time.size()));
  }
  start_at_zero(path);
  find_velocities(path);
  return path;
}

}  // namespace limpid
