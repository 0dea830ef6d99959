// Session files: recorded ticks as HDF5, readable while being written, recoverable when killed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/lanes.h"
#include "core/base/large_memory.h"
#include "core/tick/row.h"
#include "devices/files/scene_files.h"
#include "devices/files/text_file.h"

namespace limpid {

inline constexpr const char* kSessionFormat = "limpid-session";
inline constexpr const char* kSweepFormat = "limpid-sweep";  // of tables, see app/sweep
// Version 1 counts the travel of slides in units of 0.1 m, and has zeros for contacts that are not
// there. Both versions are read.
inline constexpr int kSessionVersion = 2;
inline constexpr const char* kSessionEnding = ".h5";
inline constexpr std::size_t kSettingLength = 120;
inline constexpr const char* kEventRowPath = "/events/row";
inline constexpr const char* kRoundingPath = "/check/rounding";
inline constexpr const char* kJointTypes = "joint_types";  // attribute of the root
inline constexpr const char* kSlidingType = "prismatic";   // in URDF's words
inline constexpr const char* kTurningType = "revolute";
inline constexpr const char* kEventSettingPath = "/events/setting";
inline constexpr const char* kMarkTickPath = "/marks/tick";
inline constexpr const char* kMarkTextPath = "/marks/text";
inline constexpr std::size_t kMarkLength = 200;  // bytes of UTF-8
inline constexpr std::size_t kMostMarks = 100'000;
inline constexpr const char* kWorldPath = "/objects/state";
inline constexpr std::size_t kMostWorld = 100'000;  // numbers
inline constexpr const char* kStory = "story";      // attribute of the root
inline constexpr const char* kBodyNames = "names";  // attribute of datasets of bodies

// Value of rows that were announced but never written, in recordings of the first edition: a
// not-a-number that no arithmetic makes.
inline constexpr std::uint64_t kNeverWritten = 0x7ff8'6c69'6d70'6964;

// The same path below a group: a session's datasets are at the root, those of
// further lanes in groups named as lane_name() says.
inline const char* within_group(const char* path) { return path + 1; }

inline std::size_t column_index(Column c) { return static_cast<std::size_t>(c); }

struct ArmDescription;

struct SessionInfo {
  double tick = 0.001;  // T [s]
  int dof = 3;
  std::string created;  // ISO 8601; filled in by the writer if empty
  std::string app_version;
  std::string build;  // program and kind of processor that made it; empty: unknown
  std::uint64_t seed = 0;
  std::string source;       // kind of hand
  std::string config;       // all parameters at row 0 (TOML)
  std::string safety;       // the safety limits in force (TOML); empty if none were recorded
  std::string device_urdf;  // whole text
  std::string scene;        // whole text (TOML)
  std::string story;        // the story that it tells: captions and the like; empty: none
  SceneFiles models;        // models that the scene's text names
  // The arm of the rows. Readers leave it out, as device_urdf has it. A file that is written
  // without it has neither tips nor names of joints.
  std::shared_ptr<const ArmDescription> arm;
  std::vector<bool> slides;         // joints that slide, as far as known; empty: none
  std::vector<std::string> bodies;  // names of the objects that move, in the rows' order
  // All parameters at row 0 of each further lane (TOML).
  std::vector<std::string> beside;

  std::size_t lanes() const { return 1 + beside.size(); }
  RowLayout layout() const { return RowLayout(dof, static_cast<int>(bodies.size())); }
};

// A parameter that changed while recording: from `row` on, `setting` ("coupling.k_vc = 8") holds.
struct SettingChange {
  std::uint64_t row = 0;
  std::string setting;  // at most 120 characters; without a value: back to the arm's own

  std::string_view key() const { return std::string_view(setting).substr(0, setting.find(' ')); }
};

// A note at a moment of a recording: a comment, or a reason to look at it again.
struct Mark {
  std::uint64_t tick = 0;  // its row
  std::string text;        // at most kMarkLength bytes

  friend bool operator==(const Mark&, const Mark&) = default;
};

struct Session {
  SessionInfo info;
  RowLayout layout{3};
  LargeVector<double> rows;  // N x layout.stride(), row-major
  std::vector<SettingChange> changes;
  std::vector<Mark> marks;  // in the order of their ticks
  // State of all bodies at the first row, as RigStart has it. Empty: as the scene has them, or
  // unknown.
  std::vector<double> world;
  // Further lanes, as sessions of their own: as many rows, their own parameters and changes, the
  // same world.
  std::vector<Session> beside;

  std::size_t lanes() const { return 1 + beside.size(); }
  const Session& lane(std::size_t i) const { return i == kMainLane ? *this : beside[i - 1]; }
  Session& lane(std::size_t i) { return i == kMainLane ? *this : beside[i - 1]; }
  // Returns the rows of each lane.
  std::vector<std::span<const double>> lane_rows() const {
    std::vector<std::span<const double>> all;
    for (std::size_t i = 0; i < lanes(); ++i) all.emplace_back(lane(i).rows);
    return all;
  }
  std::size_t size() const { return rows.size() / static_cast<std::size_t>(layout.stride()); }
  std::span<const double> row(std::size_t k) const {
    const auto stride = static_cast<std::size_t>(layout.stride());
    return std::span(rows).subspan(k * stride, stride);
  }
  std::span<const double> at(std::size_t k, Column c) const { return layout.in(row(k), c); }
};

// Choice whether a complete session is packed, which takes several times as long as writing it.
enum class Packing { no, yes };

// Writes OUT.h5.part while recording (SWMR: readable live). close() replaces it by OUT.h5: the
// same, packed if the file system has nameless files and room. Rows reach the disk at least every
// three quarters of a second of ticks. Not for the haptic thread. Errors: FileError if the
// name has another ending, OUT exists and `force` is not set, the place cannot be written, or a
// write fails (disk full). After a failed write the .part keeps everything flushed before.
class SessionWriter {
 public:
  SessionWriter(std::filesystem::path out, const SessionInfo& info, bool force,
                Packing packing = Packing::yes);
  ~SessionWriter();  // without close(): leaves the .part, as a killed program would
  SessionWriter(const SessionWriter&) = delete;
  SessionWriter& operator=(const SessionWriter&) = delete;

  // Appends any whole number of rows. All lanes get as many.
  void append(std::span<const double> rows, std::size_t lane = kMainLane);
  void append(const SettingChange& change, std::size_t lane = kMainLane);
  void append(const Mark& mark);
  // Writes the state of bodies at the first row, at most kMostWorld numbers; at most once, and
  // before that row. Does nothing in a session without bodies.
  void append_world(std::span<const double> world, std::size_t lane = kMainLane);
  // Flushes, closes and renames. `warnings`: sentences about the run, one a line, for the attribute
  // of that name; empty: none.
  void close(const std::string& warnings = {});
  std::uint64_t rows_written() const;  // handed over until now
  const std::filesystem::path& part() const;
  bool is_locked() const;  // against other programs; false where the file system has no locks

 private:
  struct File;
  std::unique_ptr<File> file_;
};

// Reads OUT.h5, or the .part of a recording that is running or was killed (the rows that are
// complete in every column). Errors: FileError for a file that is missing, not HDF5, not a
// session, of another version, of inconsistent shapes, or with times that are not finite.
Session read_session(const std::filesystem::path& file);

// Refuses a text that is longer than kMarkLength. Errors: FileError naming `file`.
void check_mark(const Mark& mark, const std::filesystem::path& file);
// Replaces the marks of a complete session by `marks`. Marks that are neither among these nor
// `known` are another program's, and stay. A program in a sandbox writes them into a copy, which
// replaces the session once it is on the disk: the session is whole at any moment. Errors:
// FileError if another program changed the session meanwhile, or for more than kMostMarks; the
// session is then as before.
void write_marks(const std::filesystem::path& session, std::span<const Mark> marks,
                 std::span<const Mark> known);

// Path and number of rows of a recovered session.
struct Recovered {
  std::filesystem::path file;
  std::uint64_t rows = 0;
};
// Makes OUT.h5 (or `to`, if given) of OUT.h5.part through a clean copy, and removes the .part.
// Errors: as read_session(); FileError if the new file exists and not `force`, or there are no
// rows; the .part stays then.
Recovered recover_session(const std::filesystem::path& part, bool force,
                          const std::filesystem::path& to = {});

}  // namespace limpid
