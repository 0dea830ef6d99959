#include "devices/files/session/session_program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/child.h"
#include "core/base/descriptor.h"
#include "devices/files/session/hdf5_reading.h"
#include "devices/files/session/session.h"
#include "devices/files/session/session_reader.h"
#include "devices/files/session/session_source.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

using wire::Answer;
using wire::Broken;
using wire::Reader;
using wire::Writer;

void put_run(Writer& to, const Session& run) {
  to.list(std::span<const double>(run.world));
  to.number<std::uint64_t>(run.changes.size());
  for (const SettingChange& change : run.changes) {
    to.number(change.row);
    to.text(change.setting);
  }
}

void take_run(Reader& from, std::uint64_t rows, Session& run) {
  run.world = from.list<std::vector<double>>();
  if (run.world.size() > kMostWorld) throw Broken("more states of bodies than a scene can have");
  const std::size_t changes = from.taken(2 * sizeof(std::uint64_t));
  for (std::size_t i = 0; i < changes; ++i) {
    const auto row = from.number<std::uint64_t>();
    if (row > rows || (i > 0 && row < run.changes.back().row)) {
      throw Broken("changes of settings that are not in the order of rows");
    }
    run.changes.push_back({row, from.text()});
  }
}

void put_marks(Writer& to, std::span<const Mark> marks) {
  to.number<std::uint64_t>(marks.size());
  for (const Mark& mark : marks) {
    to.number(mark.tick);
    to.text(mark.text);
  }
}

std::vector<Mark> take_marks(Reader& from) {
  std::vector<Mark> marks;
  for (std::size_t left = from.taken(2 * sizeof(std::uint64_t)); left > 0; --left) {
    const auto tick = from.number<std::uint64_t>();
    marks.push_back({tick, from.text()});
  }
  return marks;
}

// Calls `work` with each text of SessionInfo, in the same order at both ends.
template <class Info, class Work>
void each_text(Info& info, Work work) {
  for (auto* const text :
       {&info.created, &info.app_version, &info.build, &info.source, &info.config, &info.safety,
        &info.device_urdf, &info.scene, &info.story}) {
    work(*text);
  }
}

SessionInfo take_info(Reader& from) {
  SessionInfo info;
  info.tick = from.number<double>();
  info.dof = from.number<int>();
  // Checks as check_session_info() does, which names what is wrong with a file.
  if (!(info.tick > 0 && info.tick <= 0.1) || info.dof < 1 || info.dof > kMaxDof) {
    throw Broken("an arm that is not possible");
  }
  info.seed = from.number<std::uint64_t>();
  each_text(info, [&](std::string& text) { text = from.text(); });
  const std::size_t models = from.taken(2 * sizeof(std::uint64_t));
  for (std::size_t i = 0; i < models; ++i) {
    const std::string name = from.text();
    info.models[name] =
        std::make_shared<const std::vector<unsigned char>>(from.list<std::vector<unsigned char>>());
  }
  const auto slides = from.list<std::vector<unsigned char>>();
  if (!slides.empty() && slides.size() != static_cast<std::size_t>(info.dof)) {
    throw Broken("more joints than the arm has");
  }
  for (const unsigned char slide : slides) info.slides.push_back(slide != 0);
  const std::size_t bodies = from.taken(sizeof(std::uint64_t));
  if (bodies > kMostBodies) throw Broken("more bodies than are possible");
  for (std::size_t i = 0; i < bodies; ++i) info.bodies.push_back(from.text());
  return info;
}

// Reads pieces of rows. Returns the number of rows.
std::uint64_t take_rows(Reader& from, const Session& about, std::uint64_t claimed,
                        const TakeRows& take) {
  const auto stride = static_cast<std::size_t>(about.layout.stride());
  std::uint64_t rows = 0;
  while (true) {
    from.begin_piece();
    const auto next = from.number<Answer>();
    if (next == Answer::refusal) throw FileError(from.text());
    if (next == Answer::end) return rows;
    if (next != Answer::rows) throw Broken("a message that is not part of a session");
    std::array<std::vector<double>, kMostLanes> lists;
    std::array<std::span<const double>, kMostLanes> pieces;
    for (std::size_t i = 0; i < about.lanes(); ++i) {
      lists[i] = from.list<std::vector<double>>();
      if (lists[i].size() % stride != 0) throw Broken("incomplete rows");
      if (lists[i].size() != lists[0].size()) {
        throw Broken("runs of different lengths");
      }
      pieces[i] = lists[i];
    }
    rows += lists[0].size() / stride;
    if (rows > claimed) throw Broken("more rows than were announced");
    take(LaneRows(pieces).first(about.lanes()));
  }
}

constexpr int kPipeBytes = 1 << 20;

// The reason for the program's end; empty if it was killed as nobody wanted to hear more.
std::string why_ended(int status) {
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) return {};
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) {
    return "cannot be read: reading takes much longer than normal for a file of this size";
  }
  return why_failed(status, kSessionProgram);
}

// Returns the program's answer about `file`, read by `take`; the program gets the descriptors
// `given`.
template <class Take>
auto ask(const char* what, const fs::path& file, Take take, std::vector<Given> given = {}) {
  std::array<int, 2> ends{-1, -1};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    refuse(file, "cannot be read: too many files are open");
  }
  const Descriptor answers(ends[0]);
  Descriptor other_end(ends[1]);
  ::fcntl(*answers, F_SETPIPE_SZ, kPipeBytes);
  const std::string at = own_program(kSessionProgram).string();
  given.push_back({*other_end, STDOUT_FILENO});
  Child child({at, what, file.string()}, given);
  if (!child.started()) {
    refuse(file, fmt::format("cannot be read: its reader {} cannot be started", at));
  }
  other_end.close();
  try {
    wire::Reader from(*answers, physical_memory());
    if (from.number<wire::Answer>() != wire::Answer::contents) throw FileError(from.text());
    return take(from);
  } catch (const wire::Broken& broken) {
    const std::string why = why_ended(child.end());
    refuse(file, why.empty() ? fmt::format("the program that reads the file sent wrong data: {}",
                                           broken.what())
                             : why);
  } catch (const NoRoom& none) {
    refuse(file, fmt::format("is too large for this computer: {}", none.what()));
  } catch (const std::bad_alloc&) {
    refuse(file, "larger than this computer's memory");
  }
}

}  // namespace

namespace wire {

void Writer::bytes(std::span<const unsigned char> all) {
  if (!write_all(to_, all)) throw Broken("nobody reads");
}

void Reader::bytes(std::span<unsigned char> all) {
  if (all.size() > left_) throw Broken("too much");
  left_ -= all.size();
  while (!all.empty()) {
    const ssize_t read = ::read(from_, all.data(), all.size());
    if (read < 0 && errno == EINTR) continue;
    if (read <= 0) throw Broken("cut off");
    all = all.subspan(static_cast<std::size_t>(read));
  }
}

std::size_t Reader::taken(std::size_t size) {
  const auto count = number<std::uint64_t>();
  if (count > left_ / size) throw Broken("too much");
  return static_cast<std::size_t>(count);
}

void put_about(Writer& to, const Session& session, std::uint64_t rows) {
  const SessionInfo& info = session.info;
  to.number(info.tick);
  to.number(info.dof);
  to.number(info.seed);
  each_text(info, [&](const std::string& text) { to.text(text); });
  to.number<std::uint64_t>(info.models.size());
  for (const auto& [name, bytes] : info.models) {
    to.text(name);
    to.list(std::span<const unsigned char>(*bytes));
  }
  to.list(std::span<const unsigned char>(
      std::vector<unsigned char>(info.slides.begin(), info.slides.end())));
  to.number<std::uint64_t>(info.bodies.size());
  for (const std::string& name : info.bodies) to.text(name);
  to.number<std::uint64_t>(session.beside.size());
  for (const Session& lane : session.beside) to.text(lane.info.config);
  to.number(rows);
  for (std::size_t i = 0; i < session.lanes(); ++i) put_run(to, session.lane(i));
}

void put_rows(Writer& to, LaneRows rows) {
  to.number(Answer::rows);
  for (const std::span<const double> lane : rows) to.list(lane);
}

void put_rest(Writer& to, const Session& session) {
  to.number(Answer::end);
  put_marks(to, session.marks);
}

void put_session(Writer& to, const Session& session) {
  put_about(to, session, session.size());
  put_rows(to, session.lane_rows());
  put_rest(to, session);
}

Session take_session(Reader& from, const std::function<void(const Session&, std::uint64_t)>& begins,
                     const TakeRows& take) {
  Session session;
  session.info = take_info(from);
  session.layout = session.info.layout();
  const std::size_t beside = from.taken(sizeof(std::uint64_t));
  if (beside >= kMostLanes) throw Broken("more runs than are possible");
  for (std::size_t i = 0; i < beside; ++i) add_lane(session, from.text());
  const auto claimed = from.number<std::uint64_t>();
  for (std::size_t i = 0; i < session.lanes(); ++i) take_run(from, claimed, session.lane(i));
  begins(session, claimed);
  const std::uint64_t rows = take_rows(from, session, claimed, take);
  drop_lost(session, rows, claimed);
  session.marks = take_marks(from);
  for (const Mark& mark : session.marks) {
    if (mark.tick >= rows) throw Broken("a mark after the end of the recording");
  }
  return session;
}

Session take_session(Reader& from) {
  constexpr std::uint64_t kMostRows = std::uint64_t{1} << 40;  // more than 30 years of ticks
  std::array<LargeVector<double>, kMostLanes> rows;
  ForgetBehind forget;
  Session session = take_session(
      from,
      [&](const Session& about, std::uint64_t count) {
        const auto stride = static_cast<std::size_t>(about.layout.stride());
        if (count > kMostRows) throw Broken("too much");
        for (std::size_t i = 0; i < about.lanes(); ++i) rows[i].reserve(count * stride);
      },
      [&](LaneRows some) {
        for (std::size_t i = 0; i < some.size(); ++i) {
          rows[i].insert(rows[i].end(), some[i].begin(), some[i].end());
          forget.passed(some[i].size_bytes());
        }
      });
  for (std::size_t i = 0; i < session.lanes(); ++i) session.lane(i).rows = std::move(rows[i]);
  return session;
}

void put_order(Writer& to, const MarkOrder& order) {
  put_marks(to, order.marks);
  put_marks(to, order.known);
}

MarkOrder take_order(Reader& from) {
  MarkOrder order;
  order.marks = take_marks(from);
  order.known = take_marks(from);
  return order;
}

void put_table(Writer& to, const Table& table) {
  to.number<std::uint64_t>(table.texts.size());
  for (const auto& [name, value] : table.texts) to.text(name), to.text(value);
  to.number<std::uint64_t>(table.counts.size());
  for (const auto& [name, value] : table.counts) to.text(name), to.number(value);
  to.number<std::uint64_t>(table.columns.size());
  for (const auto& [path, values] : table.columns) {
    to.text(path);
    to.list(std::span<const double>(values));
  }
}

Table take_table(Reader& from) {
  constexpr std::size_t kNumber = sizeof(std::uint64_t);
  Table table;
  const auto each = [&](std::size_t size, auto take) {
    for (std::size_t left = from.taken(size); left > 0; --left) take(from.text());
  };
  each(2 * kNumber, [&](const std::string& name) { table.texts[name] = from.text(); });
  each(2 * kNumber,
       [&](const std::string& name) { table.counts[name] = from.number<std::uint64_t>(); });
  each(2 * kNumber,
       [&](const std::string& path) { table.columns[path] = from.list<std::vector<double>>(); });
  return table;
}

}  // namespace wire

void add_lane(Session& session, std::string config) {
  Session lane;
  lane.info = session.info;
  lane.info.beside.clear();
  lane.info.config = config;
  lane.layout = session.layout;
  session.info.beside.push_back(std::move(config));
  session.beside.push_back(std::move(lane));
}

void drop_lost(Session& session, std::uint64_t rows, std::uint64_t claimed) {
  if (rows == claimed) return;
  for (std::size_t i = 0; i < session.lanes(); ++i) {
    std::erase_if(session.lane(i).changes,
                  [&](const SettingChange& change) { return change.row >= rows; });
  }
}

Session read_session(const fs::path& file, const std::function<void(const Session&)>& begins,
                     const TakeRows& take) {
  return ask("session", file, [&](wire::Reader& from) {
    std::vector<RowCheck> checks;
    return wire::take_session(
        from,
        [&](const Session& about, std::uint64_t) {
          checks.assign(about.lanes(), RowCheck(about.layout, file));
          begins(about);
        },
        [&](LaneRows rows) {
          for (std::size_t i = 0; i < rows.size(); ++i) checks[i].take(rows[i]);
          take(rows);
        });
  });
}

Session read_session(const fs::path& file) {
  return ask("session", file, [&](wire::Reader& from) {
    Session session = wire::take_session(from);
    for (std::size_t i = 0; i < session.lanes(); ++i) check_rows(session.lane(i), file);
    return session;
  });
}

wire::Table read_table(const fs::path& file) {
  return ask("table", file, [](wire::Reader& from) { return wire::take_table(from); });
}

void write_marks_into(const fs::path& file, int descriptor, const MarkOrder& order) {
  // The order goes through memory: the program may close a pipe before all of it is written.
  const Descriptor orders(::memfd_create("marks", MFD_CLOEXEC));
  try {
    wire::Writer to(*orders);
    wire::put_order(to, order);
  } catch (const wire::Broken&) {
    refuse(file, "not enough memory to add marks");
  }
  ::lseek(*orders, 0, SEEK_SET);
  ask("marks", file, [](wire::Reader& from) { return from.number<std::uint8_t>(); },
      {{*orders, STDIN_FILENO}, {descriptor, kCopyToChange}});
}

}  // namespace limpid
