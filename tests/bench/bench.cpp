#include "tests/bench/bench.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "app/base/interrupt.h"
#include "app/base/version.h"
#include "app/live/rtkit.h"
#include "core/realtime/clock.h"
#include "core/realtime/realtime.h"
#include "tests/bench/bodies.h"
#include "tests/bench/mesh_stroke.h"
#include "tests/bench/pressed.h"
#include "tests/bench/recorded_run.h"

namespace limpid::bench {

double Samples::quantile(double share) const {
  std::vector<double> sorted = values_;
  const auto last = static_cast<double>(sorted.size() - 1);
  const auto at = sorted.begin() + static_cast<std::ptrdiff_t>(std::floor(share * last));
  std::nth_element(sorted.begin(), at, sorted.end());
  return *at;
}

namespace {

int open_counter() {
  perf_event_attr event{};
  event.type = PERF_TYPE_HARDWARE;
  event.size = sizeof event;
  event.config = PERF_COUNT_HW_INSTRUCTIONS;
  event.disabled = 1;
  event.exclude_kernel = 1;
  event.exclude_hv = 1;
  return static_cast<int>(syscall(SYS_perf_event_open, &event, 0, -1, -1, PERF_FLAG_FD_CLOEXEC));
}

using namespace std::chrono_literals;

constexpr int kWakes = 2000;

// Measures a fixed piece of arithmetic, which depends only on the processor.
Line yardstick(int times) {
  Eigen::Matrix<double, 24, 24> matrix;
  for (int i = 0; i < 24; ++i) {
    for (int j = 0; j < 24; ++j) matrix(i, j) = i == j ? 30 : std::cos(i * j);
  }
  Samples taken(static_cast<std::size_t>(times));
  double sum = 0;
  for (int k = 0; k < times; ++k) {
    matrix(k % 24, k % 24) = 30 + 1e-3 * k;
    taken.time([&] { sum += matrix.llt().matrixL()(23, 23); });
  }
  if (!(sum > 0)) throw std::runtime_error("the yardstick is broken");
  return line_of("yardstick", "yardstick: Cholesky of 24 rows", taken);
}

// Measures how late an ordinary thread wakes up, like cyclictest.
Line wakes() {
  const MonotonicTime time;
  Samples late(kWakes);
  nanoseconds due = time.now();
  for (int k = 0; k < kWakes; ++k) {
    due += 1ms;
    time.sleep_until(due);
    late.add(1e6 * in_seconds(time.now() - due));
  }
  return line_of("wake", "waking up after 1 ms, late by", late);
}

// Note on a line whose run was unstable, or touched too little.
std::string remark(bool diverged, int touching, int ticks) {
  if (diverged) return ", unstable";
  if (touching >= ticks * 9 / 10) return "";
  return fmt::format(", touching {:.0f} %", 100.0 * touching / ticks);
}

template <int N>
Line pressing(const Wishes& wishes, const Line& unit, int joints, CouplingKind law, bool of_arm) {
  Pressed<N> pressed(chain(joints), law);
  Samples taken(static_cast<std::size_t>(wishes.ticks));
  InstructionCounter counter;
  const Vec<N>* torque = nullptr;
  const auto control = [&] { torque = &pressed.control(); };
  const auto live = [&] { pressed.live(*torque); };
  int touching = 0;
  for (int k = 0; k < wishes.ticks; ++k) {
    // Times and instructions alternate: reading the counter would take part in the time.
    if (of_arm) {
      control();
      k % 2 ? counter.count(live) : taken.time(live);
    } else {
      k % 2 ? counter.count(control) : taken.time(control);
      live();
    }
    touching += pressed.touches();
  }
  const std::string id =
      of_arm ? fmt::format("arm/{}", joints) : fmt::format("tick/{}/{}", joints, info(law).key);
  const std::string name = of_arm
                               ? fmt::format("virtual arm and hand, n = {}", joints)
                               : fmt::format("tick in contact, n = {}, {}", joints, info(law).key);
  Line line = line_of(id, name + remark(pressed.diverged(), touching, wishes.ticks), taken, &unit);
  if (const auto counted = counter.total()) {
    const int ticks = wishes.ticks / 2;
    line.instructions = static_cast<double>(*counted) / ticks;
  }
  return line;
}

Line pressing(const Wishes& wishes, const Line& unit, int joints, CouplingKind law, bool of_arm) {
  return with_dof(joints, [&](auto n) { return pressing<n>(wishes, unit, joints, law, of_arm); });
}

// Measures Embree's query alone at the places of a stroke.
Line bare_query(const Wishes& wishes, const std::shared_ptr<const TriangleMesh>& shape,
                const std::string& id, const std::string& what) {
  const StrokePlace place;
  constexpr double kTip = 0.005;
  Stroke stroke(place, kTip, place.on_mesh(shape, kTip, false));
  Samples taken(static_cast<std::size_t>(wishes.ticks));
  MeshPoint nearest;
  for (int k = 0; k < wishes.ticks; ++k) {
    stroke.move();
    const Vec3 at = stroke.tip() - place.middle;
    taken.time([&] { shape->nearest(at, 2 * kTip, nearest.triangle, nearest); });
  }
  return line_of(id, what, taken);
}

Line stroking(const Wishes& wishes, const std::shared_ptr<const TriangleMesh>& shape, double tip,
              const Line& query, const std::string& id, const std::string& what) {
  const StrokePlace place;
  Stroke stroke(place, tip, place.on_mesh(shape, tip, false));
  Samples taken(static_cast<std::size_t>(wishes.ticks));
  int touching = 0;
  for (int k = 0; k < wishes.ticks; ++k) {
    stroke.move();
    taken.time([&] { stroke.control(); });
    touching += stroke.touches();
  }
  return line_of(id, what + remark(stroke.diverged(), touching, wishes.ticks), taken, &query);
}

// A group of lines and how to measure it.
struct Piece {
  std::string id;
  std::function<void(Report&)> measure;
};

void add_ticks(std::vector<Piece>& all, const Wishes& wishes, const Line& unit) {
  const auto add = [&](int joints, CouplingKind law) {
    all.push_back({fmt::format("tick/{}/{}", joints, info(law).key),
                   [&wishes, &unit, joints, law](Report& report) {
                     report.lines.push_back(pressing(wishes, unit, joints, law, false));
                   }});
  };
  add(3, CouplingKind::standard);
  for (const int joints : {3, 7, 15, 30}) {
    add(joints, CouplingKind::proposed);
    add(joints, CouplingKind::predictive);
  }
  for (const int joints : {3, 7, 15, 30}) {
    all.push_back({fmt::format("arm/{}", joints), [&wishes, &unit, joints](Report& report) {
                     report.lines.push_back(
                         pressing(wishes, unit, joints, CouplingKind::proposed, true));
                   }});
  }
}

void add_meshes(std::vector<Piece>& all, const Wishes& wishes) {
  for (const int thousands : {1, 10, 100, 1000}) {
    const std::string id = fmt::format("mesh/{}k", thousands);
    all.push_back({id, [&wishes, id, thousands](Report& report) {
                     const auto shape = bumpy_body(1000 * static_cast<std::size_t>(thousands));
                     const std::string size = fmt::format("{} triangles", 1000 * thousands);
                     Samples built(1);
                     built.add(1e6 * shape->build_seconds());
                     report.lines.push_back(line_of(id + "/build", size + ": search tree", built));
                     const Line query =
                         bare_query(wishes, shape, id + "/query", size + ": nearest point");
                     report.lines.push_back(query);
                     for (const int mm : {1, 5}) {
                       report.lines.push_back(
                           stroking(wishes, shape, 1e-3 * mm, query, fmt::format("{}/{}mm", id, mm),
                                    fmt::format("{}: tick, tip of {} mm", size, mm)));
                     }
                   }});
  }
}

void add_bodies(std::vector<Piece>& all, const Wishes& wishes, const Line& unit) {
  for (const int count : {10, 50}) {
    for (const Boxes what : {Boxes::rest, Boxes::slide, Boxes::asleep}) {
      all.push_back({id_of(count, what), [&wishes, &unit, count, what](Report& report) {
                       report.lines.push_back(boxes(wishes, unit, count, what));
                     }});
    }
  }
}

std::vector<Piece> pieces(const Wishes& wishes, const Line& unit) {
  std::vector<Piece> all;
  all.push_back({"wake", [](Report& report) { report.lines.push_back(wakes()); }});
  add_ticks(all, wishes, unit);
  add_bodies(all, wishes, unit);
  add_meshes(all, wishes);
  all.push_back({"run", [&unit](Report& report) {
                   for (Line& line : recorded_runs(unit)) report.lines.push_back(std::move(line));
                 }});
  return all;
}

// Keeps the pieces at or below `only`, such as "tick" or "tick/3".
void keep_only(std::vector<Piece>& all, const std::string& only) {
  std::string known;
  for (const Piece& piece : all) known += (known.empty() ? "" : ", ") + piece.id;
  std::erase_if(all, [&](const Piece& p) { return !(p.id + "/").starts_with(only + "/"); });
  if (!all.empty()) return;
  throw std::invalid_argument(fmt::format("\"{}\": needed: one of {}", only, known));
}

double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

// Asks in a thread that ends at once, so that this one stays as it is.
std::string granted() {
  std::string said;
  std::thread([&said] { said = become_realtime(by_rtkit()).explanation; }).join();
  return said.substr(0, said.find(';'));
}

nlohmann::ordered_json json_of(const Machine& m) {
  return {{"processor", m.processor}, {"processors", m.processors}, {"kernel", m.kernel},
          {"compiler", m.compiler},   {"haptic_thread", m.threads}, {"counts", m.counts}};
}

nlohmann::ordered_json json_of(const Line& line) {
  nlohmann::ordered_json json{{"id", line.id},         {"what", line.what}, {"unit", line.unit},
                              {"median", line.median}, {"p99", line.p99},   {"p99.9", line.p999},
                              {"max", line.largest}};
  if (line.ratio) {
    json["of"] = line.of;
    json["ratio"] = *line.ratio;
  }
  if (line.instructions) json["instructions"] = *line.instructions;
  if (line.real_time) json["real_time"] = *line.real_time;
  return json;
}

// `us` in a readable unit.
std::string time_text(double us) {
  if (us < 9.995) return fmt::format("{:.2f}", us);
  if (us < 9999) return fmt::format("{:.{}f}", us, us < 99.95 ? 1 : 0);
  return us < 999.5e3 ? fmt::format("{:.3g} ms", 1e-3 * us) : fmt::format("{:.3g} s", 1e-6 * us);
}

}  // namespace

InstructionCounter::InstructionCounter() : file_(open_counter()) {}

InstructionCounter::~InstructionCounter() {
  if (counts()) close(file_);
}

void InstructionCounter::start() const {
  if (counts()) ioctl(file_, PERF_EVENT_IOC_ENABLE, 0);
}

void InstructionCounter::stop() const {
  if (counts()) ioctl(file_, PERF_EVENT_IOC_DISABLE, 0);
}

std::optional<std::uint64_t> InstructionCounter::total() const {
  std::uint64_t count = 0;
  if (!counts() || read(file_, &count, sizeof count) != sizeof count) return std::nullopt;
  return count;
}

Report measure(const Wishes& wishes, const std::function<void(double, const std::string&)>& done) {
  Report report{.program = program_version(),
                .date = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))),
                .machine = this_machine()};
  const Line unit = yardstick(wishes.ticks);
  report.lines.push_back(unit);
  std::vector<Piece> all = pieces(wishes, unit);
  if (!wishes.only.empty()) keep_only(all, wishes.only);
  double asleep = 0;
  const MonotonicTime time;
  const nanoseconds began = time.now();
  const double worked = processor_seconds();
  for (std::size_t i = 0; i < all.size() && !interrupted; ++i) {
    done(static_cast<double>(i) / static_cast<double>(all.size()), all[i].id);
    all[i].measure(report);
    if (all[i].id == "wake") asleep = 1e-3 * kWakes;
  }
  done(1, "");
  const double took = in_seconds(time.now() - began) - asleep;
  if (took > 0.1) report.share = std::min(1.0, (processor_seconds() - worked) / took);
  return report;
}

Machine this_machine() {
  utsname name{};
  uname(&name);
  return {
    processor(), static_cast<int>(std::thread::hardware_concurrency()),
        fmt::format("{} {} {}", name.sysname, name.release, name.machine),
#if defined(__clang__)
        fmt::format("clang {}", __clang_version__),
#else
        fmt::format("gcc {}", __VERSION__),
#endif
        granted(), InstructionCounter().counts()
  };
}

Line line_of(std::string id, std::string what, const Samples& times, const Line* yardstick) {
  Line line{std::move(id),       std::move(what),      "us",
            times.quantile(0.5), times.quantile(0.99), times.quantile(0.999),
            times.quantile(1)};
  if (yardstick != nullptr) {
    line.of = yardstick->id;
    line.ratio = line.median / yardstick->median;
  }
  return line;
}

std::string table_head() {
  return fmt::format("{:<46}{:>9}{:>9}{:>9}{:>9}{:>8}{:>14}\n", "times in us", "median", "p99",
                     "p99.9", "max", "ratio", "instructions");
}

std::string table_line(const Line& line) {
  const bool many = line.largest > line.median || line.p99 > line.median;  // else one value
  const auto beside = [&](double us) { return many ? time_text(us) : std::string(); };
  return fmt::format("{:<46}{:>9}{:>9}{:>9}{:>9}{:>8}{:>14}\n", line.what, time_text(line.median),
                     beside(line.p99), beside(line.p999), beside(line.largest),
                     line.ratio ? fmt::format("{:.2f}", *line.ratio) : "",
                     line.instructions ? fmt::format("{:.0f}", *line.instructions)
                     : line.real_time  ? fmt::format("{:.0f} x life", *line.real_time)
                                       : "");
}

std::string text_of(const Report& report) {
  const Machine& m = report.machine;
  std::string text = fmt::format("limpid {}, {}\n{}, {} of them; {}; {}\nhaptic thread: {}\n\n{}",
                                 report.program, report.date, m.processor, m.processors, m.kernel,
                                 m.compiler, m.threads, table_head());
  for (const Line& line : report.lines) text += table_line(line);
  text +=
      "\nratio: of the medians, to the yardstick above, for meshes to the nearest point found by "
      "Embree. Medians "
      "and p99 are the\nprogram's; p99.9 and max are the machine's.\n";
  if (!m.counts) text += "Instructions cannot be counted here (perf_event_open).\n";
  if (report.share < 0.95) {
    text += fmt::format(
        "The machine was busy: this had {:.0f} % of a processor. Ratios hold, times do not.\n",
        100 * report.share);
  }
  return text;
}

std::string json_of(const Report& report) {
  nlohmann::ordered_json lines = nlohmann::ordered_json::array();
  for (const Line& line : report.lines) lines.push_back(json_of(line));
  const nlohmann::ordered_json all{{"limpid", report.program},
                                   {"date", report.date},
                                   {"machine", json_of(report.machine)},
                                   {"share", report.share},
                                   {"lines", lines}};
  return all.dump(2) + "\n";
}

}  // namespace limpid::bench
